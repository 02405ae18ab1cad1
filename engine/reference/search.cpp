#include "reference/search.h"

#include <algorithm>
#include <tuple>

#include "reference/may_meet.h"

namespace radar::reference {

namespace {

double size(const LaneBox& box) {
  return box.half[0] + box.half[1] + box.half[2] + box.half[3];
}

}  // namespace

/// Whether a pair of the present object that at best attains t* = 0 comes too late in the order of ids.
bool Search::cannotWin(uint32_t triB, uint32_t triA) const {
  return best_.overlap && std::tie(placed_->id, triB, triA) > std::tie(best_.object, best_.triB, best_.triA);
}

void Search::push(const Waiting& waiting) {
  queue_.push_back(waiting);
  std::push_heap(queue_.begin(), queue_.end());
}

const Best& Search::find(const Query& query, const TreeMesh& sensor) {
  query_ = &query;
  sensor_ = &sensor;
  best_ = {};
  best_.latest = query.distance;
  length_ = exact::length(query.direction);
  queue_.clear();
  if (world_.tree.empty()) return best_;

  const auto& root = sensor.tree.nodes()[0];
  const float middle[3] = {0.5f * root.lo[0] + 0.5f * root.hi[0], 0.5f * root.lo[1] + 0.5f * root.hi[1],
                           0.5f * root.lo[2] + 0.5f * root.hi[2]};
  const View view(place(query.worldFromMesh, middle), query.direction);
  const Turned turnedA(view, query.worldFromMesh, sensor.extent);
  const Turned turnedWorld(view, Pose{}, world_.extent);
  view_ = &view;
  turnedA_ = &turnedA;
  boxA_ = turnedA.box(root);
  leavesA_.bind(sensor, query.worldFromMesh, view);

  if (world_.tree.nodes()[0].count != 0) {
    pushObject(world_.tree.order()[0], 0);
  } else {
    visitNode(0, turnedWorld);
  }
  while (!queue_.empty() && queue_.front().near <= best_.latest && !decided()) {
    const Waiting next = queue_.front();
    std::pop_heap(queue_.begin(), queue_.end());
    queue_.pop_back();
    if (next.object != kNone) {
      visitObject(next);
    } else {
      visitNode(next.index, turnedWorld);
    }
  }
  return best_;
}

void Search::visitNode(uint32_t index, const Turned& turned) {
  const auto& nodes = world_.tree.nodes();
  for (uint32_t child = nodes[index].first; child < nodes[index].first + 2; ++child) {
    const double near = reach(boxA_, turned.box(nodes[child]));
    if (near > best_.latest) continue;
    if (nodes[child].count == 0) {
      push({std::max(near, 0.0), kNone, child, false});
    } else {
      pushObject(world_.tree.order()[nodes[child].first], near);
    }
  }
}

void Search::pushObject(uint32_t index, double near) {
  const World::Placed& placed = world_.objects[index];
  if ((placed.object.mask & query_->mask) == 0) return;
  if (std::find(query_->exclude.begin(), query_->exclude.end(), placed.id) != query_->exclude.end()) return;
  push({std::max(near, 0.0), placed.id, index, false});
}

void Search::visitObject(const Waiting& waiting) {
  const World::Placed& placed = world_.objects[waiting.index];
  placed_ = &placed;
  if (cannotWin(placed.mesh->least[0], 0)) return;
  const Turned turned(*view_, placed.object.worldFromMesh, placed.mesh->extent);
  if (!waiting.bounded) {
    // The turned box is tighter than the world's: where it is no longer the nearest, it waits again.
    const double near = std::max(reach(boxA_, turned.box(placed.mesh->tree.nodes()[0])), waiting.near);
    if (near > best_.latest) return;
    const Waiting again{near, waiting.object, waiting.index, true};
    if (!queue_.empty() && again < queue_.front()) return push(again);
  }
  searchMeshes(placed, turned);
}

void Search::searchMeshes(const World::Placed& placed, const Turned& turned) {
  leavesB_.bind(*placed.mesh, placed.object.worldFromMesh, *view_);
  const LaneBox boxB = turned.box(placed.mesh->tree.nodes()[0]);
  stack_.clear();
  stack_.push_back({0, 0, reach(boxA_, boxB), boxA_, boxB});
  while (!stack_.empty() && !decided()) {
    const Pair pair = stack_.back();
    stack_.pop_back();
    if (pair.near > best_.latest || cannotWin(placed.mesh->least[pair.b], sensor_->least[pair.a])) continue;
    const bool leafA = sensor_->tree.nodes()[pair.a].count != 0;
    const bool leafB = placed.mesh->tree.nodes()[pair.b].count != 0;
    if (leafA && leafB) {
      meetLeaves(leavesA_.leaf(pair.a), leavesB_.leaf(pair.b));
    } else {
      descend(pair, leafB || (!leafA && size(pair.boxA) > size(pair.boxB)), turned);
    }
  }
}

void Search::descend(const Pair& pair, bool intoA, const Turned& turned) {
  Pair children[2] = {pair, pair};
  for (uint32_t side = 0; side < 2; ++side) {
    Pair& child = children[side];
    if (intoA) {
      child.a = sensor_->tree.nodes()[pair.a].first + side;
      child.boxA = turnedA_->box(sensor_->tree.nodes()[child.a]);
    } else {
      child.b = placed_->mesh->tree.nodes()[pair.b].first + side;
      child.boxB = turned.box(placed_->mesh->tree.nodes()[child.b]);
    }
    child.near = reach(child.boxA, child.boxB);
  }
  const int nearer = children[1].near < children[0].near ? 1 : 0;
  if (children[1 - nearer].near <= best_.latest) stack_.push_back(children[1 - nearer]);
  if (children[nearer].near <= best_.latest) stack_.push_back(children[nearer]);
}

void Search::meetLeaves(const PlacedLeaf& a, const PlacedLeaf& b) {
  for (uint32_t i = 0; i < a.count; ++i) {
    for (uint32_t k = 0; k < b.count; ++k) {
      ++pairs_;
      if (mayMeet(a.triangles[i], b.triangles[k], best_.latest) && !cannotWin(b.triangles[k].id, a.triangles[i].id)) {
        const uint64_t before = exact::exactDecisions();
        meet(a.triangles[i], b.triangles[k]);
        exactPairs_ += exact::exactDecisions() != before;
      }
    }
  }
}

void Search::meet(const PlacedTriangle& a, const PlacedTriangle& b) {
  const auto interval = exact::contact(a.world, b.world, query_->direction);
  if (!interval || exact::sign(interval->last) < 0) return;
  const bool overlap = exact::sign(interval->first) <= 0;
  if (!overlap && exact::compareToDistance(interval->first, query_->distance) > 0) return;
  if (best_.found) {
    const int order =
        overlap || best_.overlap ? int(best_.overlap) - int(overlap) : exact::compare(interval->first, best_.event);
    if (order > 0) return;
    if (order == 0 && std::tie(placed_->id, b.id, a.id) > std::tie(best_.object, best_.triB, best_.triA)) return;
  }
  // A distance a little beyond t*: what the parameter, the length and the product may have lost.
  double latest = 0;
  if (!overlap) {
    const bool rough = interval->first.error > 1e-12 * interval->first.s;
    const double s = rough ? exact::parameter(interval->first) : interval->first.s + interval->first.error;
    latest = s * length_ * (1 + 8 * kUnit);
  }
  best_ = {
      true, overlap, placed_->id, b.id, a.id, interval->first, a.world, b.world, std::min(query_->distance, latest)};
}

}  // namespace radar::reference
