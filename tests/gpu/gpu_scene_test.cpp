// A scene's copy on the device equals the scene after every change, and only changed data is uploaded.
#include <algorithm>
#include <cstring>

#include "scene/gpu_scene.h"
#include "scene/placement.h"
#include "support/buffer_words.h"
#include "support/catch.h"
#include "support/test_device.h"
#include "support/world.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::elementsOf;

template <class T, class P = std::allocator<T>, class Q = std::allocator<T>>
bool sameBits(const std::vector<T, P>& p, const std::vector<T, Q>& q) {
  return p.size() == q.size() && (p.empty() || std::memcmp(p.data(), q.data(), p.size() * sizeof(T)) == 0);
}

NodeVector<gpu::MeshNode> nodesOf(const Mesh& mesh, const gpu::MeshRecord& record) {
  NodeVector<gpu::MeshNode> nodes = mesh.tree.nodes;
  for (gpu::MeshNode& node : nodes) {
    node.link += (node.link & gpu::kLinkLeaf) != 0 ? record.firstTriangle : record.firstNode;
  }
  return nodes;
}

void checkMesh(const Mesh& mesh, const gpu::MeshRecord& record, const GpuScene::Buffers& buffers) {
  CHECK(record.unit == mesh.unit);
  CHECK(record.perUnit * record.unit == 1);
  for (int k = 0; k < 3; ++k) {
    CHECK(record.origin[k] == mesh.origin[k]);
    CHECK(double{record.lo[k]} <= mesh.box.lo[k]);
    CHECK(double{record.hi[k]} >= mesh.box.hi[k]);
  }
  std::vector<gpu::Vertex> vertices(mesh.vertexCount());
  for (uint32_t v = 0; v < vertices.size(); ++v) {
    std::copy_n(&mesh.positions[3 * size_t{v}], 3, vertices[v].position);
    vertices[v].number = v;
  }
  CHECK(sameBits(elementsOf(buffers.vertices, record.firstVertex, mesh.vertexCount()), vertices));
  std::vector<gpu::Triangle> triangles;
  for (const uint32_t id : mesh.tree.order) {
    gpu::Triangle triangle{{}, id};
    for (size_t i = 0; i < 3; ++i) triangle.corners[i] = record.firstVertex + mesh.indices[3 * size_t{id} + i];
    triangles.push_back(triangle);
  }
  CHECK(sameBits(elementsOf(buffers.triangles, record.firstTriangle, mesh.triangleCount()), triangles));
  CHECK(sameBits(elementsOf(buffers.meshNodes, record.firstNode, mesh.tree.nodes.size()), nodesOf(mesh, record)));
}

void checkObject(const Scene::Impl& scene, ObjectId id, const GpuScene& copy) {
  const Object& object = scene.objects[id].object;
  gpu::Placement placement = placementOf(scene.meshes[object.mesh], object.worldFromMesh);
  placement.root = copy.record(object.mesh).firstNode;
  placement.mask = object.mask;
  placement.mesh = object.mesh;
  CHECK(sameBits(elementsOf(copy.buffers().placements, id, 1), {placement}));
  const gpu::ObjectRecord record = elementsOf(copy.buffers().objects, id, 1)[0];
  CHECK(record.mesh == object.mesh);
  CHECK(std::equal(object.worldFromMesh.m.begin(), object.worldFromMesh.m.end(), record.pose));
}

void checkTree(const GpuScene& copy, const Scene& scene) {
  const NodeVector<gpu::ObjectNode>& nodes = scene.impl().objectTree().nodes();
  CHECK(sameBits(elementsOf(copy.buffers().objectNodes, 0, nodes.size()), nodes));
}

// Checks that the copy has everything that the scene has.
void checkCopy(const GpuScene& copy, const Scene& scene) {
  const Scene::Impl& inner = scene.impl();
  for (MeshId id = 0; id < scene.meshLimit(); ++id) {
    if (!scene.hasMesh(id)) continue;
    CAPTURE(id);
    const gpu::MeshRecord record = elementsOf(copy.buffers().meshes, id, 1)[0];
    CHECK(sameBits<gpu::MeshRecord>({record}, {copy.record(id)}));
    checkMesh(inner.meshes[id], record, copy.buffers());
  }
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    CAPTURE(id);
    if (scene.hasObject(id)) checkObject(inner, id, copy);
  }
  checkTree(copy, scene);
}

Transform randomPose(tools::Random& random) {
  return random.affine(random.inCube(20));
}

MeshId addSoup(Scene& scene, tools::Random& random, uint32_t triangles) {
  return test::add(scene, tools::makeSoup(tools::kSoups[random.below(tools::kSoups.size())], triangles, random));
}

// Bytes that are staged, but not uploaded.
VkDeviceSize stagedOf(GpuScene& copy, const Scene& scene) {
  gpu::Upload upload(test::device().impl());
  copy.stage(scene.impl(), {}, upload);
  return upload.bytes();
}

struct FilledScene {
  explicit FilledScene(uint64_t seed) : random(seed), copy(test::device().impl()) {
    for (uint32_t i = 0; i < 3; ++i) meshes.push_back(addSoup(scene, random, 20 + 30 * i));
    for (uint32_t i = 0; i < 12; ++i) objects.push_back(scene.addObject({meshes[i % 3], randomPose(random), i + 1}));
  }
  VkDeviceSize staged() { return stagedOf(copy, scene); }
  tools::Random random;
  Scene scene;
  std::vector<MeshId> meshes;
  std::vector<ObjectId> objects;
  GpuScene copy;
};

}  // namespace

TEST_CASE("the device's copy follows every change of a scene") {
  FilledScene filled(3);
  for (int round = 0; round < 24; ++round) {
    tools::Random& random = filled.random;
    const auto any = [&] { return filled.objects[random.below(uint32_t(filled.objects.size()))]; };
    switch (round % 6) {
      case 0:
        for (int i = 0; i < 3; ++i) filled.scene.setTransform(any(), randomPose(random));
        break;
      case 1:  // the objects' buffers grow
        for (int i = 0; i < round; ++i) {
          filled.objects.push_back(filled.scene.addObject({filled.meshes[0], randomPose(random), 3u}));
        }
        break;
      case 2: {
        const ObjectId gone = any();
        filled.scene.removeObject(gone);
        std::erase(filled.objects, gone);
        filled.scene.removeObject(filled.objects.back());
        filled.objects.back() = filled.scene.addObject({filled.meshes[1], randomPose(random), ~0u});
        break;
      }
      case 3:  // when the buffers grow, meshes move in them, and so do the nodes that placements name
        addSoup(filled.scene, random, 100);
        filled.meshes.push_back(addSoup(filled.scene, random, 7));
        filled.objects.push_back(filled.scene.addObject({filled.meshes.back(), randomPose(random), ~0u}));
        break;
      case 4:
        filled.scene.setBounds(any(), {{-9, -9, -9}, {30, 30, 30}});
        break;
      default:  // a mesh without objects is removed, and another takes its id
        for (MeshId id = 0; id < filled.scene.meshLimit(); ++id) {
          if (filled.scene.hasMesh(id) && std::count(filled.meshes.begin(), filled.meshes.end(), id) == 0) {
            filled.scene.removeMesh(id);
            break;
          }
        }
        if (round % 2 == 0) addSoup(filled.scene, random, 50);
    }
    CAPTURE(round);
    filled.copy.sync(filled.scene.impl());
    checkCopy(filled.copy, filled.scene);
  }
}

TEST_CASE("only changed data is staged") {
  FilledScene filled(4);
  const VkDeviceSize all = filled.staged();
  CHECK(all > 10'000);
  filled.copy.sync(filled.scene.impl());
  CHECK(filled.staged() == 0);
  filled.scene.setTransform(filled.objects[5], randomPose(filled.random));
  const VkDeviceSize objectBytes = sizeof(gpu::ObjectRecord) + sizeof(gpu::Placement);
  const VkDeviceSize treeBytes = filled.scene.impl().objectTree().nodes().size() * sizeof(gpu::ObjectNode);
  CHECK(filled.staged() > objectBytes);
  CHECK(filled.staged() <= objectBytes + treeBytes);
  filled.copy.sync(filled.scene.impl());
  CHECK(filled.staged() == 0);
  // A new mesh stages itself and the records of all meshes, unless the buffers grow.
  const auto adds = [&] {
    const Mesh& mesh = filled.scene.impl().meshes[addSoup(filled.scene, filled.random, 1)];
    const VkDeviceSize own = mesh.vertexCount() * sizeof(gpu::Vertex) + mesh.triangleCount() * sizeof(gpu::Triangle) +
                             mesh.tree.nodes.size() * sizeof(gpu::MeshNode);
    const VkDeviceSize records = filled.scene.meshLimit() * sizeof(gpu::MeshRecord);
    const VkDeviceSize staged = filled.staged();
    filled.copy.sync(filled.scene.impl());
    return staged == own + records;
  };
  int alone = 0;
  for (int i = 0; i < 20; ++i) alone += adds() ? 1 : 0;
  CHECK(alone >= 16);
}

TEST_CASE("of a large scene in which one object moves, appears or goes, little is staged") {
  Scene scene;
  tools::Random random(12);
  const MeshId mesh = addSoup(scene, random, 3);
  for (int i = 0; i < 20'000; ++i) {
    scene.addObject({mesh, {{1, 0, 0, random.uniform(-900, 900), 0, 1, 0, random.uniform(-900, 900), 0, 0, 1, 0}}});
  }
  GpuScene copy(test::device().impl());
  copy.sync(scene.impl());
  const VkDeviceSize all = scene.impl().objectTree().nodes().size() * sizeof(gpu::ObjectNode);
  const auto check = [&] {
    const VkDeviceSize staged = stagedOf(copy, scene);
    CHECK(staged > 0);
    CHECK(staged < all / 8);
    copy.sync(scene.impl());
  };
  for (int i = 0; i < 5; ++i) {
    scene.setTransform(random.below(20'000), {{1, 0, 0, 3.0 * i, 0, 1, 0, -7, 0, 0, 1, 0}});
    check();
    scene.addObject({mesh, {{1, 0, 0, 3, 0, 1, 0, -8.0 * i, 0, 0, 1, 0}}});
    check();
    scene.removeObject(17 + static_cast<ObjectId>(i));
    check();
  }
  checkTree(copy, scene);
}

TEST_CASE("data that has not been uploaded is staged again") {
  FilledScene filled(5);
  const VkDeviceSize all = filled.staged();
  CHECK(filled.staged() == all);
  filled.copy.sync(filled.scene.impl());
  filled.scene.setTransform(2, randomPose(filled.random));
  const VkDeviceSize one = filled.staged();
  CHECK(one > 0);
  CHECK(filled.staged() == one);  // as after a failed submission
  gpu::Upload upload(test::device().impl());
  GpuScene::Staged late = filled.copy.stage(filled.scene.impl(), {}, upload);
  filled.copy.forget();
  filled.copy.commit(std::move(late));
  CHECK(filled.staged() == all);
  filled.copy.sync(filled.scene.impl());
  checkCopy(filled.copy, filled.scene);
}

TEST_CASE("a scene that is move-assigned to another is uploaded completely") {
  FilledScene filled(6), other(7);
  filled.copy.sync(filled.scene.impl());
  filled.scene = std::move(other.scene);
  filled.copy.sync(filled.scene.impl());
  checkCopy(filled.copy, filled.scene);
}

TEST_CASE("data that a host has overwritten is staged again when the host stops overwriting it") {
  FilledScene filled(8);
  const auto sync = [&](const GpuScene::Overwritten& next) {
    gpu::Upload upload(test::device().impl());
    filled.copy.commit(filled.copy.stage(filled.scene.impl(), next, upload));
    return upload.bytes();
  };
  sync({});
  const auto moved = [](std::vector<ObjectId> objects, std::vector<uint32_t> nodes,
                        std::vector<ObjectId> standing = {}) {
    return std::make_shared<const GpuScene::Moved>(
        GpuScene::Moved{.objects = std::move(objects), .standing = std::move(standing), .nodes = std::move(nodes)});
  };
  CHECK(sync({.meshes = {1}, .moved = moved({2, 7}, {0, 3})}) == 0);
  CHECK(sync({.meshes = {1}, .moved = moved({2, 7}, {0, 3})}) == 0);
  const VkDeviceSize objectBytes = sizeof(gpu::ObjectRecord) + sizeof(gpu::Placement);
  CHECK(sync({.meshes = {1}, .moved = moved({2}, {0, 3})}) == objectBytes);
  const size_t nodes = filled.scene.impl().objectTree().nodes().size();
  const VkDeviceSize nodeBytes = sizeof(gpu::ObjectNode) * std::min<size_t>(nodes, ChangedPages::kPage);
  CHECK(sync({.meshes = {1}, .moved = moved({2}, {0})}) == nodeBytes);
  // An object that stands instead of being moved has its own pose again.
  CHECK(sync({.meshes = {1}, .moved = moved({}, {0}, {2, 5})}) == objectBytes);
  CHECK(sync({.meshes = {1}, .moved = moved({2}, {0}, {5})}) == objectBytes);
  const Mesh& mesh = filled.scene.impl().meshes[1];
  const VkDeviceSize recordBytes = filled.scene.impl().meshes.size() * sizeof(gpu::MeshRecord);
  CHECK(sync({}) == 2 * objectBytes + nodeBytes + recordBytes + mesh.vertexCount() * sizeof(gpu::Vertex) +
                        mesh.triangleCount() * sizeof(gpu::Triangle) + mesh.tree.nodes.size() * sizeof(gpu::MeshNode));
  CHECK(sync({}) == 0);
}

TEST_CASE("after needIndices, indices for drawing are uploaded in the order of the triangles") {
  FilledScene filled(9);
  filled.copy.sync(filled.scene.impl());
  filled.copy.needIndices();
  for (int round = 0; round < 2; ++round) {
    filled.copy.sync(filled.scene.impl());
    for (const MeshId id : filled.meshes) {
      const gpu::MeshRecord& record = filled.copy.record(id);
      const uint32_t count = filled.scene.mesh(id).triangleCount();
      const std::vector<uint32_t> indices =
          elementsOf(filled.copy.buffers().indices, 3 * size_t{record.firstTriangle}, 3 * size_t{count});
      const std::vector<gpu::Triangle> triangles =
          elementsOf(filled.copy.buffers().triangles, record.firstTriangle, count);
      for (size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] != triangles[i / 3].corners[i % 3]) FAIL("index " << i << " of mesh " << id);
      }
    }
    filled.meshes.push_back(addSoup(filled.scene, filled.random, 11));
  }
}

TEST_CASE("a scene without objects or without meshes can be copied") {
  GpuScene copy(test::device().impl());
  Scene scene;
  copy.sync(scene.impl());
  checkCopy(copy, scene);
  tools::Random random(2);
  addSoup(scene, random, 5);
  copy.sync(scene.impl());
  checkCopy(copy, scene);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a scene beyond the device's largest buffer, or its largest index, is refused, and the limit is named") {
  Device::Impl& impl = test::device().impl();
  const std::shared_ptr<void> restore(nullptr,
                                      [&, limits = impl.properties.limits, bytes = impl.maxBufferBytes](void*) {
                                        impl.properties.limits = limits;
                                        impl.maxBufferBytes = bytes;
                                      });
  GpuScene copy(impl);
  Scene scene;
  tools::Random random(3);
  for (int i = 0; i < 3; ++i) addSoup(scene, random, 40);
  copy.sync(scene.impl());
  impl.properties.limits.maxDrawIndexedIndexValue = 3 * 120 - 2;
  copy.needIndices();
  CHECK_THROWS_WITH(copy.sync(scene.impl()), test::Contains("vertices beyond number 358, the device's maxDraw"));
  ++impl.properties.limits.maxDrawIndexedIndexValue;
  copy.sync(scene.impl());
  checkCopy(copy, scene);
  impl.maxBufferBytes = copy.buffers().vertices.bytes();
  for (int i = 0; i < 3; ++i) addSoup(scene, random, 40);
  impl.properties.limits.maxDrawIndexedIndexValue = 1u << 24;
  CHECK_THROWS_WITH(copy.sync(scene.impl()),
                    test::StartsWith("vertices: ") && test::Contains("the device's maxBufferSize"));
  impl.maxBufferBytes = 1u << 30;
  copy.sync(scene.impl());
  checkCopy(copy, scene);
}
