// Queries, and what they have in common with scenes, as JSON.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "import/json_input.h"
#include "workloads/workload.h"

namespace radar::tools {

/// Refuses a key that is not one of these.
void requireKnownKeys(const JsonValue& object, std::span<const std::string_view> known);
inline void requireKnownKeys(const JsonValue& object, std::initializer_list<std::string_view> known) {
  requireKnownKeys(object, std::span(known.begin(), known.size()));
}

/// Three numbers.
std::array<double, 3> vectorFrom(const JsonValue& list);
/// Twelve, of any invertible matrix.
Transform poseFrom(const JsonValue& list);
/// Three numbers of a list, from `first` on, that an object or a sensor may move by (radar.h).
std::array<double, 3> motionFrom(const JsonValue& list, size_t first);

/// `bases`: of the meshes that may be placed.
Instance instanceFrom(const JsonValue& list, std::span<const std::array<double, 3>> bases);

/// Why a mesh cannot be an object's or a link's; empty if it can.
std::string onlySensor(const MeshData& mesh);

/// A query on `world`. Whether another one has its id is not checked.
QuerySpec queryFrom(const JsonValue& query, const Workload& world, std::span<const std::array<double, 3>> bases);

}  // namespace radar::tools
