#include "math/ring_hull.h"

namespace radar {

namespace {

double across(const Vector& n) {
  return std::sqrt(n[0] * n[0] + n[1] * n[1]);
}

}  // namespace

RingHull::RingHull(std::span<const Ring> rings, double room) : rings_(rings.begin(), rings.end()) {
  double bottom = rings_[0].height - rings_[0].corner, top = rings_[0].height + rings_[0].corner;
  for (Ring& ring : rings_) {
    bottom = std::min(bottom, ring.height - ring.corner);
    top = std::max(top, ring.height + ring.corner);
    ring.corner += room;
    size_ = std::max(size_, std::abs(ring.height) + ring.radius + ring.corner);
  }
  middle_ = 0.5 * bottom + 0.5 * top;
  // Seen along a normal that turns from down over outwards to up, one ring after the other is the farthest.
  const auto sideAlong = [&](double outwards, double up, size_t lower, size_t upper) {
    const Ring& ring = rings_[upper];
    sides_.push_back({outwards, up, outwards * ring.radius + up * ring.height + ring.corner, lower, upper});
  };
  const auto isFarther = [&](double up, const Ring& p, const Ring& q) {
    const double ofP = up * p.height + p.corner, ofQ = up * q.height + q.corner;
    return ofP != ofQ ? ofP > ofQ : p.radius > q.radius;
  };
  size_t now = 0;
  for (size_t i = 1; i < rings_.size(); ++i) {
    if (isFarther(-1, rings_[i], rings_[now])) now = i;
  }
  sideAlong(0, -1, now, now);
  for (size_t turns = 0; turns < rings_.size(); ++turns) {
    const double from = std::atan2(sides_.back().outwards, -sides_.back().up);
    // Of rings in one straight line the last one is next.
    constexpr double kStraight = 1e-12;
    double least = 4, farthest = 0;
    Side next{};
    for (size_t i = 0; i < rings_.size(); ++i) {
      const double outwards = rings_[i].radius - rings_[now].radius, up = rings_[i].height - rings_[now].height;
      const double apart = std::hypot(outwards, up), sine = (rings_[now].corner - rings_[i].corner) / apart;
      if (i == now || !(std::abs(sine) < 1)) continue;  // one is within the other
      const double cosine = std::sqrt((1 - sine) * (1 + sine)), x = outwards / apart, y = up / apart;
      const Side side{y * cosine + x * sine, y * sine - x * cosine, 0, now, i};
      const double turn = std::atan2(side.outwards, -side.up);
      const bool isNext = turn < least - kStraight || (turn < least + kStraight && apart > farthest);
      if (side.outwards <= 0 || turn < from - kStraight || !isNext) continue;
      least = turn;
      farthest = apart;
      next = side;
    }
    if (least == 4) break;
    now = next.upper;
    sideAlong(next.outwards, next.up, next.lower, next.upper);
  }
  sideAlong(0, 1, now, now);
}

double RingHull::support(const Vector& n, size_t ring) const {
  const Ring& of = rings_[ring];
  return of.height * n[2] + of.radius * across(n) + of.corner * std::sqrt(dot(n, n));
}

size_t RingHull::ringAlong(const Vector& n) const {
  const double side = across(n), length = std::sqrt(dot(n, n));
  size_t out = 0;
  double most = rings_[0].height * n[2] + rings_[0].radius * side + rings_[0].corner * length;
  for (size_t i = 1; i < rings_.size(); ++i) {
    const double reach = rings_[i].height * n[2] + rings_[i].radius * side + rings_[i].corner * length;
    if (reach <= most) continue;
    most = reach;
    out = i;
  }
  return out;
}

Vector RingHull::farthest(size_t ring, const Vector& n) const {
  const Ring& of = rings_[ring];
  const double side = across(n), length = std::sqrt(dot(n, n));
  Vector p = scaled(length > 0 ? of.corner / length : 0, n);
  for (int k = 0; k < 2; ++k) p[k] += side > 0 ? of.radius * (n[k] / side) : 0;
  p[2] += of.height;
  return p;
}

RingHull::Foot RingHull::footOf(const Vector& p) const {
  const double out = across(p);
  double distance = -4 * (size_ + out + std::abs(p[2])), outwards = 0, up = 0;
  const auto offer = [&](double apart, double x, double y) {
    if (apart <= distance) return;
    distance = apart;
    outwards = x;
    up = y;
  };
  for (size_t i = 0; i < sides_.size(); ++i) {
    const Side& side = sides_[i];
    offer(side.outwards * out + side.up * p[2] - side.at, side.outwards, side.up);
    if (i + 1 == sides_.size()) break;
    const Ring& ring = rings_[side.upper];
    const Side& next = sides_[i + 1];
    const double x = out - ring.radius, y = p[2] - ring.height;
    if (side.outwards * y - side.up * x < 0 || x * next.up - y * next.outwards < 0) continue;
    const double length = std::sqrt(x * x + y * y);
    if (length > 0) offer(length - ring.corner, x / length, y / length);
  }
  if (!(out > 0)) return {distance, {outwards, 0, up}};
  return {distance, {outwards * (p[0] / out), outwards * (p[1] / out), up}};
}

}  // namespace radar
