#include "cpu/mesh_search.h"

#include <atomic>

#include "cpu/mesh_descent.h"

namespace radar::cpu {

namespace {

/// Those that this processor can run, the fastest last.
std::vector<const MeshDescent*> descentsHere() {
  std::vector<const MeshDescent*> descents{commonDescent()};
#ifdef __x86_64__
  const auto add = [&](bool isSupported, const MeshDescent* descent) {
    if (isSupported && descent != nullptr) descents.push_back(descent);
  };
  add(__builtin_cpu_supports("avx2"), avx2Descent());
  add(__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"), avx512Descent());
#endif
  return descents;
}

std::atomic<const MeshDescent*>& inUse() {
  static std::atomic<const MeshDescent*> descent{descentsHere().back()};
  return descent;
}

}  // namespace

std::vector<std::string> searchInstructions() {
  std::vector<std::string> names;
  for (const MeshDescent* descent : descentsHere()) names.emplace_back(descent->instructions);
  return names;
}

void setSearchInstructions(const std::string& name) {
  for (const MeshDescent* descent : descentsHere()) {
    if (descent->instructions == name) inUse() = descent;
  }
}

PathPair pairOf(const PlacedMesh& body, const PathPart& part, const PlacedMesh& object, ObjectId name,
                const Vector& drift, double clearance) {
  PathPair pair{body, object, name};
  pair.from = part.from;
  pair.end = part.end;
  for (int e = 0; e < 2; ++e) {
    pair.a[e] = {&part.at[e], &part.axes[e]};
    pair.b[e] = {&object.placement, nullptr};
    const Vector moved = along(object.placement.origin, e == 0 ? part.from : part.end, drift);
    pair.gap[e] = minus(moved, part.at[e].origin);
  }
  pair.apart = clearance + part.error + 8 * kUnit * norm1(drift);
  pair.bend = part.bend;
  return pair;
}

void MeshSearch::run(const MeshPair& pair, double near, PairVisitor& visitor, uint64_t& pairs,
                     const std::stop_token& stop) {
  inUse().load(std::memory_order_relaxed)->straight(pair, near, visitor, openFor(pair.sensor, pair.other), pairs, stop);
}

void MeshSearch::run(const PathPair& pair, PathContact& contact, uint64_t& pairs, const std::stop_token& stop) {
  inUse().load(std::memory_order_relaxed)->path(pair, contact, openFor(pair.sensor, pair.other), pairs, stop);
}

OpenPair* MeshSearch::openFor(const PlacedMesh& a, const PlacedMesh& b) {
  // A pair of nodes adds three pairs for each level by which it is opened, and no more.
  const size_t most = 3 * (size_t{a.mesh.tree.depth} + b.mesh.tree.depth) + 4;
  if (open_.size() < most) open_.resize(most);
  return open_.data();
}

}  // namespace radar::cpu
