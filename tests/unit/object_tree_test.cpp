// The tree over a scene's objects contains all of them, wherever they are and however the scene has changed.
#include <algorithm>
#include <cmath>

#include "exact/dyadic.h"
#include "scene/scene.h"
#include "support/catch.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using exact::Dyadic;
using tools::Random;

Transform at(double x, double y, double z) {
  return {{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}};
}

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

struct Boxes {
  explicit Boxes(uint64_t seed) : random(seed) {
    const tools::MeshData box = tools::makeBox({1, 2, 3});
    mesh = scene.addMesh(box.positions, box.indices);
  }
  Transform anywhere(double reach, double away = 0) {
    const std::array<double, 3> lo{away - reach, away - reach, -reach}, hi{away + reach, away + reach, reach};
    return tools::makePose(random.rotation(), {0.3, 0.5, 1.0}, random.inBox(lo, hi));
  }
  Random random;
  Scene scene;
  MeshId mesh;
};

}  // namespace

TEST_CASE("the tree contains all objects while they are added, moved and removed") {
  Boxes boxes(3);
  const double away = GENERATE(0.0, 1e6, 1e12);
  std::vector<ObjectId> objects;
  CHECK(boxes.scene.impl().objectTree().nodes().empty());
  for (int round = 0; round < 40; ++round) {
    for (int i = 0; i < (round % 4 == 0 ? 10 : 0); ++i) {
      objects.push_back(boxes.scene.addObject({boxes.mesh, boxes.anywhere(20, away), ~0u}));
    }
    for (int i = 0; i < 5; ++i) {
      boxes.scene.setTransform(objects[boxes.random.below(uint32_t(objects.size()))], boxes.anywhere(20, away));
    }
    if (round % 8 == 7) {
      for (int i = 0; i < 4; ++i) {
        const uint32_t which = boxes.random.below(uint32_t(objects.size()));
        boxes.scene.removeObject(objects[which]);
        objects.erase(objects.begin() + which);
      }
    }
    checkTree(boxes.scene);
  }
  for (const ObjectId id : objects) boxes.scene.removeObject(id);
  checkTree(boxes.scene);
  CHECK(boxes.scene.impl().objectTree().nodes().empty());
  boxes.scene.addObject({boxes.mesh, boxes.anywhere(20, away), ~0u});
  checkTree(boxes.scene);
  CHECK(boxes.scene.impl().objectTree().nodes().size() == 1);
}

TEST_CASE("a small move changes the boxes and the version but not the structure of the tree") {
  Boxes boxes(4);
  for (int i = 0; i < 100; ++i) boxes.scene.addObject({boxes.mesh, boxes.anywhere(50), ~0u});
  const ObjectTree& tree = boxes.scene.impl().objectTree();
  const std::vector<gpu::ObjectNode> before = tree.nodes();
  uint64_t version = tree.version();
  CHECK(boxes.scene.impl().objectTree().version() == version);
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
  for (int i = 0; i < 20; ++i) boxes.scene.addObject({boxes.mesh, boxes.anywhere(20), ~0u});
  const Bounds bounds{{-70, -3, -3}, {-60, 3, 90}};
  boxes.scene.setBounds(11, bounds);
  checkTree(boxes.scene);
  const ObjectTree& tree = boxes.scene.impl().objectTree();
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
  for (int i = 0; i < 50; ++i) boxes.scene.addObject({boxes.mesh, boxes.anywhere(20, away), ~0u});
  const auto checkSizes = [&] {
    const ObjectTree& tree = boxes.scene.impl().objectTree();
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
  const double before = costOf(boxes.scene.impl().objectTree());
  for (ObjectId id = 0; id < 300; ++id) {
    boxes.scene.setTransform(id, poses[id]);
    fresh.scene.addObject({fresh.mesh, poses[id], ~0u});
  }
  checkTree(boxes.scene);
  CHECK(costOf(boxes.scene.impl().objectTree()) == Approx(costOf(fresh.scene.impl().objectTree())));
  CHECK(costOf(boxes.scene.impl().objectTree()) < 1.5 * before);
}

TEST_CASE("the tree is out of range while floats cannot represent an object or its bounds") {
  Boxes boxes(9);
  for (int i = 0; i < 5; ++i) boxes.scene.addObject({boxes.mesh, boxes.anywhere(20), ~0u});
  const ObjectTree& tree = boxes.scene.impl().objectTree();
  const auto inRange = [&] { return boxes.scene.impl().objectTree().inRange(); };
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
  CHECK_FALSE(other.scene.impl().objectTree().inRange());
  other.scene.setTransform(far, at(5, 0, 0));
  checkTree(other.scene);
}

TEST_CASE("single edits of a large scene keep its tree valid and no worse than twice a new one") {
  Boxes boxes(11);
  std::vector<ObjectId> objects(600);
  for (ObjectId& object : objects) object = boxes.scene.addObject({boxes.mesh, boxes.anywhere(40)});
  for (int round = 0; round < 150; ++round) {
    CAPTURE(round);
    checkTree(boxes.scene);
    for (uint32_t edits = 1 + boxes.random.below(3); edits > 0; --edits) {
      const uint32_t which = boxes.random.below(static_cast<uint32_t>(objects.size()));
      const uint32_t kind = boxes.random.below(3);
      if (kind == 0) {
        objects.push_back(boxes.scene.addObject({boxes.mesh, boxes.anywhere(round % 10 == 0 ? 80 : 40)}));
      } else if (kind == 1) {
        boxes.scene.setTransform(objects[which], boxes.anywhere(40));
      } else {
        boxes.scene.removeObject(objects[which]);
        objects.erase(objects.begin() + which);
      }
    }
  }
  Scene again;
  const MeshView mesh = boxes.scene.mesh(boxes.mesh);
  again.addMesh(mesh.positions, mesh.indices);
  for (const ObjectId id : objects) again.addObject(boxes.scene.object(id));
  CHECK(costOf(boxes.scene.impl().objectTree()) < 2 * costOf(again.impl().objectTree()));
  // Down to nothing, and from there.
  while (!objects.empty()) {
    boxes.scene.removeObject(objects.back());
    objects.pop_back();
    if (objects.size() % 50 < 3) checkTree(boxes.scene);
  }
  CHECK(boxes.scene.impl().objectTree().nodes().empty());
  boxes.scene.addObject({boxes.mesh, boxes.anywhere(1)});
  checkTree(boxes.scene);
}

TEST_CASE("numbers of objects that are free, however many in a row, do not widen the scene's box") {
  // A whole chunk of them made it endless: searches culled little, and devices found every sensor out of range.
  Boxes boxes(13);
  std::vector<ObjectId> objects(20'000);
  for (ObjectId& object : objects) object = boxes.scene.addObject({boxes.mesh, boxes.anywhere(100)});
  boxes.scene.impl().objectTree();
  for (size_t i = 100; i < objects.size() - 1; ++i) boxes.scene.removeObject(objects[i]);
  const ObjectTree& tree = boxes.scene.impl().objectTree();
  Box around;
  for (ObjectId id = 0; id < boxes.scene.objectLimit(); ++id) {
    if (boxes.scene.hasObject(id)) around.merge(objectBox(boxes.scene.impl(), id));
  }
  CHECK(tree.worldBox().lo == around.lo);
  CHECK(tree.worldBox().hi == around.hi);
}

TEST_CASE("the pages of changed nodes have every node that an edit changes, and few others") {
  Boxes boxes(12);
  std::vector<ObjectId> objects(10'000);
  for (ObjectId& object : objects) object = boxes.scene.addObject({boxes.mesh, boxes.anywhere(100)});
  const ObjectTree& tree = boxes.scene.impl().objectTree();
  std::vector<gpu::ObjectNode> before = tree.nodes();
  size_t changed = 0, missed = 0, named = 0, edits = 0;
  for (; edits < 1'500; ++edits) {
    const uint64_t seen = tree.version();
    const uint32_t which = boxes.random.below(static_cast<uint32_t>(objects.size()));
    if (edits % 3 == 0) {
      objects.push_back(boxes.scene.addObject({boxes.mesh, boxes.anywhere(100)}));
    } else if (edits % 3 == 1) {
      boxes.scene.setTransform(objects[which], boxes.anywhere(100));
    } else {
      boxes.scene.removeObject(objects[which]);
      objects.erase(objects.begin() + which);
    }
    const std::vector<gpu::ObjectNode>& nodes = boxes.scene.impl().objectTree().nodes();
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
