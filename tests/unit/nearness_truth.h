// What the answer of a query with a clearance must be, by brute force over all pairs of triangles: which pairs count,
// in exact integers; when they come within the clearance, in long double, with room for rounding.
#pragma once

#include <span>

#include "brute_force.h"
#include "distances.h"

namespace oracle {

class NearTruth {
 public:
  NearTruth(const radar::Scene& scene, const radar::Query& query);

  /// What is wrong with an answer and with its lists, in words; empty if nothing is.
  std::string faultOf(const radar::Result& result, std::span<const radar::Result> hits,
                      std::span<const radar::ObjectId> overlapping) const;
  /// How many pairs come within the clearance, but do not block.
  int passing() const { return passing_; }
  /// Whether rounding decides if or when something comes within the clearance.
  bool isOpen() const;

 private:
  using Real = long double;
  using Point = distances::Point<Real>;
  using Points = distances::Points<Real>;

  /// The sensor's course past an object: along `unit`, which is 0 if it rests, for `whole` world units.
  struct Course {
    radar::ObjectId object;
    Point unit;
    Real whole, rate;  ///< of the answer's t per world unit
    Real tolerance;    ///< world units
  };
  /// Within the clearance not before `early`, and certainly by `late`, in units of the answer's t.
  struct Pair {
    size_t course;
    uint32_t triB, triA;
    Points a, b;              ///< relative to a corner of the sensor
    Real start, early, late;  ///< at the start what is pressed together counts as within the clearance
    bool touches;             ///< at the start, exactly
  };
  /// Of those of one object, or of all.
  struct Span {
    Real start, early, late;
    Real tolerance = 0;
    bool isLoose = false;  ///< rounding decides whether or when some pair comes within the clearance
  };

  struct Exact;
  void add(radar::ObjectId id);
  bool blocks(const Corners& a, const Corners& b, const Course& course, const Pair& pair) const;
  Span spanOf(radar::ObjectId id) const;
  std::string faultOfOne(const radar::Result& result, radar::ObjectId among, bool isDecision) const;
  std::string faultOfPlace(const radar::Result& result, const Span& span, radar::ObjectId among) const;
  std::string faultOfList(std::span<const radar::Result> hits) const;

  const radar::Scene& scene_;
  const radar::Query& query_;
  Point origin_;
  Real size_ = 0, room_ = 0;  ///< the greatest number; for rounding
  Real end_;
  std::vector<radar::ObjectId> overlapping_;
  std::vector<Course> courses_;
  std::vector<Pair> pairs_;
  int passing_ = 0;
};

}  // namespace oracle
