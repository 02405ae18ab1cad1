// Certifies first contacts in double precision.
#pragma once

#include "exact/contact.h"

namespace radar::cpu {

/// A separating axis of triangles a and b: 0: the normal of a; 1: the normal of b; 2 + 3 i + k: across edge i of a and
/// edge k of b. Edge i goes from corner i to the next.
using Axis = int;

/// The features by which triangles a and b touch: 0, 1 or 2: that corner of a and the face of b; 3, 4 or 5: corner
/// (less 3) of b and the face of a; 6 + 3 i + k: edge i of a and edge k of b.
using FeatureNumber = int;
inline constexpr FeatureNumber kNoFeature = -1;

/// Certifies how contact of pairs of triangles begins. Triangles that meet in one edge or corner touch others by the
/// same features: these are tested once.
class Certificate {
 public:
  /// The features by which contact of triangle a, in motion along `direction`, with triangle b begins, whatever the
  /// time, if double precision can certify them; else kNoFeature. Certified means: these features alone are the
  /// farthest of each triangle towards the other along `axis`, and the motion takes an inner point of one to an inner
  /// point of the other.
  FeatureNumber first(const exact::Triangle& a, const exact::Triangle& b, const Vector& direction, Axis axis);
  /// The contact by the features that were certified last. It has the bits of exact::contact's `first`.
  const exact::Event& event() const { return event_; }

 private:
  FeatureNumber acrossFace(const exact::Triangle& a, const exact::Triangle& b, const Vector& d, bool ofA);
  FeatureNumber acrossEdges(const exact::Triangle& a, const exact::Triangle& b, const Vector& d, int i, int k);

  exact::Event event_;
  int side_ =
      0;  // of the motion, along the cross product of the event's edges or of its face; 0: there is no event yet
};

/// Whether the triangles may be in the plane of either, up to `slack`, in the sense of exact/blocking.h.
bool mayShareAPlane(const exact::Triangle& a, const exact::Triangle& b, double slack);

/// Whether a contact by certified features certainly blocks: everything within `slack` of the point
/// of contact, as seen along `direction`, is inside both features. Not for triangles that mayShareAPlane(): those are
/// judged by another rule.
bool certainlyBlocks(FeatureNumber feature, const exact::Triangle& a, const exact::Triangle& b, const Vector& direction,
                     double slack);

}  // namespace radar::cpu
