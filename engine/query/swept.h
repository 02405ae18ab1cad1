// The objects that a query's sensor may meet on its way: one walk of the tree over objects for all ways of answering.
#pragma once

#include <algorithm>
#include <vector>

#include "query/course.h"
#include "query/swept_box.h"
#include "scene/scene.h"

namespace radar {

/// The objects that share a mask bit with a query, which does not exclude them. On a thread there is one at a time.
class Participants {
 public:
  /// Both outlive this. The excluded objects exist.
  Participants(const Query& query, const Scene::Impl& scene);
  ~Participants();
  Participants(const Participants&) = delete;
  Participants& operator=(const Participants&) = delete;

  bool contain(ObjectId id) const {
    return (scene_.objects[id].object.mask & query_.mask) != 0 && !(marks_ != nullptr ? (*marks_)[id] : isListed(id));
  }
  const Scene::Impl& scene() const { return scene_; }

 private:
  bool isListed(ObjectId id) const {
    return std::find(query_.exclude.begin(), query_.exclude.end(), id) != query_.exclude.end();
  }

  const Query& query_;
  const Scene::Impl& scene_;
  std::vector<bool>* marks_ = nullptr;  // by object: of this thread, so that a list costs no more than its length
};

/// A box around the sensor of a valid query at the start, with room for its clearance and slack.
Box roomyBox(const Query& query, const Scene::Impl& scene);

/// In ascending order, the objects that take part and whose boxes `start` may meet on the query's way.
std::vector<ObjectId> inReach(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, const Box& start);

namespace detail {

struct OpenNode {
  double near;
  uint32_t link;
};
/// Memory of this thread for the nodes that a walk has yet to visit.
OpenNode* openNodes(size_t count);

/// Prefetches the child nodes or the object of a node, because a scene's tree and objects do not fit a cache.
inline void prefetch(const gpu::ObjectNode& node, const gpu::ObjectNode* nodes, const Scene::Impl& scene) {
  const uint32_t item = node.link & gpu::kLinkItem;
  const void* next = nodes + item;
  if ((node.link & gpu::kLinkLeaf) != 0) next = &scene.objects[item];
  // An object is in up to three lines; and so are nodes that come soon after.
  for (const int line : {0, 64, 128}) __builtin_prefetch(static_cast<const char*>(next) + line);
}

}  // namespace detail

/// Calls `visit` with each participant that the box `start` may meet on a piece of its way, nearest first; with all of
/// them, in ascending order, if the tree is out of range. `reach`: double(): objects that are met later than after so
/// many world units do not matter any more; negative: none does. Only `visit` changes it. `visit` must not walk itself.
template <class Reach, class Visit>
void walk(const Participants& participants, const ObjectTree& tree, const Piece& piece, const Box& start,
          const Reach& reach, const Visit& visit) {
  const Scene::Impl& scene = participants.scene();
  if (!tree.inRange()) {
    for (ObjectId id = 0; id < scene.objects.size(); ++id) {
      if (scene.objects[id].used && reach() >= 0 && participants.contain(id)) visit(id);
    }
    return;
  }
  if (tree.nodes().empty()) return;
  const gpu::ObjectNode* const nodes = tree.nodes().data();
  const SweptBox meets(start, piece, tree);
  detail::OpenNode* const bottom = detail::openNodes(size_t{tree.depth()} + 2);
  detail::OpenNode* top = bottom;
  double latest = reach();
  const auto push = [&](double near, const gpu::ObjectNode& node) {
    *top = {near, node.link};
    top += near <= latest;
  };
  push(meets(nodes[0], nodes[0])[0], nodes[0]);
  while (top != bottom) {
    const detail::OpenNode next = *--top;
    if (next.near > latest) continue;
    if ((next.link & gpu::kLinkLeaf) != 0) {
      const ObjectId id = next.link & gpu::kLinkItem;
      if (!participants.contain(id)) continue;
      visit(id);
      latest = reach();
      continue;
    }
    const gpu::ObjectNode &left = nodes[next.link], &right = nodes[next.link + 1];
    detail::prefetch(left, nodes, scene);
    detail::prefetch(right, nodes, scene);
    const TwoDoubles near = meets(left, right);
    const bool leftFirst = near[0] <= near[1];
    push(leftFirst ? near[1] : near[0], leftFirst ? right : left);
    push(leftFirst ? near[0] : near[1], leftFirst ? left : right);
  }
}

}  // namespace radar
