// First contacts that double precision can certify.
#pragma once

#include "cpu/leaf_test.h"

namespace radar::cpu {

/// By what two triangles a and b touch: corner 0, 1 or 2 of a and the face of b, corner (less 3) of b and the face of
/// a, or edge i of a and edge k of b, 6 + 3 i + k.
using Feature = int;
inline constexpr Feature kNoFeature = -1;

/// The features by which contact of triangle a, in motion along `direction`, and triangle b begins, at whatever time,
/// if double precision is certain of these: what the two have farthest towards each other across `axis` are these
/// features and nothing else, and the motion takes an inner point of one to an inner point of the other. Else
/// kNoFeature.
Feature certainlyFirst(const exact::Triangle& a, const exact::Triangle& b, const Vector& direction, Axis axis);

/// Contact by features of which the former is certain: the `first` of exact::contact, to the bit.
exact::Event eventOf(Feature feature, const exact::Triangle& a, const exact::Triangle& b, const Vector& direction);

}  // namespace radar::cpu
