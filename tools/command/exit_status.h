#pragma once

namespace radar::tools {

constexpr int kStatusSomeInvalid = 1;  ///< some query could not be answered
constexpr int kStatusNotAsWanted = 1;  ///< answers are not as --expect, --fail-on or compare want them
constexpr int kStatusBadInput = 2;

}  // namespace radar::tools
