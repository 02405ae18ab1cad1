#include "cpu/node_gap.h"

#include <algorithm>
#include <cmath>

namespace radar::cpu {

namespace {

// Where more directions find little more.
constexpr int kMostDirections = 3;
constexpr double kLittle = 0x1p-4;

}  // namespace

void GapTest::set(const Vector& n, double distance, double latest) {
  isKnown_ = n != Vector{};
  if (!isKnown_) return;
  // The height of A above B, but for their nodes' places, falls at a constant rate or does not fall.
  const double way = motion_.timeOf(latest) * dot(n, motion_.travel);
  for (int k = 0; k < 3; ++k) {
    alongA_[k] = n[0] * a_.linear[0][k] + n[1] * a_.linear[1][k] + n[2] * a_.linear[2][k];
    alongB_[k] = n[0] * b_.linear[0][k] + n[1] * b_.linear[1][k] + n[2] * b_.linear[2][k];
  }
  // PairMotion::rounding holds 32 ulp of all that is summed here and in keepApart().
  height_ = dot(n, motion_.gap) + std::min(way, 0.0) - (1 + 0x1p-20) * std::sqrt(dot(n, n)) * distance -
            2 * reachAlong(n, motion_.rounding);
}

NodeGap::Boxes NodeGap::boxesOf(const gpu::MeshNode& a, const gpu::MeshNode& b) const {
  Boxes boxes;
  for (int i = 0; i < 3; ++i) {
    boxes.apart[i] = motion_.gap[i];
    boxes.half[i] = 0;
    for (int k = 0; k < 3; ++k) {
      boxes.apart[i] += a_.linear[i][k] * a.centre[k] - b_.linear[i][k] * b.centre[k];
      boxes.half[i] += std::abs(a_.linear[i][k]) * a.halfExtent[k] + std::abs(b_.linear[i][k]) * b.halfExtent[k];
    }
  }
  return boxes;
}

// PairMotion::rounding holds 32 ulp of all that is summed here.
double NodeGap::heightAlong(const Vector& n, const gpu::MeshNode& a, const gpu::MeshNode& b) const {
  return dot(n, motion_.gap) - topAlong(a, a_.linear, scaled(-1, n)) - topAlong(b, b_.linear, n) -
         2 * reachAlong(n, motion_.rounding);
}

double NodeGap::reached(const gpu::MeshNode& a, const gpu::MeshNode& b, double latest) const {
  const Boxes boxes = boxesOf(a, b);
  // Any time and any plane will do. The boxes meet at about the time at which balls around them do.
  const double nearest = -perSquared_ * dot(boxes.apart, motion_.travel);
  const Vector passing = along(boxes.apart, nearest, motion_.travel);
  const double room = motion_.clearance + std::sqrt(dot(boxes.half, boxes.half));
  const double before = room * room - dot(passing, passing);
  const double at = std::clamp(before > 0 ? nearest - std::sqrt(before * perSquared_) : nearest, 0.0, latest);
  const Vector n = acrossGap(boxes.apart, boxes.half, motion_.travel, at, at == nearest ? perSquared_ : 0);
  const double spare = heightAlong(n, a, b) - (1 + 0x1p-20) * std::sqrt(dot(n, n)) * motion_.clearance;
  const double speed = -dot(n, motion_.travel);
  return spare > 0 ? (1 - 0x1p-20) * spare / std::max(speed, 0x1p-1000) : 0;
}

Vector NodeGap::farthestBack(const Vector& n, const Vector& apart, const gpu::MeshNode& a,
                             const gpu::MeshNode& b) const {
  Vector least = dot(n, motion_.travel) < 0 ? along(apart, 1, motion_.travel) : apart;
  for (int k = 0; k < 3; ++k) {
    const Vector edgeA{a_.linear[0][k], a_.linear[1][k], a_.linear[2][k]},
        edgeB{b_.linear[0][k], b_.linear[1][k], b_.linear[2][k]};
    least = along(least, -std::copysign(a.halfExtent[k], dot(n, edgeA)), edgeA);
    least = along(least, -std::copysign(b.halfExtent[k], dot(n, edgeB)), edgeB);
  }
  return least;
}

double NodeGap::least(const gpu::MeshNode& a, const gpu::MeshNode& b, double enough, const Vector& likely,
                      Vector& across) const {
  double most = 0;
  const auto tryAlong = [&](const Vector& n) {
    const double least = leastAlong(n, a, b);
    if (least > most) {
      most = least;
      across = n;
    }
    return most > enough;
  };
  const Vector before = across;
  for (const Vector& n : {before, likely}) {
    if (n != Vector{} && tryAlong(n)) return most;
  }
  const Vector apart = boxesOf(a, b).apart;
  // Of those differences, a convex set, the least is approached from the middle's; each direction gives a bound.
  Vector n = along(apart, std::clamp(-perSquared_ * dot(apart, motion_.travel), 0.0, 1.0), motion_.travel);
  for (int i = 0; i < kMostDirections; ++i) {
    if (tryAlong(n)) return most;
    const Vector step = minus(farthestBack(n, apart, a, b), n);
    const double gain = -dot(n, step), squared = dot(step, step);
    if (!(gain > kLittle * dot(n, n))) return most;
    n = along(n, std::min(gain / squared, 1.0), step);
  }
  return most;
}

}  // namespace radar::cpu
