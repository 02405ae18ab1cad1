// Finds a query's contacts among the pairs of triangles that a search passes to it: the first, or the first with each
// of the nearest objects.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "cpu/approach.h"
#include "cpu/certificate.h"
#include "exact/blocking.h"
#include "exact/earliest_contact.h"
#include "exact/nearness.h"

namespace radar::cpu {

/// Of a triangle that is ahead of another one along `way`, of length 1, by more than `by`, world units: moving that
/// way, it only gets farther from it. Without a `way` nothing is.
struct Lead {
  Vector way{};
  double by = 0;
};

/// What a search over pairs of triangles serves: finds the pairs that matter and bounds those still wanted.
class PairVisitor {
 public:
  PairVisitor(const PairVisitor&) = delete;
  PairVisitor& operator=(const PairVisitor&) = delete;

  /// Considers a pair of placed triangles that probably meet first along `axis`.
  virtual void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) = 0;

  /// Whether no further pair matters.
  bool isDecided() const { return decided_; }
  /// No contact later than this t of the motion matters.
  double latest() const { return latest_; }
  /// Whether some pair meets at the start.
  bool meetsAtStart() const { return atStart_; }
  /// Whether `least` and all pairs after it are ruled out, because a lesser pair meets at the start.
  bool isBefore(const exact::PairName& least) const { return atStart_ && first_ < least; }
  /// With a clearance: across the gap of a pair found so far, along which others probably are farther apart; 0 if none
  /// is known.
  const Vector& across() const { return across_; }
  /// Pairs with this lead do not matter.
  const Lead& lead() const { return lead_; }

 protected:
  explicit PairVisitor(double latest) : latest_(latest) {}
  ~PairVisitor() = default;

  double latest_;
  bool decided_ = false;
  bool atStart_ = false;
  exact::PairName first_;  // the least of these
  Vector across_{};
  Lead lead_;
};

/// How far the sensor moves on a piece of its way while contacts still matter, world units; negative: none does.
inline double reachOf(const PairVisitor& visitor, const Piece& piece) {
  return visitor.isDecided() || visitor.latest() < piece.from ? -1 : piece.wayUntil(visitor.latest());
}

/// How the pairs of a sensor and an object are judged (exact/blocking.h).
struct PairRule {
  double slack = 0;
  exact::Mirrored mirrored;

  bool blocks(const exact::PlacedPair& pair, const Translation& motion) const {
    return exact::blocks(pair.a, pair.b, exact::wayOf(motion), slack, mirrored);
  }
  /// With a clearance.
  bool blocks(const exact::PlacedPair& pair, const Translation& motion, double clearance) const {
    if (touchAtCorners(pair)) return blocks(pair, motion);
    const Nearing nearing =
        motion.stands ? Nearing::open : nearingOf(pair.a, pair.b, motion.direction, clearance, slack);
    if (nearing == Nearing::pressed) return blocks(pair, motion);
    if (nearing != Nearing::open) return nearing == Nearing::yes;
    return exact::blocksWithin(pair.a, pair.b, exact::wayOf(motion), clearance, slack, mirrored);
  }
  /// Whether a pair certainly does not block, with a clearance, as far as less time tells than bounding its distance.
  bool leaves(const exact::PlacedPair& pair, const Translation& motion, double clearance) const {
    if (clearance > slack && staysLevel(pair.a, pair.b, motion.unit, slack)) return true;
    return touchAtCorners(pair) && !blocks(pair, motion);
  }
  /// Pairs with this lead do not block. What is pressed together may have sunk in by the slack.
  Lead leadOf(const Translation& motion) const { return {motion.stands ? Vector{} : motion.unit, 2 * slack}; }
  bool arePressed(const exact::PlacedPair& pair, const Translation& motion) const {
    return exact::arePressed(pair.a, pair.b, exact::wayOf(motion), slack, mirrored);
  }

 private:
  /// Whether two corners certainly are no farther apart than the slack: then there is no distance to lose.
  bool touchAtCorners(const exact::PlacedPair& pair) const {
    for (const Vector& a : pair.a) {
      for (const Vector& b : pair.b) {
        if ((1 + 4 * kUnit) * norm1(minus(a, b)) <= slack) return true;
      }
    }
    return false;
  }
};

/// Adds the first contact with an object to those with the `most` nearest, earliest first. Returns the t after which no
/// contact is one of them.
template <class Contact>
double addNearest(std::vector<Contact>& nearest, size_t most, Contact contact) {
  const auto isBefore = [](const Contact& p, const Contact& q) { return p.precedes(q); };
  const auto place = std::upper_bound(nearest.begin(), nearest.end(), contact, isBefore);
  nearest.insert(place, std::move(contact));
  if (nearest.size() > most) nearest.pop_back();
  return nearest.size() == most ? nearest.back().latest() : std::numeric_limits<double>::infinity();
}

class FirstContact final : public PairVisitor {
 public:
  /// `query` and `motion` must outlive this. `memory`: what an earlier one gave back, so that none is allocated.
  FirstContact(const Query& query, const Translation& motion, std::vector<exact::TouchingPair> memory = {});
  std::vector<exact::TouchingPair> giveBack() { return earliest_.giveBack(); }

  /// Call before and after the pairs of one object. `rule` matters only if the query ignores pairs that do not block.
  /// `motion` must stay in place until the next object, or until the answers are taken.
  void beginObject(const PairRule& rule, const Translation& motion);
  void endObject();

  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) override;

  /// The answers, without their tiers: the first contact, or clear; and the contacts with the nearest objects, by (t,
  /// object), if the query asks for more than one.
  Result first() const;
  std::vector<Result> nearest() const;

 private:
  bool considerExactly(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis);

  const Query& query_;
  const Translation* motion_;  // past the current object
  PairRule rule_;
  Certificate certificate_;
  exact::EarliestContact earliest_;              // of all objects, or of the current one if several are asked for
  std::vector<exact::EarliestContact> nearest_;  // one per object, earliest first
};

/// Finds out whether surfaces cross at the start.
class CrossingTest final : public PairVisitor {
 public:
  CrossingTest() : PairVisitor(0) {}

  /// Call before and after the pairs of one object.
  void beginObject(const PairRule& rule, const Translation&) { rule_ = rule; }
  /// Returns whether the surfaces of the sensor and the object cross.
  bool endObject() { return std::exchange(decided_, false); }

  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) override;

 private:
  PairRule rule_;
};

}  // namespace radar::cpu
