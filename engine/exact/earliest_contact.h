// The earliest contact among pairs of triangles, and the answer it makes.
#pragma once

#include <optional>
#include <vector>

#include "exact/contact_normal.h"
#include "exact/translation.h"
#include "radar/answers.h"

namespace radar::exact {

class EarliestContact {
 public:
  /// `motion` must stay in place while pairs are considered.
  explicit EarliestContact(const Translation& motion) : motion_(&motion), kept_(motion) {}
  /// In the memory that an earlier one gave back.
  EarliestContact(const Translation& motion, std::vector<TouchingPair> memory) : EarliestContact(motion) {
    touching_ = std::move(memory);
    touching_.clear();
  }
  std::vector<TouchingPair> giveBack() { return std::move(touching_); }
  /// Forgets all pairs.
  void clear() {
    found_ = overlap_ = false;
    touching_.clear();
  }

  /// The motion of the pairs that are considered next: in a step, each object has its own.
  void setMotion(const Translation& motion) { motion_ = &motion; }

  /// Computes the pair's contact exactly, and keeps it if it is the earliest so far and `counts()`, which is asked
  /// last. Returns whether it was kept. Once a pair that meets at the start is kept, only lesser names may follow.
  template <class Counts>
  bool consider(const PairName& name, const PlacedPair& pair, const Counts& counts) {
    const std::optional<Beginning> beginning = beginningOf(pair);
    return beginning && offer(name, pair, *beginning, counts);
  }
  /// The same for a contact that is known to begin at `first`, not before the start.
  template <class Counts>
  bool considerKnown(const PairName& name, const PlacedPair& pair, const Event& first, const Counts& counts) {
    const Beginning beginning{first, false, featuresOf(first), {}, true};
    return offer(name, pair, beginning, counts);
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
  /// A t a little beyond that of the earliest contact, by what the parameter, the length and the product may have lost.
  double latest() const;
  /// Whether this contact comes before another one, by (time, name). Both are found, for the same query.
  bool precedes(const EarliestContact& other) const;
  /// -1, 0 or 1: the event comes before, at or after the end of the motion.
  static int compareToEnd(const Event& event, const Translation& motion);
  /// Sets t, its bracket and the fraction to those of an event at `s` = parameter(event), after the start and not after
  /// the end.
  static void setTimes(Result& result, const Event& event, double s, const Translation& motion);
  /// The answer to a query for the first contact, or with `anyHit` for any, without the tier; clear if none was found.
  Result answer(bool anyHit) const;

 private:
  /// How contact at or after the start begins.
  struct Beginning {
    Event first;
    bool overlap;  ///< at the start
    Features features;
    Span span;     ///< of all points at which they touch then; not set if `isSharp`
    bool isSharp;  ///< as of an Interval
  };
  std::optional<Beginning> beginningOf(const PlacedPair& pair) const;
  template <class Counts>
  bool offer(const PairName& name, const PlacedPair& pair, const Beginning& beginning, const Counts& counts) {
    const int order = orderOf(beginning);
    return order <= 0 && counts() && keep(name, pair, beginning, order);
  }
  /// -1, 0 or 1: it comes before the earliest so far; with it; later, or too late.
  int orderOf(const Beginning& beginning) const;
  bool keep(const PairName& name, const PlacedPair& pair, const Beginning& beginning, int order);
  static int compareTimes(bool overlap, const Event& event, const EarliestContact& other);
  void describe(Result& result) const;
  /// After moving by `s`. `begins`: contact does then, else it has begun before the start.
  Vector pointAt(double s, bool begins) const;
  Vector normalOf() const;

  const Translation* motion_;
  Translation kept_;  // of the earliest contact
  bool found_ = false;
  bool overlap_ = false;
  PairName name_;
  PlacedPair pair_;
  Event event_;
  Features features_;
  Span span_;
  bool isSharp_ = false;
  std::vector<TouchingPair> touching_;  ///< others that meet then, of any objects; none if that is at the start
};

}  // namespace radar::exact
