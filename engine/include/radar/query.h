// Queries and their answers. R, M, L and d are those of the paper that radar.h names.
//
// Ranges: mode contact accepts all finite numbers, in poses up to 2^800. The CPU answers what floats cannot hold; a
// Recorder cannot fall back on the CPU, so recorder.h lists these limits. Mode sampled answers Status::invalid, with a
// reason, if coordinates exceed 2^80, the sensor's size is below 2^-80, an object in reach is more than 2^40 times as
// large as the sensor, the components of a direction differ by a factor of more than about 2^1000, or one query's
// picture or list of objects in reach exceeds the device's memory or limits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radar/scene.h"

namespace radar {

/// Which method answers a query.
enum class Mode : uint32_t {
  sampled,  ///< select, then the paper's method: `hi` is certain, `lo` is 0, a contact may be missed
  contact   ///< the exact search, on the device or on the CPU: never undecided, unless Query::clearance is above 0
};

/// One sweep: the sensor `mesh`, placed by `worldFromMesh`, moves along `direction` for `distance`.
struct Query {
  MeshId mesh = kNone;                ///< of the scene
  Transform worldFromMesh{};          ///< invertible
  std::array<double, 3> direction{};  ///< finite, not zero; no longer than 2^1023 beside a component below 2^-1020
  double distance = 0;                ///< D >= 0, finite, world units
  Mode mode = Mode::contact;
  bool anyHit = false;              ///< asks only whether there is contact within D: see Result. Cheaper if there is
  std::vector<ObjectId> exclude{};  ///< objects to ignore, such as the sensor's own; at most a handful
  uint32_t mask = ~0u;              ///< an object takes part if its mask shares a bit

  /// Mode contact, instead of `direction` and `distance`, which stay 0: how far the sensor moves during a step, world
  /// units, at constant velocity; may be zero. Objects move by Object::motion meanwhile. First contact is that of the
  /// relative motion, and t, lo and hi are fractions of the step. If objects move, a query with a direction takes a
  /// step, too, in which the sensor moves by D; t is then the fraction times D. Relative motions round once.
  std::optional<std::array<double, 3>> motion{};

  /// Mode contact: counts only pairs of triangles that block, as placed at the start. A pair does not block if a plane
  /// keeps the triangles apart and the motion does not go against it: what rests on something may leave it or slide
  /// along it. Triangles in one plane that face each other and overlap block exactly if the direction goes into the
  /// object's. Exact for closed meshes, wound outwards, whose interiors are disjoint at the start; docs/exact.md has
  /// the rule.
  bool ignoreLeaving = false;
  /// Mode contact: objects whose surfaces cross the sensor's at the start, by more than the slack, take no part and are
  /// listed (Lists::overlapping). Whether a motion deepens an interpenetration cannot be told from surfaces.
  bool skipOverlapping = false;
  /// With the two above, world units: by how much rounding may have let surfaces that touch sink into each other. Faces
  /// pressed together block even so, at t = 0; crossings no deeper are no overlap. It is for rounding: far below the
  /// size of triangles. Without a value: 2^-48 times the greatest coordinate of the two shapes as placed (its terms'
  /// absolute values summed; within the bounds of a mesh that has some), which covers poses rounded once.
  std::optional<double> slack{};
  /// Mode contact, world units, at least 0: surfaces are in contact where their distance is at most this. If above 0, t
  /// is lo, and hi - lo at most `tolerance`, if rounding allows: an object that passes at the clearance to within
  /// rounding leaves the answer undecided, or lowers lo. (Slivers that are 10^11 times as long as the clearance are
  /// decided, in double-doubles.) `normal` may point along the motion if they are in contact at the start. With
  /// `ignoreLeaving`, pairs that do not block take no part, however near they come.
  double clearance = 0;
  /// With `clearance`, world units, at least 0. Without a value, or with a larger one: 1e-6 of the longest side of the
  /// sensor's box.
  std::optional<double> tolerance{};
  /// Mode contact: lists the first contacts with this many nearest objects (Lists::hits), one per object; kAllHits:
  /// with all in reach. 1: no list.
  uint32_t hits = 1;

  /// Mode sampled: pixels along the window's longer side, up to kMaxResolution. 0: chosen from the meshes.
  uint32_t resolution = 0;
};

inline constexpr uint32_t kMaxResolution = 2048;
inline constexpr uint32_t kAllHits = 0xffffffffu;

enum class Status : uint32_t {
  hit,        ///< certain contact within D: t*, the exact distance, lies in [lo, hi], hi <= D
  clear,      ///< certainly no contact within D
  overlap,    ///< certain contact at the start: t = lo = hi = 0
  undecided,  ///< no contact before lo; later contact is possible
  invalid     ///< not answered; Sweeper::reason gives the reason
};

/// The stage that produced an answer.
enum class Tier : uint32_t { select, sampled, contact, reference };

/// The paper's first step: whether any surface lies in the target volume.
enum class Detected : uint32_t {
  no,        ///< certainly none (after sampling: none at any pixel centre)
  yes,       ///< at least one
  notLooked  ///< not determined
};

/// A part of a triangle; the value is the number of its corners.
enum class Feature : uint32_t { none, vertex, edge, face };

/// Bits of Result::flags: why a Recorder (radar/recorder.h) gave no answer.
inline constexpr uint32_t kFlagUnresolved =
    1;  ///< pairs of triangles too close for the device: Recorder::read() decides
inline constexpr uint32_t kFlagCandidates = 2;  ///< Capacity::candidates, or a list of the search, was too small
inline constexpr uint32_t kFlagRounds = 4;      ///< Capacity::rounds was too small
inline constexpr uint32_t kFlagRange = 8;       ///< floats cannot hold the scene, or the sensor or D relative to it
inline constexpr uint32_t kFlagBounds = 16;     ///< something in HostGeometry has left its bounds
inline constexpr uint32_t kFlagQuery = 32;      ///< no query, or an invalid one, in HostQueries (radar/host_queries.h)

/// An answer. Layout version 3: 128 bytes, natural alignment. Absent ids are kNone. Where no contact within D is
/// certain, t, hi and fraction are +infinity, and if the answer is clear, lo is, too: distances of any answers compare.
/// Other absent numbers, and all of an invalid answer, are NaN.
///
/// If the query has `anyHit`, the status is hit (overlap included), clear or undecided; ids, features, point and
/// normal are absent, and for a hit t and fraction are; then lo is 0 and hi at most D (in mode contact: D).
struct RADAR_API Result {
  Status status = Status::invalid;
  Tier tier = Tier::select;
  Detected detected = Detected::notLooked;
  uint32_t resolution = 0;  ///< pixels along the window's longer side; 0 if no picture was drawn
  double t;                 ///< best estimate of t*, world units; tier sampled: hi
  double lo, hi;            ///< the certified bracket, world units
  double fraction;          ///< t / D (0 if D is 0); of the step, if the query takes one
  ObjectId object = kNone;  ///< the object touched
  uint32_t triB = kNone;    ///< its triangle
  uint32_t triA = kNone;    ///< the sensor's triangle
  uint32_t flags = 0;       ///< kFlag*: why a Recorder gave no answer; else 0
  /// The smallest features of the two triangles that contain every point at which they touch then, exactly; with a
  /// clearance, of the nearest points. Tier sampled: those that were found, none at the start.
  Feature featureB = Feature::none, featureA = Feature::none;
  /// World position of the contact at the moment of contact. Where featureB is a vertex, it is that corner as placed,
  /// exactly (in a step, moved with its object); where only featureA is one, that corner moved by t. Where surfaces
  /// cross at the start, it is a point of the crossing, found in plain doubles, so that needles cost digits; absent if
  /// both triangles lie in one plane and neither feature is a vertex. With a clearance, it is of the touched surface.
  std::array<double, 3> point;
  /// Unit, from the touched surface towards the sensor. Every hit in mode contact has one. To rounding, normal .
  /// direction <= 0 (in a step: the relative motion), and normal . (a - b) >= 0 for all points a of the sensor's
  /// triangle and b of the object's, when they touch. If some normal that the motion goes against keeps apart all
  /// triangles of both meshes around `point`, this one does, so that who slides along it slides; likewise all pairs
  /// that touch then, if a normal of one of them does (docs/exact.md). Starts that cross have none: at the start it
  /// exists only if contact of the two triangles begins there, and keeps these two apart. With a clearance, it lies
  /// along the line between the nearest points, and is absent where they touch. Mode sampled: that of the features
  /// found, absent if parallel.
  std::array<double, 3> normal;
  double paperMinL;  ///< the paper's literal min(L), for comparison: may be negative, too early or too late
  Result();
  /// An answer without a contact: clear or undecided, with lo to be set. Others as above.
  explicit Result(Status status);
};
inline constexpr uint32_t kResultVersion = 3;
static_assert(sizeof(Result) == 128);

/// What the queries of a batch list besides their first contacts. All vectors are empty if no query lists anything.
struct RADAR_API Lists {
  /// Of queries with `hits` above 1: the first contact with each object, by (t, object), t being exact and not rounded.
  /// Those of query i begin at hitOffsets[i] and end before hitOffsets[i + 1]. With a clearance, by (lo, object), and
  /// beside as many objects as were asked for those that are undecided: they have a lo, but no finite hi.
  std::vector<Result> hits;
  std::vector<size_t> hitOffsets;
  /// Of queries with `skipOverlapping`: the objects left out, ascending. Offsets as above.
  std::vector<ObjectId> overlapping;
  std::vector<size_t> overlappingOffsets;

  std::span<const Result> hitsOf(size_t query) const;
  std::span<const ObjectId> overlappingOf(size_t query) const;
};

/// Checks the contract of a query. Returns an empty string, or what is wrong and what was expected.
RADAR_API std::string validate(const Query& query, const Scene& scene);

}  // namespace radar
