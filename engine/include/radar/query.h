// Queries. R, M, L and d are those of the paper that radar.h names.
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

/// Which method answers a batch.
enum class Mode : uint32_t {
  sampled,  ///< select, then the paper's method: `hi` is certain, `lo` is 0, a contact may be missed
  contact   ///< the exact search, on the device or the CPU: only a clearance, a turn or a cutter may leave it undecided
};

/// A turn by `angle`, radians, about an axis through `centre`, which moves by Query::motion meanwhile and stays in the
/// body; right-hand rule. At s of the step, 0 to 1, a point p of the sensor is at
///   x(s) = centre + s motion + R(axis / |axis|, s angle) (p - centre).
struct Turn {
  std::array<double, 3> axis{};    ///< finite, of any length; not zero unless the angle is 0, which ignores it
  double angle = 0;                ///< finite, at most 2^16
  std::array<double, 3> centre{};  ///< world coordinates, up to 2^800
};

/// What moves may be a cutter (Scene::addCutter). The CPU answers, in every sweeper. Contact is with the solid: a
/// surface inside it touches. Brackets are as narrow as rounding allows; what touches only to within rounding, or at
/// exactly the end, may be undecided. A clearance grows the solid by a ball. Result::triA is the part of the cutter,
/// featureA none; `point` is on the object, at the start inside the cutter, of the least (object, triB, part); `gap` is
/// the clearance, NaN at the start. Neither a turn, nor ignoreLeaving, skipOverlapping, closest and exit; `tolerance`
/// has no effect.
///
/// One sweep: the sensor `mesh`, placed by `worldFromMesh`, moves along `direction` for `distance`.
struct Query {
  MeshId mesh = kNone;                ///< of the scene
  Transform worldFromMesh{};          ///< invertible
  std::array<double, 3> direction{};  ///< finite, not zero; no longer than 2^1023 beside a component below 2^-1020
  double distance = 0;                ///< D >= 0, finite, world units
  bool anyHit = false;                ///< asks only whether there is contact within D: see Result. Cheaper if there is
  std::vector<ObjectId> exclude{};    ///< objects to ignore, such as the sensor's own; even thousands cost little
  uint32_t mask = ~0u;                ///< an object takes part if its mask shares a bit

  /// Mode contact, instead of `direction` and `distance`, which stay 0: how far the sensor moves during a step, world
  /// units, at constant velocity; may be zero. Objects move by Object::motion meanwhile. First contact is that of the
  /// relative motion, and t, lo and hi are fractions of the step. If objects move, a query with a direction takes a
  /// step, too, in which the sensor moves by D; t is then the fraction times D. Relative motions round once.
  std::optional<std::array<double, 3>> motion{};

  /// Mode contact, with `motion` or alone, and then without direction and distance: the sensor turns during the step.
  /// An angle of 0 is the step alone. What is exact is the motion as stated, of the doubles given, though not its
  /// answers: t, a fraction of the step, is lo, before which surfaces certainly have no point in common, and at hi they
  /// certainly cross (with a clearance, are nearer). (hi - lo) times the greatest speed of the sensor past the object
  /// is at most `tolerance`, where a contact gets deeper than that. One that does not may be undecided, as may one
  /// within rounding of the end. Contact at the start is exact. Not with `ignoreLeaving` and a clearance at once;
  /// docs/query-file.md, "Options together", tells what blocks a turn.
  std::optional<Turn> turn{};

  /// Mode contact: counts only pairs of triangles that block, as placed at the start. A pair does not block if a plane
  /// keeps the triangles apart and the motion does not go against it: what rests on something may leave it or slide
  /// along it. Triangles in one plane that face each other and overlap block exactly if the motion would sink into
  /// the object's by more than the slack. Exact for closed meshes, wound outwards, whose interiors are disjoint at the
  /// start; docs/exact.md has the rule.
  bool ignoreLeaving = false;
  /// Mode contact: objects whose surfaces cross the sensor's at the start, by more than the slack, take no part and are
  /// listed (Listed::overlapping). Whether a motion deepens an interpenetration cannot be told from surfaces.
  bool skipOverlapping = false;
  /// With the two above, world units: how deep rounding may have sunk surfaces that touch into each other. Faces
  /// pressed together so deep block nevertheless, at t = 0; crossings no deeper are no overlap. It is for rounding: far
  /// below the size of triangles, and at most a tenth of the longest side of the sensor's box or of the clearance.
  /// Without a value: 2^-48 times the greatest coordinate of the two shapes as placed (its terms' absolute values
  /// summed; within the bounds of a mesh that has some), which covers poses rounded once.
  std::optional<double> slack{};
  /// Mode contact, world units, at least 0: surfaces are in contact where their distance is at most this. If above 0, t
  /// is lo, and hi - lo at most `tolerance`, if rounding allows: an object that passes at the clearance to within
  /// rounding leaves the answer undecided, or lowers lo. (Slivers that are 10^11 times as long as the clearance are
  /// decided, in double-doubles.) `normal` may point along the motion if they are in contact at the start. With
  /// `skipOverlapping`, what is within the clearance without crossing stays; with `ignoreLeaving`, distances tell what
  /// blocks. What options mean together is in docs/query-file.md, "Options together".
  double clearance = 0;
  /// With `clearance` or a turn, world units, at least 0. Without a value, or with a larger one: 1e-6 of the longest
  /// side of the sensor's box, or of the clearance if that is longer.
  std::optional<double> tolerance{};
  /// Mode contact: lists the first contacts with this many nearest objects (Listed::hits), one per object; kAllHits:
  /// with all in reach. 1: no list.
  uint32_t hits = 1;
  /// Mode contact: also finds how near the sensor comes to objects on the whole of its way (Listed::closest). Neither
  /// with a turn nor with `ignoreLeaving`.
  bool closest = false;
  /// Mode contact: also finds when the last contact on the way ends (Listed::exit): the way out for what overlaps. As
  /// `closest`.
  bool exit = false;

  /// Mode sampled: pixels along the window's longer side, up to kMaxResolution. 0: chosen from the meshes. Not one of
  /// SweeperOptions, since one Sweeper draws pictures of many sizes, also within a batch.
  uint32_t resolution = 0;
};

inline constexpr uint32_t kMaxResolution = 2048;
inline constexpr uint32_t kAllHits = 0xffffffffu;

/// Checks the contract of a query in a batch of that mode. Returns an empty string, or what is wrong and what was
/// expected.
RADAR_API std::string validate(const Query& query, const Scene& scene, Mode mode = Mode::contact);

}  // namespace radar
