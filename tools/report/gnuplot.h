// gnuplot (https://www.gnuplot.info) as a child process.
#pragma once

#include <string>

namespace radar::tools {

/// What gnuplot writes to its standard output for a script. Throws std::runtime_error where gnuplot is missing or does
/// not take the script.
std::string gnuplot(const std::string& script);

/// Throws as gnuplot() does where it is missing: before work that would be lost.
void requireGnuplot();

/// A string constant of a script, whatever is in it. Control characters become spaces.
std::string quoted(const std::string& text);

}  // namespace radar::tools
