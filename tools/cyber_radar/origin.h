// Where and when a report was made.
#pragma once

#include <string>

namespace radar::tools {

/// The day, in UTC: 2026-11-21.
std::string today();

/// The processor's model and its threads, in words.
std::string processorInWords();

}  // namespace radar::tools
