#include "embed/geometry_list.h"

#include <algorithm>

#include "embed/host_format.h"
#include "math/rounding.h"

namespace radar {

namespace {

std::vector<uint64_t> keyOf(const HostGeometry& geometry, std::span<const uint32_t> firstBytes,
                            const Scene::Impl& scene) {
  // An object may have taken another's number, and its leaf.
  std::vector<uint64_t> key{scene.identity, scene.structureVersion, scene.objectTree().structure(), scene.boundsVersion,
                            geometry.meshes.size()};
  for (const DeformedMesh& deformed : geometry.meshes) {
    key.insert(key.end(), {deformed.mesh, scene.meshes[deformed.mesh].version, deformed.positions.stride,
                           static_cast<uint64_t>(deformed.positions.format)});
  }
  for (const MovedObjects& moved : geometry.objects) {
    key.insert(key.end(), {moved.objects.size(), moved.stride, moved.layout.row, moved.layout.column});
  }
  key.insert(key.end(), firstBytes.begin(), firstBytes.end());
  return key;
}

void addDeformed(GeometryList& list, const DeformedMesh& deformed, uint32_t firstByte, const Mesh& mesh) {
  const bool areListed = !mesh.hostVertices.empty();
  list.meshes.push_back({.mesh = deformed.mesh,
                         .vertices = mesh.vertexCount(),
                         .triangles = mesh.triangleCount(),
                         .firstByte = firstByte,
                         .stride = static_cast<uint32_t>(deformed.positions.stride),
                         .component = HostFormat(deformed.positions.format).component(),
                         .firstHostVertex = mesh.firstHostVertex,
                         .numbers = areListed ? static_cast<uint32_t>(list.vertexNumbers.size()) : kNone,
                         .isBounded = mesh.deforms});
  for (const uint32_t vertex : mesh.hostVertices) list.vertexNumbers.push_back(vertex - mesh.firstHostVertex);
  if (!mesh.deforms) list.unboundedMeshes.push_back(deformed.mesh);
  list.overwritten.meshes.push_back(deformed.mesh);
}

// Adds the nodes of a mesh by depth, because a node is refitted after its children.
void addLevels(GeometryList& list, MeshId mesh, const MeshTree& tree) {
  std::vector<std::vector<uint32_t>> byDepth(tree.depth);
  std::vector<uint32_t> depths(tree.nodes.size());
  for (uint32_t n = 0; n < depths.size(); ++n) {  // parents before children
    byDepth[depths[n]].push_back(n);
    const uint32_t link = tree.nodes[n].link;
    if ((link & gpu::kLinkLeaf) == 0) depths[link] = depths[link + 1] = depths[n] + 1;
  }
  list.levels.resize(std::max(list.levels.size(), byDepth.size()));
  for (size_t depth = 0; depth < byDepth.size(); ++depth) {
    list.levels[depth].push_back(
        {mesh, static_cast<uint32_t>(list.refitNodes.size()), static_cast<uint32_t>(byDepth[depth].size())});
    list.refitNodes.insert(list.refitNodes.end(), byDepth[depth].begin(), byDepth[depth].end());
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
void addGroup(GeometryList& list, const MovedObjects& group, uint32_t firstByte, std::vector<bool>& isNamed,
              const Scene::Impl& scene) {
  for (size_t k = 0; k < group.objects.size(); ++k) {
    const ObjectId id = group.objects[k];
    if (id >= scene.objects.size() || !scene.objects[id].used) {
      throw Error("record: geometry: object " + std::to_string(id) + " does not exist");
    }
    if (isNamed[id]) throw Error("record: geometry: objects: expected each at most once");
    isNamed[id] = true;
    gpu::Moved moved = movedOf(id, scene);
    moved.firstByte = static_cast<uint32_t>(firstByte + k * group.stride);
    moved.format = {group.layout.row, group.layout.column};
    list.moved.push_back(moved);
  }
  list.named.insert(list.named.end(), group.objects.begin(), group.objects.end());
}

// Adds the objects that stand, but whose meshes are deformed without bounds.
void addStanding(GeometryList& list, const std::vector<bool>& isNamed, const Scene::Impl& scene,
                 std::vector<ObjectId>& standing) {
  if (list.unboundedMeshes.empty()) return;
  std::vector<bool> isDeformed(scene.meshes.size());
  for (const MeshId mesh : list.unboundedMeshes) isDeformed[mesh] = true;
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

// Adds the marked inner nodes by depth.
void addFitNodes(GeometryList& list, const std::vector<bool>& marks, const ObjectTree& tree) {
  std::vector<uint32_t>& nodes = list.fitNodes;
  const auto add = [&](uint32_t n) {
    if (marks[n] && (tree.nodes()[n].link & gpu::kLinkLeaf) == 0) nodes.push_back(n);
  };
  if (!marks.empty()) add(0);
  for (size_t i = 0; i < nodes.size();) {
    const size_t end = nodes.size();
    list.fitEnds.push_back(static_cast<uint32_t>(end));
    for (; i < end; ++i) {
      const uint32_t left = tree.nodes()[nodes[i]].link;
      add(left);
      add(left + 1);
    }
  }
}

// The numbers that are marked, ascending.
std::vector<uint32_t> numbersOf(const std::vector<bool>& marks) {
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < marks.size(); ++i) {
    if (marks[i]) numbers.push_back(i);
  }
  return numbers;
}

}  // namespace

bool GeometryList::isOf(const HostGeometry& geometry, std::span<const uint32_t> firstBytes,
                        const Scene::Impl& scene) const {
  if (key != keyOf(geometry, firstBytes, scene)) return false;
  auto next = named.begin();
  return std::ranges::all_of(geometry.objects, [&](const MovedObjects& moved) {
    const auto first = next;
    next += static_cast<ptrdiff_t>(moved.objects.size());
    return std::equal(first, next, moved.objects.begin());
  });
}

GeometryList listOf(const HostGeometry& geometry, std::span<const uint32_t> firstBytes, const Scene::Impl& scene) {
  GeometryList list;
  list.key = keyOf(geometry, firstBytes, scene);
  auto firstByte = firstBytes.begin();
  for (const DeformedMesh& deformed : geometry.meshes) {
    addDeformed(list, deformed, *firstByte++, scene.meshes[deformed.mesh]);
    addLevels(list, deformed.mesh, scene.meshes[deformed.mesh].tree);
  }
  std::vector<bool> isNamed(scene.objects.size());
  for (const MovedObjects& group : geometry.objects) addGroup(list, group, *firstByte++, isNamed, scene);
  GpuScene::Moved overwritten;
  addStanding(list, isNamed, scene, overwritten.standing);
  if (list.moved.empty()) return list;
  for (const gpu::Moved& moved : list.moved) {
    if (moved.leaf != gpu::kNobody) list.unbounded.push_back(moved.object);
  }
  std::ranges::sort(list.unbounded);
  const std::vector<bool> marks = markPaths(list.moved, scene.objectTree());
  addFitNodes(list, marks, scene.objectTree());
  overwritten.objects = numbersOf(isNamed);
  overwritten.nodes = numbersOf(marks);
  list.overwritten.moved = std::make_shared<const GpuScene::Moved>(std::move(overwritten));
  return list;
}

}  // namespace radar
