#include "sampled/select.h"

#include <algorithm>
#include <cmath>

namespace radar {

namespace {

// Relative bound on a few dozen rounding errors, with a margin.
constexpr double kRounding = 0x1p-45;

// Tests the world's axes and the prism's as separating axes. Cross products are not tested, since tighter tests of the
// objects follow.
bool meets(const Box& b, const Prism& prism, const Box& prismInWorld, double slack) {
  for (int k = 0; k < 3; ++k) {
    if (b.lo[k] > prismInWorld.hi[k] || b.hi[k] < prismInWorld.lo[k]) return false;
  }
  Vector centre, half;
  double own = slack;
  for (int k = 0; k < 3; ++k) {
    centre[k] = b.middle(k) - prism.origin[k];
    half[k] = 0.5 * (b.hi[k] - b.lo[k]);
    own += kRounding * (std::abs(centre[k]) + half[k]);
  }
  for (int k = 0; k < 3; ++k) {
    const Vector& axis = prism.axes[k];
    const double at = dot(axis, centre), reach = reachAlong(axis, half) + own;
    if (at - reach > prism.box.hi[k] || at + reach < prism.box.lo[k]) return false;
  }
  return true;
}

Box worldBox(const gpu::ObjectNode& node, const Vector& anchor) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = anchor[k] + (double(node.centre[k]) - node.halfExtent[k]);
    box.hi[k] = anchor[k] + (double(node.centre[k]) + node.halfExtent[k]);
  }
  return box;
}

}  // namespace

void selectObjects(const Scene::Impl& scene, const Prism& prism, std::vector<ObjectId>& out) {
  const ObjectTree& tree = scene.objectTree();
  Box world;
  double magnitude = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vector p = prism.origin;
    for (int k = 0; k < 3; ++k) {
      const double at = (corner >> k & 1) != 0 ? prism.box.hi[k] : prism.box.lo[k];
      for (int i = 0; i < 3; ++i) p[i] += prism.axes[k][i] * at;
    }
    world.add(p);
  }
  for (int k = 0; k < 3; ++k) {
    magnitude = std::max({magnitude, std::abs(prism.origin[k]), std::abs(world.lo[k]), std::abs(world.hi[k]),
                          std::abs(tree.anchor()[k])});
  }
  const double slack = kRounding * magnitude;
  for (int k = 0; k < 3; ++k) {
    world.lo[k] -= slack;
    world.hi[k] += slack;
  }
  const auto addIfMet = [&](ObjectId object) {
    if (meets(objectBox(scene, object), prism, world, slack)) out.push_back(object);
  };
  if (!tree.inRange()) {
    for (ObjectId object = 0; object < scene.objects.size(); ++object) {
      if (scene.objects[object].used) addIfMet(object);
    }
  }
  if (tree.nodes().empty()) return;
  thread_local std::vector<uint32_t> open;
  open.assign(1, 0);
  while (!open.empty()) {
    const gpu::ObjectNode& node = tree.nodes()[open.back()];
    open.pop_back();
    if ((node.link & gpu::kLinkLeaf) != 0) {
      addIfMet(node.link & gpu::kLinkItem);
    } else if (meets(worldBox(node, tree.anchor()), prism, world, slack)) {
      open.push_back(node.link);
      open.push_back(node.link + 1);
    }
  }
}

}  // namespace radar
