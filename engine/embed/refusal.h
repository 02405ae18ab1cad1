// What a Recorder refuses to record or to prepare.
#pragma once

#include "radar/error.h"

namespace radar {

/// Its message lacks the name of the call, which who made the call puts in front.
class Refusal : public Error {
 public:
  explicit Refusal(const std::string& message) : Error(message) {}
};

}  // namespace radar
