#include "cpu/chain_contact.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "math/frame.h"

namespace radar::cpu {

namespace {

// By no more the frame of two links makes lengths longer or shorter than they are in the world, where clearances are.
constexpr double kKept = 2 * ChainMotion::kKeptLengths;

double radiusOf(const exact::Triangle& corners) {
  double most = 0;
  for (const Vector& corner : corners) most = std::max(most, dot(corner, corner));
  // Objects may be as far away as 2^800.
  if (std::isinf(most)) return 2 * std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  return (1 + 0x1p-40) * std::sqrt(most) + 0x1p-500;
}

}  // namespace

void ChainContact::beginLinks(const Mover& a, const Mover& b, double tolerance, double speed) {
  a_ = a;
  b_ = b;
  isObject_ = false;
  drift_ = {};
  setTolerance(tolerance, speed);
}

void ChainContact::beginObject(const Mover& a, const Vector& drift, double tolerance, double speed) {
  a_ = a;
  isObject_ = true;
  drift_ = drift;
  setTolerance(tolerance, speed);
}

const Transform& ChainContact::pose(const LinkWay& way, double s) const {
  const size_t hash = std::hash<double>()(s) ^ std::hash<const void*>()(&way) >> 4;
  Known& known = known_[(hash ^ hash >> 32 ^ hash >> 48) % known_.size()];
  if (known.way != &way || known.s != s) known = {&way, s, motion_.pose(way, s)};
  return known.pose;
}

/// About where b's first corner starts, in the frame in which both move. An object's is the base's, with the world's
/// axes.
class ChainContact::Path final : public PairPath {
 public:
  Path(const ChainContact& contact, const exact::PlacedPair& pair)
      : PairPath(contact.query_.clearance), contact_(contact), motion_(contact.motion_), a_(pair.a), b_(pair.b) {
    const WayBounds ofA = motion_.boundsFor(*contact.a_.way, radiusOf(a_), contact.a_.error);
    WayBounds ofB;
    if (contact.isObject_) {
      const Vector base = motion_.base();
      for (Vector& corner : b_) corner = minus(corner, base);
      ofB.reach = radiusOf(b_) + norm1(contact.drift_);
      ofB.speed = norm1(contact.drift_);
      ofB.error = 4 * kUnit * ofB.reach;
    } else {
      ofB = motion_.boundsFor(*contact.b_.way, radiusOf(b_), contact.b_.error);
    }
    const double most = ofA.reach + 2 * ofB.reach + clearance_;
    speed_ = ofA.speed + ofB.speed;
    bend_ = (ofA.turning + ofB.turning) / 8;
    error_ = ofA.error + 2 * ofB.error + 16 * kUnit * (most + speed_) + clearance_ * kKept;
    setUnit(most);
    about_ = contact.isObject_ ? b_[0] : transform(contact.pose(*contact.b_.way, 0), b_[0]);
  }

  Places at(double s) const override {
    Places out;
    put(contact_.pose(*contact_.a_.way, s), a_, out.a);
    if (contact_.isObject_) {
      for (int i = 0; i < 3; ++i) {
        out.b[i] = scaled(unit_, minus(radar::along(b_[i], s, contact_.drift_), about_));
      }
    } else {
      put(contact_.pose(*contact_.b_.way, s), b_, out.b);
    }
    return out;
  }
  Separation separationAt(double s) const override {
    exact::Triangle a, b;
    const Transform poseA = motion_.pose(*contact_.a_.worldWay, s);
    Transform poseB;
    if (!contact_.isObject_) poseB = motion_.pose(*contact_.b_.worldWay, s);
    for (int i = 0; i < 3; ++i) {
      a[i] = transform(poseA, a_[i]);
      b[i] = radar::along(transform(poseB, b_[i]), s, contact_.drift_);
    }
    Separation found = separationOf(a, b);
    found.point = radar::along(found.point, 1, motion_.base());
    return found;
  }

 private:
  void put(const Transform& pose, const exact::Triangle& from, exact::Triangle& to) const {
    for (int i = 0; i < 3; ++i) to[i] = scaled(unit_, minus(transform(pose, from[i]), about_));
  }

  const ChainContact& contact_;
  const ChainMotion& motion_;
  exact::Triangle a_, b_;
  Vector about_;
};

std::optional<Approach> ChainContact::bracketOf(const exact::PairName&, const exact::PlacedPair& placed) {
  return bracket(Path(*this, placed));
}

}  // namespace radar::cpu
