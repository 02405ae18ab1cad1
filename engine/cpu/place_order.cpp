#include "cpu/place_order.h"

#include <algorithm>
#include <limits>

#include "scene/parallel.h"

namespace radar::cpu {

namespace {

// Of fewer queries, hardly any two are near each other.
constexpr size_t kWorthOrder = 512;
// Cells along an axis are 2^bits: a few queries in each, and no more cells than fit a cache.
constexpr uint32_t kMostBits = 5;
// Queries a thread takes at a time.
constexpr size_t kChunk = 4096;

/// Moves the low kMostBits bits to every third place.
uint32_t spread(uint32_t x) {
  x = (x | x << 8) & 0x100f;
  x = (x | x << 4) & 0x10c3;
  return (x | x << 2) & 0x1249;
}

}  // namespace

std::span<const uint32_t> PlaceOrder::of(std::span<const Query> queries, const Scene::Impl& scene,
                                         const ObjectTree& tree, unsigned threads) {
  const size_t count = queries.size();
  if (count < kWorthOrder || count > std::numeric_limits<uint32_t>::max() || !tree.inRange() || tree.nodes().empty()) {
    return {};
  }
  uint32_t bits = 1;
  while (bits < kMostBits && size_t{1} << 3 * (bits + 1) <= count) ++bits;
  const Box& world = tree.worldBox();
  const double most = (1 << bits) - 1;
  Vector perUnit;
  for (int k = 0; k < 3; ++k) perUnit[k] = (most + 1) / std::max(world.hi[k] - world.lo[k], 0x1p-500);
  cells_.resize(count);
  parallelFor(count, kChunk, threads, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const Mesh& mesh = scene.meshes[queries[i].mesh];
      uint32_t cell = 0;
      for (int k = 0; k < 3; ++k) {
        const double* row = &queries[i].worldFromMesh.m[4 * k];
        const double place = row[0] * mesh.origin[0] + row[1] * mesh.origin[1] + row[2] * mesh.origin[2] + row[3];
        // So that also no number, of a place out of range, is in some cell.
        const double at = std::min(most, std::max(0.0, (place - world.lo[k]) * perUnit[k]));
        cell |= spread(static_cast<uint32_t>(at)) << k;
      }
      cells_[i] = cell;
    }
  });
  first_.assign((size_t{1} << 3 * bits) + 1, 0);
  for (const uint32_t cell : cells_) ++first_[cell + 1];
  for (size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  order_.resize(count);
  for (uint32_t i = 0; i < count; ++i) order_[first_[cells_[i]]++] = i;
  return order_;
}

}  // namespace radar::cpu
