// A chain between two configurations: where its links are, and how fast their points move and leave straight ways, at
// most.
#pragma once

#include <vector>

#include "math/vector.h"
#include "radar/chain.h"

namespace radar {

/// Places by `inner`, then by `outer`.
Transform product(const Transform& outer, const Transform& inner);

/// The joints from a frame out to a link's. `root`: a link, or kNone: the base, placed in the world but for its
/// position, which the frame's origin is.
struct LinkWay {
  uint32_t root = kNone;
  std::vector<uint32_t> links{};  ///< whose joints lie between, outwards

  static LinkWay between(const Chain& chain, uint32_t root, uint32_t link);
};
/// The last link that both are or hang from; kNone: the base.
uint32_t commonLink(const Chain& chain, uint32_t a, uint32_t b);

/// Of a point of a link, relative to a frame, for s from 0 to 1.
struct WayBounds {
  double reach = 0;  ///< distance from the frame's origin
  double speed = 0;
  double turning = 0;  ///< second derivative: off a straight way it gets by no more than an eighth of it
  double error = 0;    ///< of a computed place: of each component
  double scale = 1;    ///< by no more the way makes lengths longer, or shorter, since what is rigid is so to 1e-6
};
/// Of the frame of a link, relative to another one.
struct SpinBounds {
  double speed = 0;    ///< radians per s
  double turning = 0;  ///< of the vector of angular velocity: its derivative
};

class ChainMotion {
 public:
  /// A valid query's; both stay in place.
  ChainMotion(const Chain& chain, const ChainQuery& query);

  /// Of the link's frame in the way's. In the base's, lengths are about its position, `base()`.
  Transform pose(const LinkWay& way, double s) const;
  Vector base() const;
  /// `radius`, `error`: of the point in the link's frame: its distance from the origin, and what it is off by.
  WayBounds boundsFor(const LinkWay& way, double radius, double error) const;
  SpinBounds spinOf(const LinkWay& way) const;
  /// Whether the link's frame certainly makes lengths neither longer nor shorter than they are in the world, but for
  /// kKeptLengths of them: what is rigid to 1e-6 may do so.
  bool keepsLengths(uint32_t link) const;
  static constexpr double kKeptLengths = 0x1p-40;

 private:
  struct Joint {
    Vector axis{};            // of length 1, off by at most 6u
    double from = 0, by = 0;  // q = from + s by
    double stretch = 0;       // what keepsLengths() adds up, of the joint's place in its parent
    double arm = 0;           // how far it is from its parent's origin
  };
  Transform linkPose(uint32_t link, double s) const;

  const Chain& chain_;
  const ChainQuery& query_;
  std::vector<Joint> joints_;  // by link
  double baseStretch_;
};

}  // namespace radar
