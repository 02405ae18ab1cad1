#include "query/swept.h"

#include <algorithm>

namespace radar {

Participants::Participants(const Query& query, const Scene::Impl& scene) : query_(query), scene_(scene) {
  if (areFew(query)) return;
  thread_local std::vector<bool> marks;
  if (marks.size() < scene.objects.size()) marks.resize(scene.objects.size());
  for (const ObjectId id : query.exclude) marks[id] = true;
  marks_ = &marks;
}

Participants::~Participants() {
  if (marks_ == nullptr) return;
  for (const ObjectId id : query_.exclude) (*marks_)[id] = false;
}

namespace detail {

std::vector<OpenNode>& openNodes() {
  thread_local std::vector<OpenNode> nodes;
  return nodes;
}

}  // namespace detail

Box roomyBox(const Query& query, const Scene::Impl& scene) {
  Box box = boxOf(scene.meshes[query.mesh], query.worldFromMesh.m);
  // Boxes have room for the default slack.
  const double room = std::max(query.clearance, 2 * query.slack.value_or(0));
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= room;
    box.hi[k] += room;
  }
  return box;
}

std::vector<ObjectId> inReach(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, const Box& start) {
  const Translation motion = Course(query, scene).past();
  std::vector<ObjectId> found;
  walk(
      Participants(query, scene), tree, motion, start, [&] { return motion.wayUntil(motion.end); },
      [&](ObjectId id) { found.push_back(id); });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace radar
