// The tree over a scene's objects contains all of them, wherever they are and however the scene has changed.
#include <algorithm>
#include <cmath>

#include "exact/dyadic.h"
#include "scene/scene.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using exact::Dyadic;
using test::at;
using tools::Random;

// Whether the node contains p, in exact arithmetic.
bool holds(const gpu::ObjectNode& node, const std::array<double, 3>& anchor, const std::array<double, 3>& p) {
  for (int k = 0; k < 3; ++k) {
    const Dyadic offset = Dyadic(p[k]) - Dyadic(anchor[k]) - Dyadic(node.centre[k]), half(node.halfExtent[k]);
    if ((half - offset).sign() < 0 || (half + offset).sign() < 0) return false;
  }
  return true;
}

struct WalkResult {
  std::vector<uint32_t> leaves;  // the number of leaves of each object
  uint32_t depth = 0;
  size_t nodes = 0;
};

// Checks the nodes below and returns their objects.
std::vector<ObjectId> walk(const Scene::Impl& scene, const ObjectTree& tree, uint32_t at, uint32_t level,
                           WalkResult& walked) {
  const gpu::ObjectNode& node = tree.nodes().at(at);
  ++walked.nodes;
  walked.depth = std::max(walked.depth, level);
  std::vector<ObjectId> below;
  if ((node.link & gpu::kLinkLeaf) != 0) {
    below.push_back(node.link & gpu::kLinkItem);
    ++walked.leaves.at(below[0]);
  } else {
    if (node.link <= at) FAIL("the children of node " << at << " stand before it");
    below = walk(scene, tree, node.link, level + 1, walked);
    for (const ObjectId id : walk(scene, tree, node.link + 1, level + 1, walked)) below.push_back(id);
  }
  for (const ObjectId id : below) {
    const Box box = objectBox(scene, id);
    if (!holds(node, tree.anchor(), box.lo) || !holds(node, tree.anchor(), box.hi)) {
      FAIL("node " << at << " does not hold object " << id);
    }
  }
  return below;
}

// Checks that each object of the scene is in one leaf, in a box that contains its placed vertices.
void checkTree(const Scene& scene) {
  const ObjectTree& tree = scene.impl().objectTree();
  WalkResult walked{std::vector<uint32_t>(scene.objectLimit())};
  if (!tree.nodes().empty()) walk(scene.impl(), tree, 0, 1, walked);
  CHECK(walked.depth <= tree.depth());
  CHECK(walked.nodes <= tree.nodes().size());
  CHECK(tree.inRange());
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    CAPTURE(id);
    CHECK(walked.leaves[id] == (scene.hasObject(id) ? 1 : 0));
    if (!scene.hasObject(id)) continue;
    const Object& object = scene.object(id);
    const MeshView mesh = scene.mesh(object.mesh);
    const Box box = objectBox(scene.impl(), id);
    const Box& world = tree.worldBox();
    for (const uint32_t vertex : mesh.indices) {
      const std::array<double, 3> p = transformPoint(object.worldFromMesh, &mesh.positions[3 * size_t{vertex}]);
      for (int k = 0; k < 3; ++k) {
        if (p[k] < box.lo[k] || p[k] > box.hi[k]) FAIL("the box of object " << id << " leaves out a vertex");
        if (p[k] < world.lo[k] || p[k] > world.hi[k]) FAIL("the world's box leaves out a vertex of object " << id);
      }
    }
  }
}

// The sum of the nodes' surface areas, up to a factor, which measures the cost of walking the tree.
double costOf(const ObjectTree& tree) {
  double sum = 0;
  for (const gpu::ObjectNode& node : tree.nodes()) {
    const double x = node.halfExtent[0], y = node.halfExtent[1], z = node.halfExtent[2];
    sum += x * y + y * z + z * x;
  }
  return sum;
}

// Boxes of random poses, within `reach` of a place that is `away` from the origin.
class Boxes {
 public:
  explicit Boxes(uint64_t seed) : random(seed), mesh(test::add(scene, tools::makeBox({1, 2, 3}))) {}

  Transform anywhere(double reach, double away = 0) {
    const tools::Vec3 place = random.inBox({away - reach, away - reach, -reach}, {away + reach, away + reach, reach});
    return tools::makePose(random.rotation(), {0.3, 0.5, 1.0}, place);
  }
  void add(size_t count, double reach, double away = 0) {
    while (count-- > 0) objects.push_back(scene.addObject({mesh, anywhere(reach, away)}));
  }
  void moveAny(double reach, double away = 0) { scene.setTransform(objects[any()], anywhere(reach, away)); }
  void removeAny() {
    const size_t which = any();
    scene.removeObject(objects[which]);
    objects.erase(objects.begin() + static_cast<ptrdiff_t>(which));
  }
  void edit(uint32_t kind, double reach) {
    if (kind == 0) add(1, reach);
    if (kind == 1) moveAny(reach);
    if (kind == 2) removeAny();
  }
  const ObjectTree& tree() const { return scene.impl().objectTree(); }

  Random random;
  Scene scene;
  MeshId mesh;
  std::vector<ObjectId> objects;

 private:
  size_t any() { return random.below(static_cast<uint32_t>(objects.size())); }
};

}  // namespace

TEST_CASE("the tree contains all objects while they are added, moved and removed") {
  Boxes boxes(3);
  const double away = GENERATE(0.0, 1e6, 1e12);
  CHECK(boxes.tree().nodes().empty());
  for (int round = 0; round < 40; ++round) {
    if (round % 4 == 0) boxes.add(10, 20, away);
    for (int i = 0; i < 5; ++i) boxes.moveAny(20, away);
    for (int i = 0; i < 4 && round % 8 == 7; ++i) boxes.removeAny();
    checkTree(boxes.scene);
  }
  while (!boxes.objects.empty()) boxes.removeAny();
  checkTree(boxes.scene);
  CHECK(boxes.tree().nodes().empty());
  boxes.add(1, 20, away);
  checkTree(boxes.scene);
  CHECK(boxes.tree().nodes().size() == 1);
}

TEST_CASE("a small move changes the boxes and the version but not the structure of the tree") {
  Boxes boxes(4);
  boxes.add(100, 50);
  const ObjectTree& tree = boxes.tree();
  const NodeVector<gpu::ObjectNode> before = tree.nodes();
  uint64_t version = tree.version();
  CHECK(boxes.tree().version() == version);
  Transform pose = boxes.scene.object(7).worldFromMesh;
  pose.m[3] += 0.25;
  boxes.scene.setTransform(7, pose);
  checkTree(boxes.scene);
  CHECK(tree.version() > version);
  REQUIRE(tree.nodes().size() == before.size());
  for (size_t i = 0; i < before.size(); ++i) CHECK(tree.nodes()[i].link == before[i].link);
}

TEST_CASE("the tree contains the bounds of objects that a host may move") {
  Boxes boxes(5);
  boxes.add(20, 20);
  const Bounds bounds{{-70, -3, -3}, {-60, 3, 90}};
  boxes.scene.setBounds(11, bounds);
  checkTree(boxes.scene);
  const ObjectTree& tree = boxes.tree();
  for (int k = 0; k < 3; ++k) {
    CHECK(objectBox(boxes.scene.impl(), 11).lo[k] <= bounds.lo[k]);
    CHECK(objectBox(boxes.scene.impl(), 11).hi[k] >= bounds.hi[k]);
    CHECK(tree.worldBox().lo[k] <= bounds.lo[k]);
  }
  // The bounds end with the object.
  boxes.scene.removeObject(11);
  CHECK(boxes.scene.addObject({boxes.mesh, at(0, 0, 0), ~0u}) == 11);
  checkTree(boxes.scene);
  CHECK(objectBox(boxes.scene.impl(), 11).lo[0] > -2);
}

TEST_CASE("far from the origin, boxes are hardly larger than their objects") {
  Boxes boxes(6);
  const double away = 1e12;
  boxes.add(50, 20, away);
  const auto checkSizes = [&] {
    const ObjectTree& tree = boxes.tree();
    for (const gpu::ObjectNode& node : tree.nodes()) {
      if ((node.link & gpu::kLinkLeaf) == 0) continue;
      const Box box = objectBox(boxes.scene.impl(), node.link & gpu::kLinkItem);
      // Doubles at 10^12 are 10^-4 apart; floats would be 65,536.
      for (int k = 0; k < 3; ++k) CHECK(node.halfExtent[k] < 0.5 * (box.hi[k] - box.lo[k]) + 0.01);
    }
  };
  checkSizes();
  // All objects move far away together.
  for (ObjectId id = 0; id < 50; ++id) boxes.scene.setTransform(id, boxes.anywhere(20, -3 * away));
  checkTree(boxes.scene);
  checkSizes();
}

TEST_CASE("a tree that moves have degraded is rebuilt") {
  Boxes boxes(7), fresh(8);
  std::vector<Transform> poses;
  for (int i = 0; i < 300; ++i) {
    // For objects in a row, a tree of neighbours is much better than any other.
    boxes.scene.addObject({boxes.mesh, at(10 * i, 0, 0), ~0u});
    poses.push_back(at(10 * ((7 * i) % 300), 0, 0));
  }
  const double before = costOf(boxes.tree());
  for (ObjectId id = 0; id < 300; ++id) {
    boxes.scene.setTransform(id, poses[id]);
    fresh.scene.addObject({fresh.mesh, poses[id], ~0u});
  }
  checkTree(boxes.scene);
  CHECK(costOf(boxes.tree()) == Approx(costOf(fresh.tree())));
  CHECK(costOf(boxes.tree()) < 1.5 * before);
}

TEST_CASE("the tree is out of range while floats cannot represent an object or its bounds") {
  Boxes boxes(9);
  boxes.add(5, 20);
  const ObjectTree& tree = boxes.tree();
  const auto inRange = [&] { return boxes.tree().inRange(); };
  const auto scaled = [](double s) { return Transform{{s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0}}; };
  CHECK(inRange());
  for (const Transform& pose : {at(0x1p81, 0, 0), at(0, 0, -0x1p81), scaled(0x1p81), at(1e240, 0, 0), scaled(1e240)}) {
    boxes.scene.setTransform(2, pose);
    CHECK_FALSE(inRange());
    CHECK(tree.nodes().empty());
    boxes.scene.setTransform(2, at(0, 0x1p79, 0));
    checkTree(boxes.scene);
  }
  // Steps that hardly change the tree's boxes.
  boxes.scene.setTransform(2, at(0, 0.99 * 0x1p80, 0));
  CHECK(inRange());
  boxes.scene.setTransform(2, at(0, 1.01 * 0x1p80, 0));
  CHECK_FALSE(inRange());
  CHECK(tree.nodes().empty());
  boxes.scene.setTransform(2, at(0, 0, 0));
  boxes.scene.setBounds(2, {{-1, -1, -1}, {1, 0x1p81, 1}});
  CHECK_FALSE(inRange());
  boxes.scene.removeObject(2);
  checkTree(boxes.scene);
  // The same for a tree that has never been in range.
  Boxes other(10);
  const ObjectId far = other.scene.addObject({other.mesh, at(1e200, 0, 0), ~0u});
  other.scene.addObject({other.mesh, at(1, 0, 0), ~0u});
  CHECK_FALSE(other.tree().inRange());
  other.scene.setTransform(far, at(5, 0, 0));
  checkTree(other.scene);
}

TEST_CASE("single edits of a large scene keep its tree valid and no worse than twice a new one") {
  Boxes boxes(11);
  boxes.add(600, 40);
  for (int round = 0; round < 150; ++round) {
    CAPTURE(round);
    checkTree(boxes.scene);
    for (uint32_t edits = 1 + boxes.random.below(3); edits > 0; --edits) {
      boxes.edit(boxes.random.below(3), round % 10 == 0 ? 80 : 40);
    }
  }
  Boxes again(11);
  for (const ObjectId id : boxes.objects) again.scene.addObject(boxes.scene.object(id));
  CHECK(costOf(boxes.tree()) < 2 * costOf(again.tree()));
  // Down to nothing, and from there.
  while (!boxes.objects.empty()) {
    boxes.removeAny();
    if (boxes.objects.size() % 50 < 3) checkTree(boxes.scene);
  }
  CHECK(boxes.tree().nodes().empty());
  boxes.add(1, 1);
  checkTree(boxes.scene);
}

TEST_CASE("numbers of objects that are free, however many in a row, do not widen the scene's box") {
  // A whole chunk of them made it endless: searches culled little, and devices found every sensor out of range.
  Boxes boxes(13);
  boxes.add(20'000, 100);
  boxes.tree();
  for (size_t i = 100; i < boxes.objects.size() - 1; ++i) boxes.scene.removeObject(boxes.objects[i]);
  const ObjectTree& tree = boxes.tree();
  Box around;
  for (ObjectId id = 0; id < boxes.scene.objectLimit(); ++id) {
    if (boxes.scene.hasObject(id)) around.merge(objectBox(boxes.scene.impl(), id));
  }
  CHECK(tree.worldBox().lo == around.lo);
  CHECK(tree.worldBox().hi == around.hi);
}

TEST_CASE("the pages of changed nodes have every node that an edit changes, and few others") {
  Boxes boxes(12);
  boxes.add(10'000, 100);
  const ObjectTree& tree = boxes.tree();
  NodeVector<gpu::ObjectNode> before = tree.nodes();
  size_t changed = 0, missed = 0, named = 0;
  uint32_t edits = 0;
  for (; edits < 1'500; ++edits) {
    const uint64_t seen = tree.version();
    boxes.edit(edits % 3, 100);
    const NodeVector<gpu::ObjectNode>& nodes = boxes.tree().nodes();
    std::vector<bool> isNamed(nodes.size());
    tree.changedNodes().forEachSince(seen, [&](size_t first, size_t last) {
      std::fill(isNamed.begin() + static_cast<ptrdiff_t>(first), isNamed.begin() + static_cast<ptrdiff_t>(last), true);
      named += last - first;
    });
    for (size_t i = 0; i < nodes.size(); ++i) {
      const auto& now = nodes[i];
      const bool isSame = i < before.size() && now.link == before[i].link &&
                          std::ranges::equal(now.centre, before[i].centre) &&
                          std::ranges::equal(now.halfExtent, before[i].halfExtent);
      changed += isSame ? 0 : 1;
      missed += isSame || isNamed[i] ? 0 : 1;
    }
    before = nodes;
  }
  CHECK(missed == 0);
  CHECK(changed > edits);
  CHECK(named < edits * tree.nodes().size() / 8);
}
