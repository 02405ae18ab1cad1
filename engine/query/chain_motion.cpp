#include "query/chain_motion.h"

#include <algorithm>
#include <cmath>

#include "math/frame.h"
#include "math/rounding.h"
#include "query/turning.h"

namespace radar {

namespace {

constexpr double kRoom = 1 + 0x1p-40;  // for the roundings of bounds
// By no more a rigid pose makes lengths longer, or shorter: of M^T M - 1 no row adds up to more than 3e-6.
constexpr double kScale = 1 + 0x1p-18;

// By no more a pose makes lengths longer or shorter, as a share of them.
double stretchOf(const Transform& pose) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    double sum = 32 * kUnit;
    for (int k = 0; k < 3; ++k) {
      const double product = pose.m[i] * pose.m[k] + pose.m[4 + i] * pose.m[4 + k] + pose.m[8 + i] * pose.m[8 + k];
      sum += std::abs(product - (i == k ? 1 : 0));
    }
    most = std::max(most, sum);
  }
  return most;
}

// A turn about an axis of length 1. 1 - cos as 2 sin^2, so that tiny angles lose nothing.
Transform turnBy(double angle, const Vector& n) {
  const double side = std::sin(angle), half = std::sin(0.5 * angle), back = 2 * half * half;
  Transform out;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out.m[4 * i + i] = 1 - back * (n[j] * n[j] + n[k] * n[k]);
    out.m[4 * i + j] = back * n[i] * n[j] - side * n[k];
    out.m[4 * i + k] = back * n[i] * n[k] + side * n[j];
  }
  return out;
}

}  // namespace

Transform product(const Transform& outer, const Transform& inner) {
  Transform out;
  for (int i = 0; i < 3; ++i) {
    const double* r = &outer.m[4 * i];
    for (int k = 0; k < 4; ++k) {
      out.m[4 * i + k] = r[0] * inner.m[k] + r[1] * inner.m[4 + k] + r[2] * inner.m[8 + k] + (k == 3 ? r[3] : 0);
    }
  }
  return out;
}

LinkWay LinkWay::between(const Chain& chain, uint32_t root, uint32_t link) {
  LinkWay way{root};
  for (; link != root; link = chain.links[link].parent) way.links.push_back(link);
  std::ranges::reverse(way.links);
  return way;
}

uint32_t commonLink(const Chain& chain, uint32_t a, uint32_t b) {
  // Parents have lower numbers; kNone is above all.
  while (a != b && a != kNone && b != kNone) (a > b ? a : b) = chain.links[std::max(a, b)].parent;
  return a == b ? a : kNone;
}

ChainMotion::ChainMotion(const Chain& chain, const ChainQuery& query)
    : chain_(chain), query_(query), joints_(chain.links.size()), baseStretch_(stretchOf(query.worldFromBase)) {
  for (size_t i = 0; i < joints_.size(); ++i) {
    const Link& link = chain.links[i];
    const Transform& place = link.parentFromJoint;
    joints_[i].stretch = stretchOf(place);
    joints_[i].arm = kRoom * lengthOf({place.m[3], place.m[7], place.m[11]});
    if (link.joint == JointType::fixed) continue;
    joints_[i].axis = unitOf(link.axis);
    joints_[i].from = query.from[link.variable];
    joints_[i].by = query.to[link.variable] - query.from[link.variable];
  }
}

Transform ChainMotion::linkPose(uint32_t link, double s) const {
  const Joint& joint = joints_[link];
  const Transform& place = chain_.links[link].parentFromJoint;
  const double q = joint.from + s * joint.by;
  if (chain_.links[link].joint == JointType::revolute) return product(place, turnBy(q, joint.axis));
  Transform moved;
  for (int k = 0; k < 3; ++k) moved.m[4 * k + 3] = q * joint.axis[k];
  return product(place, moved);
}

Vector ChainMotion::base() const {
  const Transform& base = query_.worldFromBase;
  return {base.m[3], base.m[7], base.m[11]};
}

Transform ChainMotion::pose(const LinkWay& way, double s) const {
  Transform out;
  if (way.root == kNone) {
    out = query_.worldFromBase;
    out.m[3] = out.m[7] = out.m[11] = 0;
  }
  for (const uint32_t link : way.links) out = product(out, linkPose(link, s));
  return out;
}

// From the link inwards. A point u of a joint's outer frame is at y = R(q) u in its inner one: y' = R (u' + q' z x u),
// y'' = R (u'' + 2 q' z x u' + q'^2 z x (z x u)). With u = 2^-53: the angle is off by 3u (|from| + |by|); the axis by
// 6u, the sine by u, so that entries of a turn are off by at most 40u; a product of two poses rounds entries by 3u
// times the entries' sums, at most 9u in all, for points of the outer frame, and lengths by 4u of what they add up to.
WayBounds ChainMotion::boundsFor(const LinkWay& way, double radius, double error) const {
  double r = radius, v = 0, a = 0, e = error, scale = 1;
  const auto place = [&](double arm) {
    r = kScale * r + arm;
    e = kScale * e + 64 * kUnit * r;
    v *= kScale;
    a *= kScale;
    scale *= kScale;
  };
  for (size_t i = way.links.size(); i-- > 0;) {
    const Joint& joint = joints_[way.links[i]];
    const double by = std::abs(joint.by), most = std::max(std::abs(joint.from), std::abs(joint.from + joint.by));
    switch (chain_.links[way.links[i]].joint) {
      case JointType::fixed:
        break;
      case JointType::revolute:
        a += 2 * by * v + by * by * r;
        v += by * r;
        e += kUnit * r * (256 + 4 * (std::abs(joint.from) + by));
        break;
      case JointType::prismatic:
        r += most;
        v += by;
        e += 32 * kUnit * (std::abs(joint.from) + by);
        break;
    }
    place(joint.arm);
  }
  if (way.root == kNone) place(0);
  // Positions are summed outwards, so that each sum rounds as much as the whole way is long.
  e += 16 * kUnit * static_cast<double>(way.links.size() + 1) * r;
  return {kRoom * r, kRoom * v, kRoom * a, kRoom * e + 0x1p-1000, kRoom * scale};
}

SpinBounds ChainMotion::spinOf(const LinkWay& way) const {
  SpinBounds out;
  for (const uint32_t link : way.links) {
    if (chain_.links[link].joint != JointType::revolute) continue;
    // The axis turns with the joints before it.
    out.turning += std::abs(joints_[link].by) * out.speed;
    out.speed += std::abs(joints_[link].by);
  }
  const double scale = std::pow(kScale, 2.0 * static_cast<double>(way.links.size() + 1)) * kRoom;
  return {scale * out.speed, scale * out.turning};
}

bool ChainMotion::keepsLengths(uint32_t link) const {
  double sum = baseStretch_;
  for (; link != kNone; link = chain_.links[link].parent) sum += joints_[link].stretch;
  return sum <= kKeptLengths;
}

}  // namespace radar
