// What shells and manuals want to know of a command line, from the options themselves.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace radar::tools {

/// The names of a command's own commands.
std::vector<std::string> commandNames(const CLI::App& app);

std::string joined(const std::vector<std::string>& words, const char* between);

/// A script for bash, and for zsh after bashcompinit.
std::string completion(const CLI::App& app);
/// The manual page, in roff; fish learns the options from it.
std::string manual(const CLI::App& app);

}  // namespace radar::tools
