// The earliest contact among pairs of triangles, and the answer it makes.
#pragma once

#include <compare>
#include <optional>

#include "exact/contact.h"
#include "exact/motion.h"

namespace radar::exact {

/// Names a pair of triangles. Of pairs that meet at the same time the least name wins.
struct PairName {
  ObjectId object = kNone;
  uint32_t triB = kNone, triA = kNone;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the zero compared with for a pointer
  friend auto operator<=>(const PairName&, const PairName&) = default;
};

/// The sensor's triangle and the scene's, placed.
struct PlacedPair {
  Triangle a, b;
};

class EarliestContact {
 public:
  /// `motion` must stay in place while pairs are considered.
  explicit EarliestContact(const Motion& motion) : motion_(&motion), kept_(motion) {}

  /// The motion of the pairs that are considered next: in a step, each object has its own.
  void setMotion(const Motion& motion) { motion_ = &motion; }

  /// Computes the pair's contact exactly, and keeps it if it is the earliest so far and `counts()`, which is asked
  /// last. Returns whether it was kept.
  template <class Counts>
  bool consider(const PairName& name, const PlacedPair& pair, const Counts& counts) {
    const std::optional<Beginning> beginning = beginningOf(pair);
    return beginning && precedes(name, *beginning) && counts() && keep(name, pair, *beginning);
  }
  /// The same for a contact that is known to begin at `first`, not before the start.
  template <class Counts>
  bool considerKnown(const PairName& name, const PlacedPair& pair, const Event& first, const Counts& counts) {
    const Beginning beginning{first, false, featuresOf(first)};
    return precedes(name, beginning) && counts() && keep(name, pair, beginning);
  }
  /// The same for a pair that counts.
  bool consider(const PairName& name, const PlacedPair& pair) {
    return consider(name, pair, [] { return true; });
  }
  /// The same for a pair that touches at the start, up to the slack of a query, if it has not met before: see
  /// arePressed().
  bool considerPressed(const PairName& name, const PlacedPair& pair);

  bool found() const { return found_; }
  /// Whether the earliest contact is at the start.
  bool overlaps() const { return overlap_; }
  const PairName& name() const { return name_; }
  /// Where contact of the pair begins; not after the start, or unknown, if overlaps().
  const Event& event() const { return event_; }
  /// Whether this contact comes before another one, by (time, name). Both are found, for the same query.
  bool precedes(const EarliestContact& other) const;
  /// The answer to a query for the first contact, or with `anyHit` for any, without the tier; clear if none was found.
  Result answer(bool anyHit) const;

 private:
  /// How contact at or after the start begins.
  struct Beginning {
    Event first;
    bool overlap;  ///< at the start
    Features features;
  };
  std::optional<Beginning> beginningOf(const PlacedPair& pair) const;
  bool precedes(const PairName& name, const Beginning& beginning) const;
  bool keep(const PairName& name, const PlacedPair& pair, const Beginning& beginning);
  static int compareTimes(bool overlap, const Event& event, const EarliestContact& other);
  static int compareToEnd(const Event& event, const Motion& motion);
  void describe(Result& result) const;
  void setBracket(Result& result, double t) const;

  const Motion* motion_;
  Motion kept_;  // of the earliest contact
  bool found_ = false;
  bool overlap_ = false;
  PairName name_;
  PlacedPair pair_{};
  Event event_{};
  Features features_;
};

}  // namespace radar::exact
