// Exact decisions on contact of two triangles along a direction.
//
// Triangle a moves by s * direction, for real s. The values of s at which it meets b, if any, form one closed interval,
// because the difference set b - a is convex. Its ends are Events: a vertex over a closed face, or a crossing of two
// edges, as seen along the direction. Coordinates are taken as exact; every decision below is that of real arithmetic,
// for all finite doubles.
//
// Degenerate triangles are treated as segments or points; triangles may be edge-on to the direction.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>

#include "math/vector.h"
#include "radar/codes.h"
#include "radar/scene.h"

namespace radar::exact {

using Triangle = std::array<Vector, 3>;

/// Names a pair of triangles. Of pairs that meet at the same time the least name wins.
struct PairName {
  ObjectId object = kNone;
  uint32_t triB = kNone, triA = kNone;
  friend auto operator<=>(const PairName&, const PairName&) = default;
};

/// The sensor's triangle and the scene's, placed.
struct PlacedPair {
  Triangle a, b;
};

/// Replaces -0 by 0, so that device and CPU give the same bits: Vulkan does not define the sign of 0.
inline Vector withoutZeroSigns(Vector v) {
  for (double& c : v) c = c == 0 ? 0 : c;
  return v;
}

/// The features that touch: of the moving triangle, then of the resting one. The last three occur only where both
/// triangles lie in one plane that contains the direction.
enum class Kind : uint8_t { vertexFace, faceVertex, edgeEdge, vertexEdge, edgeVertex, vertexVertex };

/// One end of a contact interval: the parameter s = det(to - from, x, y) / det(direction, x, y), where x = x1 - x0 and
/// y = y1 - y0 are edges of the two features (or unit vectors if the features leave a choice). The order of its
/// vertices depends on their coordinates only, so that the same two features give the same bits in any triangles.
struct Event {
  Kind kind;
  Vector direction;
  Vector from, to;  ///< vertices of the moving and of the resting feature
  Vector x0, x1, y0, y1;
  double s;      ///< the parameter, approximately
  double error;  ///< bound on |s - exact parameter|; may be infinite
};

/// The smallest features of two triangles that contain every point at which they touch.
struct Features {
  Feature a = Feature::none, b = Feature::none;
};

/// The corners of two triangles that span every point at which they touch: bit i is set if corner i does, and none
/// before it is in the same place.
struct Span {
  unsigned a = 0, b = 0;
  Features features() const;
};

struct Interval {
  Event first, last;
  Span atFirst, atLast, between;  ///< `between` first and last, at any parameter
  /// Whether contact begins at one point, inside both features of `first`: then there is one normal.
  bool isSharp;
};

/// What is to be known of an interval that begins after the start, at s > 0: all, or only its beginning, which costs
/// less; `last`, atLast are then `first`, atFirst.
enum class Ahead { whole, beginning };

/// The interval of contact; none if the triangles do not meet for any s. `direction` is not zero.
std::optional<Interval> contact(const Triangle& a, const Triangle& b, const Vector& direction,
                                Ahead ahead = Ahead::whole);

/// -1, 0 or 1: the sign of the event's parameter.
int sign(const Event& event);
/// -1, 0 or 1: the parameter of p is below, equal to or above that of q.
int compare(const Event& p, const Event& q);
/// -1, 0 or 1: the event's distance s * |direction| is below, equal to or above `distance`, which is not negative.
int compareToDistance(const Event& event, double distance);
/// -1, 0 or 1: the event's parameter is below, equal to or above `parameter`.
int compareToParameter(const Event& event, double parameter);
/// The event's parameter: the double nearest to an approximation with a relative error below 2^-60. Events of the same
/// features have the same bits.
double parameter(const Event& event);
/// |direction|, rounded to the nearest double.
double length(const Vector& direction);

/// The point of contact after moving by `s` = parameter(event).
Vector point(const Event& event, double s);
/// Unit normal of the contact with normal . direction <= 0: of the face, or across both edges. NaN if the features do
/// not determine it (the last three kinds).
Vector normal(const Event& event);

/// The features that touch at an event which is the only one of its pair at this time, and inside both features.
Features featuresOf(const Event& event);

}  // namespace radar::exact
