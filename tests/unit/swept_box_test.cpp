// A moving box meets the boxes that it touches, however narrowly, and no later than it does.
#include "query/swept_box.h"

#include <cmath>

#include "exact/dyadic.h"
#include "scene/scene.h"
#include "support/catch.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using exact::Dyadic;
using tools::Random;

/// The double nearest to `value` that is at least (`up`) or at most `exact`.
double towards(const Dyadic& exact, double value, bool up) {
  const auto holds = [&](double x) { return up ? (Dyadic(x) - exact).sign() >= 0 : (exact - Dyadic(x)).sign() >= 0; };
  while (!holds(value)) value = std::nextafter(value, up ? INFINITY : -INFINITY);
  for (double next = value; holds(next); next = std::nextafter(next, up ? -INFINITY : INFINITY)) value = next;
  return value;
}

/// Checks a random motion towards a random node of the tree.
void checkTouch(const ObjectTree& tree, Random& random) {
  const gpu::ObjectNode& node = tree.nodes()[random.below(static_cast<uint32_t>(tree.nodes().size()))];
  const Vector way = random.inCube(random.magnitude(-3, 4));
  const double when = std::ldexp(random.below(1u << 20), -20);  // of the step
  const uint32_t first = random.below(3), second = (first + 1 + random.below(2)) % 3;
  Box box;
  for (uint32_t k = 0; k < 3; ++k) {
    const double size = random.magnitude(-3, 2), about = tree.anchor()[k] + node.centre[k] - when * way[k];
    box.lo[k] = about - size - node.halfExtent[k];
    box.hi[k] = about + size + node.halfExtent[k];
    if (k != first && k != second) continue;
    // The side of the node's box that is touched at that time: along one axis the near one, along the other the far
    // one.
    const bool atLow = (way[k] > 0) == (k == first);
    const Dyadic middle = Dyadic(tree.anchor()[k]) + Dyadic(node.centre[k]), half(node.halfExtent[k]);
    const Dyadic side = (atLow ? middle - half : middle + half) - Dyadic(when) * Dyadic(way[k]);
    const double nearest = towards(side, about + (atLow ? -1 : 1) * node.halfExtent[k], atLow);
    box.lo[k] = atLow ? nearest - size : nearest;
    box.hi[k] = atLow ? nearest : nearest + size;
  }
  const Translation motion(way, {});
  const TwoDoubles met = SweptBox(box, motion, tree)(node, node);
  CAPTURE(when, met[0], motion.wayUntil(when));
  REQUIRE(met[0] == met[1]);
  REQUIRE(met[0] <= motion.wayUntil(when));
}

}  // namespace

TEST_CASE("a moving box that reaches a node's along one axis as it leaves it along another meets it") {
  Random random(1);
  const tools::MeshData shape = tools::makeBox({1, 2, 3});
  for (int trees = 0; trees < 100; ++trees) {
    Scene scene;
    const MeshId mesh = scene.addMesh(shape.positions, shape.indices);
    const double away = random.oneIn(2) ? 0 : random.magnitude(0, 9), reach = random.magnitude(-3, 6);
    for (int i = 0; i < 4; ++i) {
      const auto stretch = random.inBox({0.1, 0.1, 0.1}, {1, 1, 1});
      const auto at = random.inBox({away, -reach, -reach}, {away + reach, reach, reach});
      scene.addObject({.mesh = mesh, .worldFromMesh = tools::makePose(random.rotation(), stretch, at)});
    }
    for (int k = 0; k < 1000; ++k) checkTouch(scene.impl().objectTree(), random);
  }
}
