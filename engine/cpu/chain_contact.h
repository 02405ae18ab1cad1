// Finds when a link of a chain first touches an object or another link, or comes within a clearance.
#pragma once

#include "cpu/path_contact.h"
#include "query/chain_motion.h"

namespace radar::cpu {

class ChainContact final : public PathContact {
 public:
  /// Both outlive this. `query`: what a ChainQuery asks, but for the motion.
  ChainContact(const Query& query, const ChainMotion& motion) : PathContact(query), motion_(motion) {}

  /// A mesh of a link, whose corners are given in the link's frame, and in its own frame are off by at most `error`.
  struct Mover {
    const LinkWay* way;       ///< from the frame in which both move
    const LinkWay* worldWay;  ///< from the base
    double error;
  };
  /// Before the pairs of two links. As of setTolerance().
  void beginLinks(const Mover& a, const Mover& b, double tolerance, double speed);
  /// Before the pairs of a link and an object, whose corners are given in the world and move by `drift`.
  void beginObject(const Mover& a, const Vector& drift, double tolerance, double speed);

 private:
  class Path;
  std::optional<Approach> bracketOf(const exact::PairName& name, const exact::PlacedPair& pair) override;
  /// Of the motion; remembered, since most pairs ask for the ends of the same few times.
  const Transform& pose(const LinkWay& way, double s) const;

  const ChainMotion& motion_;
  Mover a_{}, b_{};
  bool isObject_ = false;
  Vector drift_{};
  struct Known {
    const LinkWay* way = nullptr;
    double s = 0;
    Transform pose;
  };
  mutable std::array<Known, 64> known_;
};

}  // namespace radar::cpu
