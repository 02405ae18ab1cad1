#include "embed/geometry_list.h"

#include <algorithm>

#include "embed/host_format.h"
#include "embed/moved_tree.h"
#include "gpu/kernel.h"
#include "math/rounding.h"

namespace radar {

namespace {

void addDeformed(DeformedList& list, const DeformedMesh& deformed, uint32_t firstByte, const Mesh& mesh) {
  gpu::Deformed added{.mesh = deformed.mesh,
                      .vertices = mesh.vertexCount(),
                      .triangles = mesh.triangleCount(),
                      .firstByte = firstByte,
                      .stride = static_cast<uint32_t>(deformed.positions.stride),
                      .format = HostFormat(deformed.positions.format).component(),
                      .extent = gpu::kNobody};
  std::ranges::copy(list.groups, added.firstGroup);
  list.groups[gpu::kByDeform] += gpu::groupsFor(added.vertices, gpu::kHostGroup);
  if (!mesh.hasBounds) {
    added.extent = static_cast<uint32_t>(list.unbounded.size());
    list.groups[gpu::kByBound] += gpu::groupsFor(added.triangles, gpu::kHostGroup * gpu::kBoundRun);
    list.unbounded.push_back(deformed.mesh);
  }
  list.firstHostVertices.push_back(mesh.firstHostVertex);
  list.meshes.push_back(added);
}

// Lists the nodes of all meshes by depth, because a node is refitted after its children.
void addRefitNodes(DeformedList& list, const Scene::Impl& scene) {
  std::vector<std::vector<gpu::RefitNode>> byDepth;
  for (const gpu::Deformed& deformed : list.meshes) {
    const MeshTree& tree = scene.meshes[deformed.mesh].tree;
    byDepth.resize(std::max<size_t>(byDepth.size(), tree.depth));
    std::vector<uint32_t> depths(tree.nodes.size());
    for (uint32_t n = 0; n < depths.size(); ++n) {  // parents before children
      byDepth[depths[n]].push_back({deformed.mesh, n});
      const uint32_t link = tree.nodes[n].link;
      if ((link & gpu::kLinkLeaf) == 0) depths[link] = depths[link + 1] = depths[n] + 1;
    }
  }
  for (const std::vector<gpu::RefitNode>& nodes : byDepth) {
    list.refitNodes.insert(list.refitNodes.end(), nodes.begin(), nodes.end());
    list.refitEnds.push_back(static_cast<uint32_t>(list.refitNodes.size()));
  }
}

gpu::Moved movedOf(ObjectId id, const Scene::Impl& scene) {
  gpu::Moved moved{.object = id,
                   .mesh = scene.objects[id].object.mesh,
                   .mask = scene.objects[id].object.mask,
                   .firstByte = gpu::kNobody};
  const Box* box = scene.boundsOf(id);
  moved.leaf = box == nullptr ? scene.objectTree().leafOf(id) : gpu::kNobody;
  for (int k = 0; k < 3; ++k) {
    moved.anchor[k] = box == nullptr ? 0.0f : static_cast<float>(box->middle(k));
    moved.halfExtent[k] = box == nullptr
                              ? static_cast<float>(kMostCoordinate)
                              : roundDown(std::min(box->hi[k] - moved.anchor[k], moved.anchor[k] - box->lo[k]));
  }
  return moved;
}

// Adds the objects that a host moves, and marks them.
void addGroup(MovedList& list, const MovedObjects& group, uint32_t firstByte, std::vector<bool>& isNamed,
              const Scene::Impl& scene) {
  for (size_t k = 0; k < countOf(group); ++k) {
    const ObjectId id = objectOf(group, k);
    if (id >= scene.objects.size() || !scene.objects[id].used) {
      throw Error("geometry: object " + std::to_string(id) + " does not exist");
    }
    if (isNamed[id]) throw Error("geometry: objects: expected each at most once");
    isNamed[id] = true;
    gpu::Moved moved = movedOf(id, scene);
    moved.firstByte = static_cast<uint32_t>(firstByte + k * group.stride);
    moved.format = {group.layout.row, group.layout.column};
    list.moved.push_back(moved);
    list.named.push_back(id);
  }
}

// Adds the objects that stand, but whose meshes are deformed without bounds.
void addStanding(MovedList& list, std::span<const MeshId> meshes, const std::vector<bool>& isNamed,
                 const Scene::Impl& scene, std::vector<ObjectId>& standing) {
  if (meshes.empty()) return;
  std::vector<bool> isDeformed(scene.meshes.size());
  for (const MeshId mesh : meshes) isDeformed[mesh] = true;
  for (ObjectId id = 0; id < scene.objects.size(); ++id) {
    if (isNamed[id] || !scene.objects[id].used || !isDeformed[scene.objects[id].object.mesh]) continue;
    list.moved.push_back(movedOf(id, scene));
    standing.push_back(id);
  }
}

// The nodes whose boxes change with the leaves of moved objects: marks of all nodes.
std::vector<bool> markPaths(std::span<const gpu::Moved> moved, const ObjectTree& tree) {
  std::vector<bool> marks(tree.nodes().size());
  for (const gpu::Moved& object : moved) {
    for (uint32_t n = object.leaf; n != kNone && !marks[n]; n = tree.parentOf(n)) marks[n] = true;
  }
  return marks;
}

// The parts of the tree, of which the marked inner nodes are above.
std::vector<uint32_t> partsOf(const ObjectTree& tree, const std::vector<bool>& marks) {
  std::vector<uint32_t> parts, open;
  if (!marks.empty() && marks[0]) open.push_back(0);
  while (!open.empty()) {
    const uint32_t node = open.back(), link = tree.nodes()[node].link;
    open.pop_back();
    if (!marks[node] || (link & gpu::kLinkLeaf) != 0) {
      parts.push_back(node);
    } else {
      open.insert(open.end(), {link + 1, link});
    }
  }
  return parts;
}

// The numbers that are marked, ascending.
std::vector<uint32_t> numbersOf(const std::vector<bool>& marks) {
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < marks.size(); ++i) {
    if (marks[i]) numbers.push_back(i);
  }
  return numbers;
}

// Ascending.
std::vector<uint32_t> leavesOf(std::span<const gpu::Moved> moved) {
  std::vector<uint32_t> leaves;
  for (const gpu::Moved& object : moved) {
    if (object.leaf != gpu::kNobody) leaves.push_back(object.leaf);
  }
  std::ranges::sort(leaves);
  return leaves;
}

// Whether the groups name these objects.
bool areNamed(std::span<const ObjectId> named, std::span<const MovedObjects> groups) {
  size_t next = 0;
  for (const MovedObjects& group : groups) {
    for (size_t k = 0; k < countOf(group); ++k) {
      if (named[next++] != objectOf(group, k)) return false;
    }
  }
  return true;
}

}  // namespace

void update(DeformedList& list, const HostGeometry& geometry, std::span<const uint32_t> firstBytes,
            const Scene::Impl& scene) {
  std::vector<uint64_t> key(firstBytes.begin(), firstBytes.end());
  for (const DeformedMesh& deformed : geometry.meshes) {
    key.insert(key.end(), {deformed.mesh, scene.meshes[deformed.mesh].version, deformed.positions.stride,
                           static_cast<uint64_t>(deformed.positions.format)});
  }
  if (list.key == key) return;
  list = {};
  DeformedList next{.key = std::move(key)};
  for (size_t i = 0; i < geometry.meshes.size(); ++i) {
    const DeformedMesh& deformed = geometry.meshes[i];
    addDeformed(next, deformed, firstBytes[i], scene.meshes[deformed.mesh]);
  }
  addRefitNodes(next, scene);
  list = std::move(next);
}

void update(MovedList& list, const HostGeometry& geometry, std::span<const uint32_t> firstBytes,
            std::span<const MeshId> meshes, const Scene::Impl& scene) {
  const ObjectTree& tree = scene.objectTree();
  // An object may have taken another's number, and its leaf.
  std::vector<uint64_t> key{scene.identity, scene.structureVersion, tree.structure(), scene.boundsVersion,
                            meshes.size()};
  key.insert(key.end(), meshes.begin(), meshes.end());
  for (size_t i = 0; i < geometry.objects.size(); ++i) {
    const MovedObjects& group = geometry.objects[i];
    key.insert(key.end(), {firstBytes[i], countOf(group), group.stride, group.layout.row, group.layout.column});
  }
  if (list.key == key && areNamed(list.named, geometry.objects)) return;
  list = {};
  MovedList next{.key = std::move(key)};
  GpuScene::Moved overwritten;
  std::vector<bool> isNamed(scene.objects.size());
  for (size_t i = 0; i < geometry.objects.size(); ++i) {
    addGroup(next, geometry.objects[i], firstBytes[i], isNamed, scene);
  }
  addStanding(next, meshes, isNamed, scene, overwritten.standing);
  if (!next.moved.empty()) {
    for (const gpu::Moved& moved : next.moved) {
      if (moved.leaf != gpu::kNobody) next.unbounded.push_back(moved.object);
    }
    std::ranges::sort(next.unbounded);
    next.parts = partsOf(tree, markPaths(next.moved, tree));
    overwritten.objects = numbersOf(isNamed);
    overwritten.nodes = leavesOf(next.moved);
    // The root, too.
    if (next.parts.size() > 1) overwritten.nodes.insert(overwritten.nodes.begin(), 0);
    overwritten.built = MovedTree::nodesAbove(next.parts.size());
    next.overwritten = std::make_shared<const GpuScene::Moved>(std::move(overwritten));
  }
  list = std::move(next);
}

}  // namespace radar
