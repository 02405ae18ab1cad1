// The objects that a query's sensor may meet on its way: one walk of the tree over objects for all ways of answering.
#pragma once

#include <algorithm>
#include <vector>

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

 private:
  bool isListed(ObjectId id) const {
    return std::find(query_.exclude.begin(), query_.exclude.end(), id) != query_.exclude.end();
  }

  const Query& query_;
  const Scene::Impl& scene_;
  std::vector<bool>* marks_ = nullptr;  // by object: of this thread, so that a list costs no more than its length
};

/// The sensor's motion past an object in a step, or past all objects in a sweep.
Motion motionPast(const Query& query, const Scene::Impl& scene, ObjectId object = kNone);

/// In ascending order, the objects that take part and whose boxes the sensor may meet on its way. `start`: see `walk`.
std::vector<ObjectId> inReach(const Query& query, const Scene::Impl& scene, const ObjectTree& tree,
                              const Box* start = nullptr);

namespace detail {

struct OpenNode {
  double near;
  uint32_t link;
};
/// Memory of this thread for the nodes that a walk has yet to visit.
OpenNode* openNodes(size_t count);
/// Where the sensor is at the start, with room for its clearance and slack.
Box roomyBox(const Query& query, const Scene::Impl& scene);

/// Prefetches the child nodes or the object of a node, because a scene's tree and objects do not fit a cache.
inline void prefetch(const gpu::ObjectNode& node, const gpu::ObjectNode* nodes, const Scene::Impl& scene) {
  const uint32_t item = node.link & gpu::kLinkItem;
  const void* next = nodes + item;
  if ((node.link & gpu::kLinkLeaf) != 0) next = &scene.objects[item];
  __builtin_prefetch(next);
  __builtin_prefetch(static_cast<const char*>(next) + 64);
}

}  // namespace detail

/// Calls `visit` with each object that takes part in a valid query and is in reach of its sensor, nearest first; all
/// that take part, in ascending order, if the tree is out of range. `motion`: the sensor's. `wants`: bool(double near):
/// whether objects still matter that are met after the sensor has moved by `near` world units, at the earliest. `visit`
/// must not walk itself. `start`: the box that moves; null: the sensor's, with room for its clearance and slack.
template <class Wants, class Visit>
void walk(const Query& query, const Motion& motion, const Scene::Impl& scene, const ObjectTree& tree,
          const Wants& wants, const Visit& visit, const Box* start = nullptr) {
  const Participants participants(query, scene);
  if (!tree.inRange()) {
    for (ObjectId id = 0; id < scene.objects.size(); ++id) {
      if (scene.objects[id].used && wants(0.0) && participants.contain(id)) visit(id);
    }
    return;
  }
  if (tree.nodes().empty()) return;
  const gpu::ObjectNode* const nodes = tree.nodes().data();
  const SweptBox meets(start != nullptr ? *start : detail::roomyBox(query, scene), motion, tree);
  detail::OpenNode* const bottom = detail::openNodes(size_t{tree.depth()} + 2);
  detail::OpenNode* top = bottom;
  const auto push = [&](double near, const gpu::ObjectNode& node) {
    *top = {near, node.link};
    top += wants(near);
  };
  push(meets(nodes[0], nodes[0])[0], nodes[0]);
  while (top != bottom) {
    const detail::OpenNode next = *--top;
    if (!wants(next.near)) continue;
    if ((next.link & gpu::kLinkLeaf) != 0) {
      const ObjectId id = next.link & gpu::kLinkItem;
      if (participants.contain(id)) visit(id);
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
