// Answers. R, M, L and d are those of the paper that radar.h names.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radar/codes.h"
#include "radar/scene.h"

namespace radar {

/// An answer. Layout version 5: 136 bytes, natural alignment. Absent ids are kNone. Where no contact within D is
/// certain, t, hi and fraction are +infinity, and if the answer is clear, lo is, too: distances of any answers compare.
/// Of answers that a Recorder leaves open (Flag::unresolved), t is lo.
/// Other absent numbers, and all of an invalid answer, are NaN.
///
/// If the query has `anyHit`, the status is hit (overlap included), clear or undecided, and ids, features, point,
/// normal and gap are absent. Nobody looked for the first contact, so a hit's lo is 0, and t and hi are D.
struct RADAR_API Result {
  Status status = Status::invalid;
  Tier tier = Tier::select;
  Detected detected = Detected::notLooked;
  uint32_t resolution = 0;  ///< pixels along the window's longer side; 0 if no picture was drawn
  double t;                 ///< best estimate of t*, world units; tier sampled, and with anyHit: hi
  double lo, hi;            ///< the certified bracket, world units
  double fraction;          ///< t / D (0 if D is 0); of the step, if the query takes one
  ObjectId object = kNone;  ///< the object touched; in mode sampled, by the least of the pairs that it has found
  uint32_t triB = kNone;    ///< its triangle
  uint32_t triA = kNone;    ///< the sensor's triangle; of a cutter, its part, from 0
  uint32_t flags = 0;       ///< Flag: why a Recorder gave no answer; else 0
  /// The smallest features of the two triangles that contain every point at which they touch then, exactly; with a
  /// clearance, of the nearest points.
  Feature featureB = Feature::none, featureA = Feature::none;
  /// World position of the contact at the moment of contact. Where featureB is a vertex, it is that corner as placed,
  /// exactly (in a step, moved with its object); where only featureA is one, that corner moved by t. Where surfaces
  /// cross at the start, it is a point of the crossing, found in plain doubles, so that needles cost digits. With a
  /// clearance, it is of the touched surface.
  std::array<double, 3> point;
  /// Unit, from the touched surface towards the sensor. Every hit in mode contact has one. To rounding, normal .
  /// direction <= 0 (in a step: the relative motion), and normal . (a - b) >= 0 for all points a of the sensor's
  /// triangle and b of the object's, when they touch. If some normal that the motion goes against keeps apart all
  /// triangles of both meshes around `point`, this one does, so that who slides along it slides; likewise all pairs
  /// that touch then, if a normal of one of them does (docs/exact.md). Starts that cross have none: at the start it
  /// exists only if contact of the two triangles begins there, and keeps these two apart. With a clearance, it lies
  /// along the line between the nearest points, and is absent where they touch.
  /// Mode sampled knows of the pairs that it has found.
  std::array<double, 3> normal;
  /// World units: how far apart the named pair is at t, or when it comes within the clearance, if another has lowered
  /// lo: from `point` to the sensor's nearest point, point + gap * normal. 0 without a clearance; with one, up to that
  /// much and the tolerance, and at the start the least of all pairs that count. Off by rounding.
  double gap;
  double paperMinL;  ///< the paper's literal min(L), for comparison: may be negative, too early or too late
  Result();
  /// An answer without a contact: clear or undecided, with lo to be set. Others as above.
  explicit Result(Status status);
};
inline constexpr uint32_t kResultVersion = 5;
static_assert(sizeof(Result) == 136);

/// How near a query's sensor comes to the objects that take part, on the whole of its way, D included, whatever it
/// touches. Distances are of surfaces, without the query's clearance: of a round shape, its core's.
struct Closest {
  /// The least distance is in there, certainly; world units. Both are 0 exactly if surfaces meet, infinite if no object
  /// takes part.
  double lo = std::numeric_limits<double>::infinity(), hi = lo;
  /// Where it is at most `hi`: t, fraction, the pair, its nearest points' features, and `point`, `normal` and `gap`,
  /// between these; of several pairs that are as near, to rounding, one. The status is clear; if surfaces meet, it is
  /// the answer to the query without a clearance.
  Result at{Status::clear};
};

/// What a query lists besides its first contact.
struct Listed {
  /// With Query::hits above 1: the first contact with each object, by (t, object), t being exact and not rounded. With
  /// a clearance, by (lo, object), and beside as many objects as were asked for those that are undecided: they have a
  /// lo, but no finite hi.
  std::vector<Result> hits;
  std::vector<ObjectId> overlapping;  ///< with Query::skipOverlapping: the objects left out, ascending
  std::optional<Closest> closest;     ///< with Query::closest
  /// With Query::exit: status hit, with the last contact on the way; clear, if there is none; undecided, if the
  /// clearance leaves it open, with lo and hi. Certainly nothing touches the sensor, or is within the clearance,
  /// after hi; t is hi. If something is at the end of the way, t = lo = hi = D. The bracket is as narrow as that of a
  /// first contact. `normal` . direction >= 0; where surfaces cross at the end, point and normal are absent.
  std::optional<Result> exit;
};

/// Time of one stage, summed over submissions, milliseconds.
struct StageTime {
  std::string name;
  double ms = 0;
};

/// What answering took.
struct SweepStats {
  uint32_t submissions = 0;
  uint64_t drawnObjects = 0;      ///< objects drawn, summed over sensors
  uint64_t drawnTriangles = 0;    ///< triangles drawn for R and M, summed over sensors
  uint64_t pairs = 0;             ///< proposed pairs of triangles (sampled), pairs of leaves (contact)
  uint64_t cpuPairs = 0;          ///< pairs of triangles decided on the CPU
  uint64_t cpuQueries = 0;        ///< queries answered by the CPU alone (contact)
  std::string lost;               ///< how the device was lost: the CPU alone answers mode contact since; else empty
  std::vector<StageTime> stages;  ///< with SweeperOptions::timestamps, CPU stages included; else empty
};

/// The answers to a batch.
struct Answers {
  std::vector<Result> results;            ///< in the order of the queries
  std::vector<Listed> lists;              ///< one per query, or none if no query lists anything
  std::map<size_t, std::string> reasons;  ///< why a result is Status::invalid, by its index
  SweepStats stats;
};

}  // namespace radar
