#include "cpu/first_contact.h"

#include <algorithm>

#include "cpu/certificate.h"
#include "cpu/swept_overlap.h"

namespace radar::cpu {

FirstContact::FirstContact(const Motion& motion, bool anyHit, const Vector& sensor, double size)
    : motion_(motion), anyHit_(anyHit), view_(sensor, size, motion.unit), earliest_(motion), latest_(motion.distance) {}

// Returns whether the pair is the earliest so far.
bool FirstContact::considerExactly(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) {
  const Vector& d = motion_.direction;
  if (const Feature feature = certainlyFirst(pair.a, pair.b, d, axis); feature != kNoFeature) {
    const exact::Event event = eventOf(feature, pair.a, pair.b, d);
    if (event.s > event.error) return earliest_.considerKnown(name, pair, event);
  }
  if (!mayMeet(ViewedTriangle(pair.a, view_), ViewedTriangle(pair.b, view_), view_.scale * latest_)) return false;
  return earliest_.consider(name, pair);
}

void FirstContact::consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) {
  if (isBefore(name) || !considerExactly(name, pair, axis)) return;
  // A distance a little beyond t*, by what the parameter, the length and the product may have lost.
  double latest = 0;
  if (!earliest_.overlaps()) {
    const exact::Event& first = earliest_.event();
    const bool rough = first.error > 1e-12 * first.s;
    const double s = rough ? exact::parameter(first) : first.s + first.error;
    latest = s * motion_.length * (1 + 8 * kUnit);
  }
  latest_ = std::min(motion_.distance, latest);
}

}  // namespace radar::cpu
