// Contact of two triangles along a direction, decided exactly.
//
// Triangle a moves by s * direction, s a real number. The s at which its surface meets that of b, if any, are one
// closed interval, because the difference set b - a is convex. Its ends are Events: a vertex over a closed face, or a
// crossing of two edges, as seen along the direction. Coordinates are taken as the doubles they are; every decision
// below is the one that real arithmetic would make, for all finite doubles.
//
// Degenerate triangles count as what they are (a segment, a point), and so do triangles edge-on to the direction.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "math/vector.h"

namespace radar::exact {

using Triangle = std::array<Vector, 3>;

/// With 0 for -0: Vulkan lets a device lose the sign of 0, and both give the same bits.
inline Vector withoutZeroSigns(Vector v) {
  for (double& c : v) c = c == 0 ? 0 : c;
  return v;
}

/// What touches what: of the moving triangle first, of the resting one second. The last three occur only where both
/// triangles lie in one plane that contains the direction.
enum class Kind : uint8_t { vertexFace, faceVertex, edgeEdge, vertexEdge, edgeVertex, vertexVertex };

/// One end of a contact interval: the parameter s = det(to - from, x, y) / det(direction, x, y), where x = x1 - x0 and
/// y = y1 - y0 are edges of the two features (or unit vectors where the features leave a choice). Its vertices are held
/// in an order that depends on their coordinates only, so that the same two features give the same bits, whichever
/// triangles they were found in.
struct Event {
  Kind kind;
  Vector direction;
  Vector from, to;  ///< a vertex of the moving feature, a vertex of the resting one
  Vector x0, x1, y0, y1;
  double s;      ///< the parameter, approximately
  double error;  ///< bound on |s - exact parameter|; may be infinite
};

struct Interval {
  Event first, last;
};

/// The interval of contact; none where the triangles do not meet for any s. `direction` is not zero.
std::optional<Interval> contact(const Triangle& a, const Triangle& b, const Vector& direction);

/// -1, 0 or 1: the sign of the event's parameter.
int sign(const Event& event);
/// -1, 0 or 1: p before, at or after q. Both events are of the same direction.
int compare(const Event& p, const Event& q);
/// -1, 0 or 1: the event's distance s * |direction| is below, equal to or above `distance`, which is not negative.
int compareToDistance(const Event& event, double distance);
/// The event's parameter: the double nearest to some number that is off by less than 2^-60 of it. Events of the same
/// features have the same bits.
double parameter(const Event& event);
/// |direction|, rounded to the nearest double.
double length(const Vector& direction);

/// Where the features touch, once the moving one has been moved by `s` = parameter(event).
Vector point(const Event& event, double s);
/// Unit normal of the contact with normal . direction <= 0: of the face, or across both edges. NaN where the features
/// leave it open (the kinds of one plane).
Vector normal(const Event& event);

/// How many decisions of this thread needed exact integers so far, because no filter in floating point sufficed.
uint64_t exactDecisions();

}  // namespace radar::exact
