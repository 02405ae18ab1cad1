#include "cpu/first_contact.h"

#include <algorithm>

namespace radar::cpu {

FirstContact::FirstContact(const Query& query, const Translation& motion, std::vector<exact::TouchingPair> memory)
    : PairVisitor(motion.end), query_(query), motion_(&motion), earliest_(motion, std::move(memory)) {}

void FirstContact::beginObject(const PairRule& rule, const Translation& motion) {
  rule_ = rule;
  if (!motion.isStep) return;
  motion_ = &motion;
  earliest_.setMotion(motion);
}

// Returns whether the pair is the earliest so far.
bool FirstContact::considerExactly(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) {
  const Vector& d = motion_->direction;
  const auto doesBlock = [&] { return !query_.ignoreLeaving || rule_.blocks(pair, *motion_); };
  const bool mayBePressed = query_.ignoreLeaving && mayShareAPlane(pair.a, pair.b, rule_.slack);
  const exact::Event& event = certificate_.event();
  bool isCertain = false;
  if (const FeatureNumber feature = certificate_.first(pair.a, pair.b, d, axis); feature != kNoFeature) {
    if (event.s > event.error) {
      if (!mayBePressed) {
        return earliest_.considerKnown(name, pair, event, [&] {
          return !query_.ignoreLeaving || certainlyBlocks(feature, pair.a, pair.b, d, rule_.slack) || doesBlock();
        });
      }
      isCertain = true;
    }
  }
  if (mayBePressed && rule_.arePressed(pair, *motion_)) return earliest_.considerPressed(name, pair);
  if (isCertain) return earliest_.considerKnown(name, pair, event, doesBlock);
  // Most pairs that touch at the start do not block, and that takes less time to decide than their contact.
  return doesBlock() && earliest_.consider(name, pair);
}

void FirstContact::consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) {
  if (isBefore(name) || !considerExactly(name, pair, axis)) return;
  decided_ = query_.anyHit;
  atStart_ = earliest_.overlaps();
  first_ = earliest_.name();
  latest_ = std::min(latest_, earliest_.latest());
}

void FirstContact::endObject() {
  if (query_.hits == 1 || !earliest_.found()) return;
  latest_ = std::min(motion_->end, addNearest(nearest_, query_.hits, std::move(earliest_)));
  atStart_ = false;
  earliest_.clear();
}

Result FirstContact::first() const {
  return nearest_.empty() ? earliest_.answer(query_.anyHit) : nearest_.front().answer(false);
}

std::vector<Result> FirstContact::nearest() const {
  std::vector<Result> results;
  results.reserve(nearest_.size());
  for (const exact::EarliestContact& contact : nearest_) results.push_back(contact.answer(false));
  return results;
}

void CrossingTest::consider(const exact::PairName&, const exact::PlacedPair& pair, Axis) {
  decided_ = decided_ || exact::cross(pair.a, pair.b, rule_.slack);
}

}  // namespace radar::cpu
