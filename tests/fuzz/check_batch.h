// What a query file that was read must be, and the message about one that was refused.
#pragma once

#include <string>

#include "workloads/workload.h"

namespace radar::fuzz {

/// Answers the queries. Throws std::logic_error if one breaks its contract, or an answer does.
void checkBatch(const tools::Workload& workload);

/// Throws std::logic_error unless the message names the file and can be printed.
void checkMessage(const std::string& file, const std::string& words);

}  // namespace radar::fuzz
