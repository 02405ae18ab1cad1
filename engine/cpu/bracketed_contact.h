// Finds the first contact, or the first with each of the nearest objects, where only a bracket of each pair's can be
// computed.
#pragma once

#include <optional>
#include <vector>

#include "cpu/first_contact.h"

namespace radar::cpu {

/// The answer does not depend on the order of the pairs, nor on those that come later than contact by the tolerance.
/// What contact is, and how it is bracketed, is a derived class's.
class BracketedContact : public PairVisitor {
 public:
  /// As of FirstContact.
  void endObject();
  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis axis) final;
  Result first() const;
  /// Whether the first contact found so far is one with the object.
  bool isFirst(ObjectId object) const { return best_ && best_->name.object == object; }
  std::vector<Result> nearest() const;

 protected:
  /// t ends at `end`. `tolerance`: the greatest width, units of t, of a bracket that rounding does not widen; 0 if
  /// pairs need not be considered that come later than contact. `query` must outlive this.
  BracketedContact(const Query& query, double end, double tolerance);
  ~BracketedContact() = default;

  /// The pair's bracket, units of t; none if it certainly does not meet, or not in time to matter.
  virtual std::optional<Approach> bracketOf(const exact::PairName& name, const exact::PlacedPair& pair) = 0;
  /// Whether a pair that meets is a contact of the query. Asked last.
  virtual bool counts(const exact::PlacedPair& pair) const = 0;
  /// Whether a pair was found: of the current object, if several are asked for.
  bool hasFound() const { return best_.has_value(); }

  const Query& query_;

 private:
  struct Near {
    exact::PairName name;
    Approach approach;
    double lo;  ///< nothing considered together with this pair meets before this

    bool isCertain() const;
    bool precedes(const Near& other) const;
    double latest() const { return approach.hi; }
  };
  Result answer(const Near& near) const;

  double end_, tolerance_;
  double lo_;                  // nothing meets before this
  std::optional<Near> best_;   // of all objects, or of the current one if several are asked for
  std::vector<Near> nearest_;  // one per object, earliest first
  std::vector<Near> open_;     // of objects that rounding leaves open
};

/// Sets features, point, normal and gap.
void setSeparation(Result& result, const Separation& separation);

}  // namespace radar::cpu
