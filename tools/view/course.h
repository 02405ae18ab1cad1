// How far a query's sensor moves.
#pragma once

#include <algorithm>
#include <cmath>

#include "workloads/vectors.h"
#include "workloads/workload.h"

namespace radar::tools {

/// The way of a query's sensor, world units, and the time of an answer at its end: D, or 1 of a step.
struct Course {
  Vec3 way{};
  double whole = 1;
  bool isAny = false;

  explicit Course(const QuerySpec& query) : isAny(query.anyHit) {
    if (query.motion) {
      way = *query.motion;
      return;
    }
    whole = query.distance;
    // A direction may be so long, or so short, that its square is no double.
    double largest = 0;
    for (double value : query.direction) largest = std::max(largest, std::abs(value));
    Vec3 scaled = query.direction;
    for (double& value : scaled) value /= largest;
    way = (whole / lengthOf(scaled)) * scaled;
  }

  /// The part of the way that the sensor can go, 0 to 1; of a hit that only says whether (Query::anyHit), 0.
  double share(const Result& answer) const {
    if (answer.status == Status::clear) return 1;
    if (isAny && answer.status == Status::hit) return 0;
    const double time = answer.status == Status::hit ? answer.t : answer.status == Status::undecided ? answer.lo : 0;
    return time > 0 && whole > 0 ? std::min(time / whole, 1.0) : 0;
  }
};

}  // namespace radar::tools
