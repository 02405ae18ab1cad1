// The descent of a search through two meshes' trees, for each number of lanes at which it is compiled.
#pragma once

#include "cpu/mesh_search.h"

namespace radar::cpu {

/// Searches as of MeshSearch::run. `open`: memory for the pairs of nodes that are yet to be tested, enough for the
/// depth of both trees.
struct MeshDescent {
  int lanes;
  void (*straight)(const MeshPair& pair, double near, PairVisitor& visitor, OpenPair* open, uint64_t& pairs,
                   const std::stop_token& stop);
  void (*path)(const PathPair& pair, PathContact& contact, OpenPair* open, uint64_t& pairs,
               const std::stop_token& stop);
};

template <int lanes>
const MeshDescent& meshDescent();
template <>
const MeshDescent& meshDescent<4>();
template <>
const MeshDescent& meshDescent<8>();

/// For processors with AVX2; null if it was not compiled.
const MeshDescent* eightLanes();

}  // namespace radar::cpu
