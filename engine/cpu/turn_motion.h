// A mesh that turns: its way in parts.
#pragma once

#include <vector>

#include "cpu/path_part.h"
#include "query/turning.h"

namespace radar::cpu {

/// A turn in parts so short that no point of a mesh bends away from its way by more than a share of its triangles.
class TurnMotion {
 public:
  TurnMotion(const Query& query, const Mesh& sensor);

  const Turning& turning() const { return turning_; }
  std::span<const PathPart> parts() const { return parts_; }
  /// Bound on the speed of the sensor's points relative to an object that moves by `objectWay`, world units per s.
  double speedPast(const Vector& objectWay) const;
  /// World units: how far a point of an object that may touch the sensor gets from its straight way in the part, as
  /// seen from the sensor.
  double bendSeen(const PathPart& part, const Vector& objectWay) const;

 private:
  Turning turning_;
  double radius_;  // of the sensor about the axis, and what is within its clearance, at most
  std::vector<PathPart> parts_;
};

}  // namespace radar::cpu
