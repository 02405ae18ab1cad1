// What all programs' command lines have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace radar::tools {

/// --version; and messages that name the word that nothing here knows, and the nearest that there is.
void addBasics(CLI::App& app);

/// The names of a command's own commands.
std::vector<std::string> commandsOf(const CLI::App& app);

/// What an option's value is: "N"; or all that it may be, if these are few: "sampled|contact|reference".
std::string valueOf(const CLI::Option& option);

/// The words that an option's value may be; none where it is a number, a file or the like.
std::vector<std::string> choicesOf(const CLI::Option& option);

}  // namespace radar::tools
