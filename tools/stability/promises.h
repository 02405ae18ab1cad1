// What answers promise, held against the reference.
#pragma once

#include <string>
#include <vector>

#include "radar/radar.h"

namespace radar::tools {

struct Verdict {
  bool missed = false;       ///< clear where there is a contact within D
  bool falseHit = false;     ///< a contact where there is none within D
  bool unanswered = false;   ///< undecided or invalid
  bool wrongStatus = false;  ///< hit for overlap or the other way, or not detected
  bool wrongPair = false;    ///< object or a triangle
  bool bracket = false;      ///< t* is not in [lo, hi], t is not, or it is wider than 1e-9 or beyond D
  bool late = false;         ///< t or the fraction is off by more than 1e-9
  bool point = false;        ///< not on both surfaces at the moment of contact, or missing
  bool normal = false;       ///< not a unit vector against the motion, or there where the reference has none
  double error = 0;          ///< |t - t*| / max(size of the sensor, t*)
  bool right() const {
    return !(missed || falseHit || unanswered || wrongStatus || wrongPair || bracket || late || point || normal);
  }
  /// What is wrong, in words; empty if nothing is.
  std::string words() const;
};

/// `exact` is the reference's answer.
Verdict judgeContact(const Scene& scene, const Query& query, const Result& result, const Result& exact);

/// The same for mode sampled, whose `lo` is 0: `late`, `wrongPair`, `point` and `normal` are not judged, and undecided
/// is an answer.
Verdict judgeSampled(const Query& query, const Result& result, const Result& exact);

}  // namespace radar::tools
