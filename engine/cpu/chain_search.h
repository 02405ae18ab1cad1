// Answers one query about a chain on one thread: each link's way in parts past the tree over objects, nearest first,
// and past other links.
#pragma once

#include <vector>

#include "cpu/chain_contact.h"
#include "cpu/mesh_search.h"

namespace radar::cpu {

/// The meshes of a chain's links, and those to test with each other.
struct ChainPlan {
  struct Body {
    uint32_t link, number;  ///< of the mesh among the link's
    const Mesh* mesh;
    Transform pose;  ///< in the link's frame
    MeshPlacement placement;
    Box box;        ///< there
    Vector middle;  ///< of the box
    double half;    ///< no point is farther from the middle
    double radius;  ///< nor from the link's origin
    double error;   ///< world units: of a vertex' place in the link's frame
    double least;   ///< world units: how far points may bend away from straight ways in a part
    LinkWay way;    ///< from the base
  };
  struct Pair {
    size_t a, b;         ///< bodies
    LinkWay wayA, wayB;  ///< from the last link that both hang from
  };
  std::vector<Body> bodies;  ///< outermost links first: they usually touch first
  std::vector<Pair> pairs;

  /// Of a valid chain. The scene stays as it is.
  ChainPlan(const Chain& chain, const Scene::Impl& scene);
};

/// Reuses its memory between queries. For one thread at a time; those of several threads share no cache line.
class alignas(kThreadLines) ChainSearch {
 public:
  /// Answers a valid query. Throws Cancelled soon after `stop` is requested.
  ChainResult answer(const ChainQuery& query, const Chain& chain, const ChainPlan& plan, const Scene::Impl& scene,
                     const std::stop_token& stop);

 private:
  struct Task;
  /// A body in motion, relative to a frame.
  struct Moving;
  class Ahead;

  void searchObjects(const Task& task, const ChainPlan& plan, ChainContact& finder);
  void searchObject(const Task& task, const Moving& moving, const PathPart& part, ObjectId id, ChainContact& finder);
  void searchPair(const Task& task, const ChainPlan::Pair& pair, ChainContact& finder);

  /// Who a pair is of: the object of its name is an index here.
  struct Who {
    const ChainPlan::Body* body;
    ObjectId object;
    const ChainPlan::Body* other;  ///< null: the object
  };
  std::vector<Who> who_;
  MeshSearch meshes_;
  uint64_t pairs_ = 0;
};

}  // namespace radar::cpu
