// The descent of a search through two meshes' trees, for each set of instructions for which it is compiled.
#pragma once

#include "cpu/mesh_search.h"

namespace radar::cpu {

/// Searches as of MeshSearch::run. `open`: memory for the pairs of nodes that are yet to be tested, enough for the
/// depth of both trees.
struct MeshDescent {
  const char* instructions;  ///< for which it is compiled
  void (*straight)(const MeshPair& pair, double near, PairVisitor& visitor, OpenPair* open, uint64_t& pairs,
                   const std::stop_token& stop);
  void (*path)(const PathPair& pair, PathContact& contact, OpenPair* open, uint64_t& pairs,
               const std::stop_token& stop);
};

/// Four lanes, for every processor.
const MeshDescent* commonDescent();
/// Eight lanes; null if it was not compiled. AVX-512 has twice the registers for them.
const MeshDescent* avx2Descent();
const MeshDescent* avx512Descent();

}  // namespace radar::cpu
