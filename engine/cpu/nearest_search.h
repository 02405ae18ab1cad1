// Searches a sensor and objects, past which it moves straight or stands, for the triangles that come nearest to each
// other.
#pragma once

#include <algorithm>
#include <deque>
#include <limits>
#include <vector>

#include "cpu/first_contact.h"
#include "cpu/mesh_search.h"
#include "cpu/node_gap.h"

namespace radar::cpu {

/// What such a search serves.
class NearVisitor {
 public:
  NearVisitor(const NearVisitor&) = delete;
  NearVisitor& operator=(const NearVisitor&) = delete;

  /// `motion`: past the object, whose pairs are judged by `rule`.
  virtual void consider(const exact::PairName& name, const exact::PlacedPair& pair, const Translation& motion,
                        const PairRule& rule) = 0;
  /// Whether neither `least` nor a pair after it matters.
  virtual bool isBefore(const exact::PairName& least) const = 0;
  /// Pairs that come no nearer than this, world units, need not be considered.
  double reach() const { return reach_; }
  /// Pairs are left out that come no nearer than `least`, which is above the reach.
  void skip(double least) { skipped_ = std::min(skipped_, least); }
  /// Across the gap of the nearest pair so far, or 0.
  const Vector& across() const { return across_; }
  /// Whether so many pairs have been considered that those may be skipped, too, that are nearer than the reach by no
  /// more than placing a mesh rounds.
  virtual bool leavesTies() const { return false; }

 protected:
  explicit NearVisitor(double reach) : reach_(reach) {}
  ~NearVisitor() = default;

  double reach_, skipped_ = std::numeric_limits<double>::infinity();
  Vector across_{};
};

/// Reuses its memory between searches. For one thread at a time.
class NearestSearch {
 public:
  /// All outlive the search. `stop`: as of MeshSearch.
  void begin(const PlacedMesh& sensor, NearVisitor& visitor, const std::stop_token& stop);
  /// An object that is to be searched. Pairs with the lead do not matter. `way`: of the motion, or a part of it.
  void add(ObjectId object, const Mesh& mesh, const Transform& pose, const Translation& motion, const Piece& way,
           const PairRule& rule, const Lead& lead);
  /// Passes to the visitor all pairs of triangles that may matter, nearest first in the main, of nodes that may come as
  /// near as `until`; adds them to `pairs`.
  void advance(double until, uint64_t& pairs);

 private:
  struct Other {
    ObjectId object;
    const Mesh& mesh;
    const Transform& pose;
    MeshPlacement placement;
    Translation motion;
    Piece way;
    PairRule rule;
    PairMotion pair;
    NodeGap gap;
    GapTest lead;
    double rounding;  ///< world units: of a bound on the gap of nodes, at most
    Other(ObjectId id, const Mesh& m, const Transform& p, const MeshPlacement& sensor, const Translation& t,
          const Piece& w, const PairRule& r);
  };
  struct Open {
    double least;  ///< bound on the distance
    uint32_t other, a, b;
    Vector across;  ///< what gives it
  };
  Open openOf(uint32_t other, uint32_t a, uint32_t b, const Vector& across) const;
  /// If not, it is skipped.
  bool matters(const Open& open) const;
  void push(const Open& open);
  void descend(Open open, uint64_t& pairs);

  const PlacedMesh* sensor_ = nullptr;
  NearVisitor* visitor_ = nullptr;
  const std::stop_token* stop_ = nullptr;
  std::deque<Other> others_;  // stay in place
  std::vector<Open> open_;    // a heap
  uint32_t visits_ = 0;
};

}  // namespace radar::cpu
