// Construction of events. The features must be incident as seen along the direction, and their determinant with it not
// zero.
#pragma once

#include "exact/contact.h"
#include "exact/dyadic.h"
#include "exact/three.h"

namespace radar::exact {

/// The corners in the order in which events have them.
Triangle sorted(Triangle t);
Event vertexFace(const Vector& direction, const Vector& a, const Triangle& b);
Event faceVertex(const Vector& direction, const Triangle& a, const Vector& b);
Event edgeEdge(const Vector& direction, const Vector& a0, const Vector& a1, const Vector& b0, const Vector& b1);
/// `axis`: a component in which direction x edge is not zero.
Event vertexEdge(const Vector& direction, const Vector& a, const Vector& b0, const Vector& b1, int axis);
Event edgeVertex(const Vector& direction, const Vector& a0, const Vector& a1, const Vector& b, int axis);
Event vertexVertex(const Vector& direction, const Vector& a, const Vector& b);

/// The unit vector along v, which is not zero; every component is off by a few roundings of itself.
Vector unitOf(const Three<Dyadic>& v);

/// An event's parameter as an exact fraction.
struct Ratio {
  Dyadic num, den;
};
Ratio ratio(const Event& event);
/// -1, 0 or 1.
int compare(const Ratio& p, const Ratio& q);
/// The same for two events' parameters, if floating point suffices.
std::optional<int> compareRoughly(const Event& p, const Event& q);

/// A total order of events, by kind and coordinates. If neither of two events precedes the other, they are the same.
bool precedes(const Event& p, const Event& q);

}  // namespace radar::exact
