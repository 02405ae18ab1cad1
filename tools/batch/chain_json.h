// Chains of joints, and queries about them, as JSON.
#pragma once

#include <array>
#include <span>

#include "import/json_input.h"
#include "workloads/workload.h"

namespace radar::tools {

/// `bases`: of the meshes that links may have.
ChainSpec chainFrom(const JsonValue& value, const Workload& world, std::span<const std::array<double, 3>> bases);

/// What of a query says which chain goes where.
void readChainWay(const JsonValue& query, const Workload& world, QuerySpec& to);
/// Refuses what breaks the contract of a ChainQuery; all else has been read.
void checkChainQuery(const JsonValue& query, const Workload& world, const QuerySpec& spec);

}  // namespace radar::tools
