// The normal of a first contact, in which several pairs of triangles may meet at once.
#pragma once

#include <span>

#include "exact/contact.h"

namespace radar::exact {

/// A pair that touches at the moment of first contact.
struct TouchingPair {
  PairName name;
  PlacedPair placed;
};

/// A unit vector n, off by its rounding only, with n . direction < 0 that keeps the triangles of the first of `pairs`
/// apart at the moment of contact: n . (a - b) >= 0 for all their points. Its contact begins with `first`, then at
/// points of this span. The others of `pairs` touch at the same moment, and are of the same two meshes. If there is a
/// normal that keeps all triangles around point(first) apart, n is one; and if a normal of a pair keeps all pairs
/// apart, n does (docs/exact.md). The order of the others does not matter.
Vector contactNormal(const Event& first, const Span& span, std::span<const TouchingPair* const> pairs);

}  // namespace radar::exact
