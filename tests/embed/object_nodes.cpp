#include "embed/object_nodes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "scene/box_tree.h"
#include "workloads/random.h"

namespace radar::test {

namespace {

bool isLeaf(const gpu::ObjectNode& node) {
  return (node.link & gpu::kLinkLeaf) != 0;
}
ObjectId objectOf(const gpu::ObjectNode& leaf) {
  return leaf.link & gpu::kLinkItem;
}

FloatBox boxOf(const gpu::ObjectNode& node) {
  FloatBox box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = node.centre[k] - node.halfExtent[k];
    box.hi[k] = node.centre[k] + node.halfExtent[k];
  }
  return box;
}

// The ends are floats, as the device computes them.
bool contains(const gpu::ObjectNode& node, const gpu::ObjectNode& below) {
  const FloatBox box = boxOf(node), inner = boxOf(below);
  bool inside = true;
  for (int k = 0; k < 3; ++k) inside = inside && box.lo[k] <= inner.lo[k] && inner.hi[k] <= box.hi[k];
  return inside;
}

// The leaves by their objects.
std::map<ObjectId, gpu::ObjectNode> leavesOf(const ObjectNodes& nodes) {
  std::map<ObjectId, gpu::ObjectNode> leaves;
  for (const auto& [object, path] : pathsTo(nodes)) leaves[object] = nodes[path.back()];
  return leaves;
}

// When a box on its way meets another; negative: it does not.
struct Flight {
  gpu::ObjectNode box;
  tools::Vec3 way;

  double meets(const gpu::ObjectNode& other, double most) const {
    double begin = 0, end = most;
    for (size_t k = 0; k < 3; ++k) {
      const double reach = double(box.halfExtent[k]) + other.halfExtent[k];
      const double a = (double(other.centre[k]) - box.centre[k] - reach) / way[k], b = a + 2 * reach / way[k];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    return begin <= end ? begin : -1;
  }
};

size_t testsOf(const ObjectNodes& nodes, const Flight& flight, double most) {
  struct Entry {
    uint32_t link;
    double at;
  };
  std::vector<Entry> open{{nodes[0].link, 0}};
  size_t tests = 0;
  while (!open.empty()) {
    const Entry entry = open.back();
    open.pop_back();
    if (entry.at > most) continue;
    if ((entry.link & gpu::kLinkLeaf) != 0) {
      if (entry.link != flight.box.link) most = entry.at;
      continue;
    }
    ++tests;
    std::vector<Entry> met;
    for (const uint32_t child : {entry.link, entry.link + 1}) {
      const double at = flight.meets(nodes[child], most);
      if (at >= 0) met.push_back({nodes[child].link, at});
    }
    std::ranges::sort(met, std::greater(), &Entry::at);
    open.insert(open.end(), met.begin(), met.end());
  }
  return tests;
}

}  // namespace

std::map<ObjectId, std::vector<uint32_t>> pathsTo(const ObjectNodes& nodes) {
  std::map<ObjectId, std::vector<uint32_t>> paths;
  std::vector<std::vector<uint32_t>> open{{0}};
  while (!open.empty()) {
    const std::vector<uint32_t> path = open.back();
    open.pop_back();
    if (path.back() >= nodes.size() || path.size() > nodes.size()) throw std::logic_error("a link to no node");
    const gpu::ObjectNode& node = nodes[path.back()];
    if (isLeaf(node)) {
      if (!paths.emplace(objectOf(node), path).second) throw std::logic_error("an object is in the tree twice");
      continue;
    }
    for (const uint32_t child : {node.link, node.link + 1}) {
      open.push_back(path);
      open.back().push_back(child);
    }
  }
  return paths;
}

std::string faultOf(const ObjectNodes& nodes, const Scene& scene) try {
  const std::map<ObjectId, std::vector<uint32_t>> paths = pathsTo(nodes);
  size_t objects = 0;
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!scene.hasObject(id)) continue;
    ++objects;
    if (paths.count(id) == 0) return "object " + std::to_string(id) + " is missing";
  }
  if (paths.size() != objects) return "there is an object too many";
  const size_t own = scene.impl().objectTree().nodes().size();
  for (const auto& [object, path] : paths) {
    for (size_t i = 1; i < path.size(); ++i) {
      // The others are as the CPU fitted them.
      if (path[i] >= own && !contains(nodes[path[i - 1]], nodes[path[i]])) {
        return "node " + std::to_string(path[i]) + ", on the way to object " + std::to_string(object) +
               ", is not inside the one above";
      }
    }
  }
  return {};
} catch (const std::logic_error& error) {
  return error.what();
}

size_t testsOf(const ObjectNodes& nodes, double distance) {
  tools::Random random(1);
  size_t tests = 0;
  for (const auto& [object, leaf] : leavesOf(nodes)) {
    const Flight flight{leaf, random.direction()};
    if (object % 3 == 0) tests += testsOf(nodes, flight, distance);
  }
  return tests;
}

ObjectNodes rebuilt(const ObjectNodes& nodes) {
  const std::map<ObjectId, gpu::ObjectNode> leaves = leavesOf(nodes);
  std::vector<BoxedItem> items;
  for (const auto& [object, leaf] : leaves) items.push_back({boxOf(leaf), object});
  const BoxTree tree = buildBoxTree(items, 1);
  ObjectNodes built(tree.nodes.size());
  std::vector<FloatBox> boxes(built.size());
  for (size_t i = built.size(); i-- > 0;) {
    const auto [first, count, child] = tree.nodes[i];
    boxes[i] = child == 0 ? items[first].box() : around(boxes[child], boxes[child + 1]);
    fitBox(boxes[i], built[i].centre, built[i].halfExtent);
    built[i].link = child != 0 ? child : gpu::kLinkLeaf | items[first].index();
  }
  return built;
}

ObjectNodes refitted(const ObjectNodes& nodes, const ObjectNodes& links) {
  const std::map<ObjectId, gpu::ObjectNode> leaves = leavesOf(nodes);
  ObjectNodes fitted = links;
  const std::function<void(uint32_t)> fit = [&](uint32_t n) {
    gpu::ObjectNode& node = fitted[n];
    if (isLeaf(node)) {
      node = leaves.at(objectOf(node));
      return;
    }
    fit(node.link);
    fit(node.link + 1);
    fitBox(around(boxOf(fitted[node.link]), boxOf(fitted[node.link + 1])), node.centre, node.halfExtent);
  };
  fit(0);
  return fitted;
}

}  // namespace radar::test
