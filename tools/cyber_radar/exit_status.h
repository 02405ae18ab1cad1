#pragma once

namespace radar::tools {

constexpr int kStatusSomeInvalid = 1;  ///< some query could not be answered
constexpr int kStatusBadInput = 2;

}  // namespace radar::tools
