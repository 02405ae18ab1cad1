// One query: nearest-first search of the objects, then of the triangles of each object in reach.
#pragma once

#include <vector>

#include "reference/placed.h"

namespace radar::reference {

/// What the searches read: objects that exist, and a tree over their boxes in the world.
struct World {
  struct Placed {
    ObjectId id;
    const TreeMesh* mesh;
    Object object;
  };
  std::vector<Placed> objects;
  Tree<double> tree;
  Vec extent{};
};

/// The least pair found so far.
struct Best {
  bool found = false;
  bool overlap = false;  ///< t* = 0
  ObjectId object = kNone;
  uint32_t triB = kNone, triA = kNone;
  exact::Event event{};      ///< where the pair's interval begins
  exact::Triangle a{}, b{};  ///< the pair
  double latest = kNever;    ///< upper bound on t*
};

class Search {
 public:
  explicit Search(const World& world) : world_(world) {}
  /// The query holds its contract. The result is valid until the next call.
  const Best& find(const Query& query, const TreeMesh& sensor);
  /// |direction| of the last query.
  double length() const { return length_; }
  /// Since construction: pairs of triangles that reached a box test, and those that needed exact integers.
  uint64_t pairs() const { return pairs_; }
  uint64_t exactPairs() const { return exactPairs_; }

 private:
  /// A node of the world's tree or an object, in the order in which they are looked at.
  struct Waiting {
    double near;
    ObjectId object;  ///< kNone: a node
    uint32_t index;
    bool bounded;  ///< an object whose own box has been seen, not only the world's
    /// Nearest first; among those that may touch at the start nodes first, then objects by id, so that the least wins
    /// soon.
    bool operator<(const Waiting& other) const {
      return near != other.near ? near > other.near : object + 1 > other.object + 1;
    }
  };
  struct Pair {
    uint32_t a, b;
    double near;
    LaneBox boxA, boxB;
  };

  void visitNode(uint32_t index, const Turned& turned);
  void pushObject(uint32_t index, double near);
  void visitObject(const Waiting& waiting);
  void searchMeshes(const World::Placed& placed, const Turned& turned);
  void descend(const Pair& pair, bool intoA, const Turned& turned);
  void meetLeaves(const PlacedLeaf& a, const PlacedLeaf& b);
  void meet(const PlacedTriangle& a, const PlacedTriangle& b);
  /// Only "within D or not" is asked, and something is.
  bool decided() const { return query_->decide && best_.found; }
  bool cannotWin(uint32_t triB, uint32_t triA) const;
  void push(const Waiting& waiting);

  const World& world_;
  const Query* query_ = nullptr;
  const TreeMesh* sensor_ = nullptr;
  std::vector<Waiting> queue_;
  std::vector<Pair> stack_;
  LeafCache leavesA_, leavesB_;
  const World::Placed* placed_ = nullptr;
  const View* view_ = nullptr;
  const Turned* turnedA_ = nullptr;
  LaneBox boxA_;
  double length_ = 0;  // of the direction
  Best best_;
  uint64_t pairs_ = 0, exactPairs_ = 0;
};

}  // namespace radar::reference
