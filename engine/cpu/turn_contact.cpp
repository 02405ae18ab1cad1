#include "cpu/turn_contact.h"

#include <cmath>
#include <limits>

namespace radar::cpu {

/// About a corner of b.
class TurnContact::Path final : public PairPath {
 public:
  Path(const TurnContact& contact, const exact::PlacedPair& pair)
      : PairPath(contact.query_.clearance),
        turning_(contact.motion_.turning()),
        start_(pair.a),
        resting_(pair.b),
        way_(minus(turning_.way(), contact.drift_)),
        drift_(contact.drift_),
        mirrored_(contact.rule_.mirrored) {
    if (contact.query_.ignoreLeaving) slack_ = std::max(contact.rule_.slack, std::numeric_limits<double>::min());
    double most = norm1(way_), arm = 0, radius = 0;
    for (int i = 0; i < 3; ++i) {
      const Vector r = minus(start_[i], turning_.centre());
      circle_[i] = turning_.circleOf(start_[i]);
      from_[i] = minus(start_[i], resting_[0]);
      b_[i] = minus(resting_[i], resting_[0]);
      arm = std::max(arm, norm1(r));
      radius = std::max(radius, norm1(circle_[i].across));
      most = std::max({most, norm1(from_[i]), norm1(b_[i])});
    }
    radius = (1 + 0x1p-40) * radius + 0x1p-46 * arm;
    const double angle = turning_.angle();
    axis_ = turning_.axis();
    speed_ = (1 + 0x1p-40) * (norm1(way_) + angle * radius);
    most += std::min(2.0, angle) * radius + clearance_;
    bend_ = radius * angle * angle / 8;
    // Of a corner's place relative to the other triangle, of a bend's straight way, and of times.
    error_ = turning_.errorFor(arm, way_) + 16 * kUnit * (most + speed_);
    setUnit(most);
    for (Vector& corner : b_) corner = scaled(unit_, corner);
  }

  Places at(double s) const override {
    const Turning::Angle angle = turning_.angleAt(s);
    Places out{{}, b_};
    for (int i = 0; i < 3; ++i) {
      out.a[i] = scaled(unit_, radar::along(from_[i], 1, Turning::by(circle_[i], angle, s, way_)));
    }
    return out;
  }
  /// Exactly, without a clearance.
  Start atStart() const override {
    if (slack_ > 0) return beforeLeaving();
    if (clearance_ > 0 && certainlyWithin(start_, resting_, {}, clearance_)) return Start::meet;
    const Translation still(Vector{}, {});
    exact::EarliestContact touching(still);
    touching.consider({}, {start_, resting_});
    return touching.found() ? Start::meet : Start::open;
  }
  Separation separationAt(double s) const override {
    const Turning::Angle angle = turning_.angleAt(s);
    exact::Triangle a = start_;
    for (int i = 0; i < 3; ++i) a[i] = radar::along(a[i], 1, Turning::by(circle_[i], angle, s, way_));
    Separation found = separationOf(a, resting_);
    found.point = radar::along(found.point, s, drift_);
    return found;
  }

 private:
  // Faces that are pressed together block if all corners sink in, by their speeds over at most a radian.
  Start beforeLeaving() const {
    if (exact::cross(start_, resting_, slack_)) return Start::meet;
    if (separationOf(start_, resting_).distance > slack_ + error_) return Start::open;
    const double angle = turning_.angle();
    for (const Turning::Circle& circle : circle_) {
      const exact::Way way{along(way_, angle, circle.across), 1 / std::max(angle, 1.0), 1};
      if (!exact::arePressed(start_, resting_, way, slack_, mirrored_)) return Start::rest;
    }
    return Start::meet;
  }

  const Turning& turning_;
  const exact::Triangle &start_, &resting_;
  const Vector way_, drift_;
  const exact::Mirrored mirrored_;
  Turning::Circle circle_[3];
  exact::Triangle from_, b_;
};

std::optional<Approach> TurnContact::bracketOf(const exact::PairName&, const exact::PlacedPair& placed) {
  return bracket(Path(*this, placed));
}

}  // namespace radar::cpu
