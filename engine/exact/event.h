// Construction of events. The makers expect features that are incident as seen along the direction and whose
// determinant with it is not zero.
#pragma once

#include "exact/contact.h"
#include "exact/dyadic.h"

namespace radar::exact {

Event vertexFace(const Vec& direction, const Vec& a, const Triangle& b);
Event faceVertex(const Vec& direction, const Triangle& a, const Vec& b);
Event edgeEdge(const Vec& direction, const Vec& a0, const Vec& a1, const Vec& b0, const Vec& b1);
/// `axis`: a component in which direction x edge is not zero.
Event vertexEdge(const Vec& direction, const Vec& a, const Vec& b0, const Vec& b1, int axis);
Event edgeVertex(const Vec& direction, const Vec& a0, const Vec& a1, const Vec& b, int axis);
Event vertexVertex(const Vec& direction, const Vec& a, const Vec& b);

/// An event's parameter as the exact fraction it is.
struct Ratio {
  Dyadic num, den;
};
Ratio ratio(const Event& event);
/// -1, 0 or 1.
int compare(const Ratio& p, const Ratio& q);
/// The same of two events' parameters, if floating point suffices to tell.
std::optional<int> compareRoughly(const Event& p, const Event& q);

/// A total order of the events of one direction by kind and coordinates. Two events of which neither precedes the other
/// are the same.
bool precedes(const Event& p, const Event& q);

}  // namespace radar::exact
