// The objects that a query's sensor may meet on its way: one walk of the tree over objects for all ways of answering.
#pragma once

#include <algorithm>
#include <vector>

#include "query/course.h"
#include "query/swept_box.h"
#include "scene/scene.h"

namespace radar {

/// The objects that share a mask bit with a query, which does not exclude them. On a thread there is one at a time that
/// excludes more than a few.
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
  /// Whether the excluded objects are few, so that there may be several on a thread.
  static bool areFew(const Query& query) { return query.exclude.size() <= kFew; }

 private:
  // Longer lists are marked, shorter ones are looked through.
  static constexpr size_t kFew = 16;

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
std::vector<OpenNode>& openNodes();

/// Prefetches what is read first when the node is next: its child nodes, or the mask of its object. Nothing could
/// foresee a branch between the two.
inline void prefetch(const gpu::ObjectNode& node, const gpu::ObjectNode* nodes, const Scene::Impl& scene) {
  const uintptr_t item = node.link & gpu::kLinkItem, isLeaf = uintptr_t{0} - ((node.link & gpu::kLinkLeaf) != 0);
  const uintptr_t inner = reinterpret_cast<uintptr_t>(nodes) + item * sizeof(*nodes),
                  leaf = reinterpret_cast<uintptr_t>(&scene.objects.data()->object.mask) +
                         item * sizeof(Scene::Impl::ObjectSlot);
  __builtin_prefetch(reinterpret_cast<const void*>(inner ^ ((inner ^ leaf) & isLeaf)));
}
/// Prefetches the lines beside that of the mask.
inline void prefetch(const Scene::Impl::ObjectSlot& object) {
  const char* const mask = reinterpret_cast<const char*>(&object.object.mask);
  for (const int line : {-64, 64}) __builtin_prefetch(mask + line);
}

}  // namespace detail

/// A walk over the objects of a tree that a moving box may meet, nearest first, step by step: walks that take turns
/// wait for memory at the same time.
class Walk {
 public:
  /// `tree` must be in range. `memory`: of this walk alone. Both and the scene outlive this.
  Walk(const Scene::Impl& scene, const ObjectTree& tree, const Piece& piece, const Box& start, double reach,
       std::vector<detail::OpenNode>& memory)
      : scene_(scene), nodes_(tree.nodes().data()), meets_(start, piece, tree) {
    const size_t most = size_t{tree.depth()} + 2;
    if (memory.size() < most) memory.resize(most);
    bottom_ = top_ = memory.data();
    if (!tree.nodes().empty()) push(meets_(nodes_[0], nodes_[0])[0], nodes_[0].link, reach);
  }

  bool isOver() const { return top_ == bottom_; }
  /// Goes on until an object is reached that is met within `reach`, world units, and returns that; or until nodes are
  /// to be read that were just asked for, or it is over, and returns kNone.
  ObjectId step(double reach) {
    while (!isOver()) {
      const detail::OpenNode next = *--top_;
      if (next.near > reach) continue;
      if ((next.link & gpu::kLinkLeaf) != 0) {
        const ObjectId object = next.link & gpu::kLinkItem;
        detail::prefetch(scene_.objects[object]);
        return object;
      }
      const gpu::ObjectNode &left = nodes_[next.link], &right = nodes_[next.link + 1];
      detail::prefetch(left, nodes_, scene_);
      detail::prefetch(right, nodes_, scene_);
      const TwoDoubles near = meets_(left, right);
      // Without a branch, likewise.
      const uint32_t swapped = (left.link ^ right.link) & (0 - uint32_t{near[0] > near[1]});
      push(std::max(near[0], near[1]), right.link ^ swapped, reach);
      push(std::min(near[0], near[1]), left.link ^ swapped, reach);
      break;
    }
    return kNone;
  }

 private:
  void push(double near, uint32_t link, double reach) {
    *top_ = {near, link};
    top_ += near <= reach;
  }

  const Scene::Impl& scene_;
  const gpu::ObjectNode* nodes_;
  SweptBox meets_;
  detail::OpenNode *bottom_, *top_;
};

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
  double latest = reach();
  Walk walk(scene, tree, piece, start, latest, detail::openNodes());
  while (!walk.isOver()) {
    const ObjectId id = walk.step(latest);
    if (id == kNone || !participants.contain(id)) continue;
    visit(id);
    latest = reach();
  }
}

}  // namespace radar
