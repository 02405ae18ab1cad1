// The bounds that a host guarantees for meshes that it deforms and objects that it moves, the answers when they are
// violated, and the cost of such frames.
#include <cmath>
#include <cstring>

#include <vulkan/vulkan.h>

#include "embed/host.h"
#include "embed/on_device.h"
#include "gpu/kernel.h"
#include "radar/recorder.h"
#include "spirv/skin_comp.h"
#include "support/bindings.h"
#include "support/catch.h"
#include "workloads/shapes.h"

struct Moving {
  radar::MeshId body;
  VkBuffer skinned, transforms;
  std::vector<radar::ObjectId> crates;
};
void addMoving(radar::Scene& scene, const radar::Device& device, const radar::HostMesh& restPose, radar::MeshId crate,
               Moving& moving);
void recordMoving(VkCommandBuffer commands, radar::Recorder& recorder, std::span<const radar::Query> queries,
                  const Moving& moving);

namespace {

using namespace radar;
using test::execute;
using test::kRoom;
using test::OnDevice;

/// A wall at z = 5 that a host may deform and move, and a sensor that moves towards it.
struct Wall {
  Wall() {
    const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    const uint32_t triangle[] = {0, 1, 2};
    sensor = scene.addMesh(corners, triangle);
    mesh = scene.addMesh(corners, triangle, Bounds{{-2, -2, -2}, {2, 2, 2}});
    wall = scene.addObject({.mesh = mesh, .worldFromMesh = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5}}});
    scene.setBounds(wall, {{-4, -4, 0}, {4, 4, 10}});
    far = scene.addObject({.mesh = sensor, .worldFromMesh = {{1, 0, 0, 50, 0, 1, 0, 0, 0, 0, 1, 5}}});
    queries = {{.mesh = sensor, .direction = {0, 0, 1}, .distance = 20},
               {.mesh = sensor,
                .worldFromMesh = {{1, 0, 0, 100, 0, 1, 0, 0, 0, 0, 1, 0}},
                .direction = {0, 0, 1},
                .distance = 20}};
  }
  Scene scene;
  MeshId sensor, mesh;
  ObjectId wall, far;
  std::vector<Query> queries;
};

std::vector<std::byte> floats(std::initializer_list<float> values) {
  std::vector<std::byte> bytes;
  test::append<float>(bytes, values);
  return bytes;
}

}  // namespace

TEST_CASE("every answer is invalid with Flag::bounds while any geometry is outside its bounds") {
  Wall wall;
  Recorder recorder(test::device(), wall.scene);
  const OnDevice inside(floats({-1, -1, 1, 1, -1, 1, 0, 1, 1})), beyond(floats({-1, -1, 1, 1, -1, 2.001f, 0, 1, 1})),
      infinite(floats({-1, -1, 1, 1, -1, 1, 0, -INFINITY, 1})), vast(floats({-1, -1, 1, 1, -1, 1, 0, 3e38f, 1})),
      none(floats({-1, -1, 1, 1, NAN, 1, 0, 1, 1}));
  const OnDevice at(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 7})), away(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 9})),
      huge(floats({1, 0, 0, 0, 0, 3e38f, 0, 0, 0, 0, 1, 7})), lost(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, NAN, 7}));
  const auto sweep = [&](const OnDevice& vertices, const OnDevice& transform) {
    const DeformedMesh deformed{wall.mesh, {.buffer = vertices.get()}};
    const MovedObjects moved{.transforms = transform.get(), .objects = {&wall.wall, 1}};
    return execute(recorder, wall.queries, {.meshes = {&deformed, 1}, .objects = {&moved, 1}});
  };
  const auto expectRefused = [&](const std::vector<Result>& results) {
    for (const Result& result : results) {
      CHECK(result.status == Status::invalid);
      CHECK(result.flags == Flag::bounds);
      CHECK(std::isnan(result.lo));
    }
  };
  const auto expectHitAndClear = [&](const std::vector<Result>& results) {
    CHECK(results[0].status == Status::hit);
    CHECK(results[0].t == Approx(8));
    CHECK(results[0].flags == 0);
    CHECK(results[1].status == Status::clear);
  };
  expectHitAndClear(sweep(inside, at));
  CHECK(recorder.boundsViolation().empty());
  expectRefused(sweep(beyond, at));
  CHECK(recorder.boundsViolation() == "mesh 1: vertex 1 is outside its bounds or not finite");
  expectRefused(sweep(infinite, at));
  expectRefused(sweep(none, at));
  expectRefused(sweep(vast, at));
  expectHitAndClear(sweep(inside, at));
  CHECK(recorder.boundsViolation().empty());
  expectRefused(sweep(inside, away));
  CHECK(recorder.boundsViolation() == "object 0: its mesh's box is outside its bounds, or its transform is not finite");
  expectRefused(sweep(inside, huge));
  expectRefused(sweep(inside, lost));
  expectHitAndClear(sweep(inside, at));
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE(
    "geometry that floats cannot represent gives Flag::range or Flag::bounds, and only to the queries concerned") {
  Scene scene;
  const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const uint32_t triangle[] = {0, 1, 2};
  const MeshId mesh = scene.addMesh(corners, triangle);
  const ObjectId object = scene.addObject({.mesh = mesh, .worldFromMesh = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5}}});
  scene.addObject({.mesh = mesh, .worldFromMesh = {{1, 0, 0, 30, 0, 1, 0, 0, 0, 0, 1, 5}}});
  scene.setBounds(object, {{-2, -2, 3}, {2, 2, 7}});
  std::vector<Query> queries{{.mesh = mesh, .direction = {0, 0, 1}, .distance = 1e38},
                             {.mesh = mesh, .direction = {0, 0, 1}, .distance = 20},
                             {.mesh = mesh, .direction = {0, 0, 1}, .distance = 20}};
  queries[1].worldFromMesh.m[3] = 30;
  queries[2].worldFromMesh.m[11] = -1e25;
  Recorder recorder(test::device(), scene, kRoom);
  // A flat mesh does not use the third column, but the squares of its values overflow.
  const OnDevice usual(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4})),
      huge(floats({1, 0, 3e38f, 0, 0, 1, 3e38f, 0, 0, 0, 3e38f, 4})),
      none(floats({3e38f, -3e38f, 0, 0, 3e38f, -3e38f, 0, 0, 0, 0, 1, 0}));
  const auto sweep = [&](const OnDevice& transform) {
    const MovedObjects moved{.transforms = transform.get(), .objects = {&object, 1}};
    return execute(recorder, queries, {.objects = {&moved, 1}});
  };
  const auto expectHit = [](const Result& result, double t) {
    CHECK(result.status == Status::hit);
    CHECK(result.flags == 0);
    CHECK(result.t == Approx(t));
  };
  const auto expectRefused = [](const Result& result, uint32_t flag) {
    CHECK(result.status == Status::invalid);
    CHECK(result.flags == flag);
    CHECK(std::isnan(result.lo));
  };
  std::vector<Result> read = sweep(usual);
  expectHit(read[0], 4);
  expectHit(read[1], 5);
  expectRefused(read[2], Flag::range);
  read = sweep(huge);
  expectRefused(read[0], Flag::range);
  expectHit(read[1], 5);
  read = sweep(none);
  for (const Result& result : read) expectRefused(result, Flag::bounds);
  // If one object is too far away for the tree over objects, every query is invalid.
  scene.setTransform(object, {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1e25}});
  for (const Result& result : execute(recorder, queries)) expectRefused(result, Flag::range);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a mesh flattened to a plane or a line is hit, and one flattened to a point gives Flag::range") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({2, 2, 2});
  const MeshId cube = scene.addMesh(box.positions, box.indices);
  const ObjectId object = scene.addObject({.mesh = cube, .worldFromMesh = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 9}}});
  scene.setBounds(object, {{-3, -3, 3}, {3, 3, 12}});
  Query query{.mesh = cube, .direction = {0, 0, 1}, .distance = 20};
  Recorder recorder(test::device(), scene);
  const auto sweep = [&](std::initializer_list<float> rows) {
    const OnDevice transform(floats(rows));
    const MovedObjects moved{.transforms = transform.get(), .objects = {&object, 1}};
    return execute(recorder, {&query, 1}, {.objects = {&moved, 1}})[0];
  };
  const Result whole = sweep({1, 0, 0, 0.25f, 0, 1, 0, 0.25f, 0, 0, 1, 8}),
               flat = sweep({1, 0, 0, 0.25f, 0, 1, 0, 0.25f, 0, 0, 0, 8}),
               line = sweep({1, 0, 0, 0.25f, 0, 0, 0, 0.25f, 0, 0, 0, 8}),
               point = sweep({0, 0, 0, 0.25f, 0, 0, 0, 0.25f, 0, 0, 0, 8});
  CHECK(whole.status == Status::hit);
  CHECK(whole.t == 6);
  CHECK(flat.status == Status::hit);
  CHECK(flat.t == 7);
  CHECK(line.status == Status::hit);
  CHECK(line.t == 7);
  // A size of 0 is out of range.
  CHECK(point.status == Status::invalid);
  CHECK(point.flags == Flag::range);
  const Result tiny = sweep({1e-30f, 0, 0, 0.25f, 0, 1e-30f, 0, 0.25f, 0, 0, 1e-30f, 8});
  CHECK(tiny.status == Status::invalid);
  CHECK(tiny.flags == Flag::range);
}

TEST_CASE("geometry that a recording no longer names is the scene's own again") {
  Wall wall;
  Recorder recorder(test::device(), wall.scene);
  const OnDevice vertices(floats({-1, -1, 1, 1, -1, 1, 0, 1, 1})),
      transform(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 7}));
  const DeformedMesh deformed{wall.mesh, {.buffer = vertices.get()}};
  const MovedObjects moved{.transforms = transform.get(), .objects = {&wall.wall, 1}};
  const auto sweep = [&](const HostGeometry& geometry) { return execute(recorder, wall.queries, geometry)[0].t; };
  CHECK(sweep({}) == Approx(5));
  CHECK(sweep({.meshes = {&deformed, 1}, .objects = {&moved, 1}}) == Approx(8));
  CHECK(sweep({.meshes = {&deformed, 1}}) == Approx(6));
  CHECK(sweep({.objects = {&moved, 1}}) == Approx(7));
  CHECK(sweep({}) == Approx(5));
  // Recordings that never execute have no effect.
  gpu::Submission submission(test::device().impl(), false);
  recorder.record(submission.begin(), wall.queries, {.objects = {&moved, 1}});
  recorder.reset();
  CHECK(sweep({}) == Approx(5));
  recorder.record(submission.begin(), wall.queries);
  recorder.reset();
  CHECK(sweep({.objects = {&moved, 1}}) == Approx(7));
  // Changes of the scene apply, too.
  wall.scene.setTransform(wall.wall, {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4}});
  CHECK(sweep({.meshes = {&deformed, 1}}) == Approx(5));
  wall.scene.removeObject(wall.wall);
  CHECK(sweep({}) == INFINITY);
}

TEST_CASE("each recording deforms exactly the meshes that it names, whichever the previous one named") {
  // Four walls side by side. Each recording deforms two of them sideways, into the way of small sensors.
  const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const uint32_t triangle[] = {0, 1, 2};
  Scene scene;
  for (uint32_t i = 0; i < 4; ++i) {
    const MeshId mesh = scene.addMesh(corners, triangle, Bounds{{-2, -2, -2}, {2, 2, 2}});
    scene.addObject({.mesh = mesh, .worldFromMesh = {{1, 0, 0, 10.0 * i, 0, 1, 0, 0, 0, 0, 1, 5}}});
  }
  const MeshId sensor = scene.addMesh(corners, triangle);
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 4; ++i) {
    queries.push_back({.mesh = sensor,
                       .worldFromMesh = {{0.1, 0, 0, 10.0 * i + 1.6, 0, 0.1, 0, -0.8, 0, 0, 0.1, 0}},
                       .direction = {0, 0, 1},
                       .distance = 20});
  }
  const OnDevice aside(floats({0, -1, 1, 2, -1, 1, 1, 1, 1}));
  Recorder recorder(test::device(), scene);
  std::vector<std::array<MeshId, 2>> pairs;
  for (MeshId p = 0; p < 4; ++p) {
    for (MeshId q = p + 1; q < 4; ++q) pairs.push_back({p, q});
  }
  for (const auto& last : pairs) {
    for (const auto& next : pairs) {
      for (const auto& pair : {last, next}) {
        const HostPositions there{.buffer = aside.get()};
        const DeformedMesh deformed[] = {{pair[0], there}, {pair[1], there}};
        const std::vector<Result> read = execute(recorder, queries, {.meshes = deformed});
        for (uint32_t i = 0; i < 4; ++i) {
          CAPTURE(last[0], last[1], pair[0], pair[1], i);
          CHECK(read[i].status == (i == pair[0] || i == pair[1] ? Status::hit : Status::clear));
        }
      }
    }
  }
}

TEST_CASE("a scene without objects can be recorded, also with a deformed mesh") {
  Scene empty;
  const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const uint32_t triangle[] = {0, 1, 2};
  const MeshId mesh = empty.addMesh(corners, triangle, Bounds{{-1, -1, 0}, {1, 1, 0}});
  Recorder recorder(test::device(), empty);
  const OnDevice vertices(floats({-1, -1, 0, 1, -1, 0, 0, 1, 0}));
  const DeformedMesh deformed{mesh, {.buffer = vertices.get()}};
  const Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 20};
  CHECK(execute(recorder, {&query, 1}, {.meshes = {&deformed, 1}})[0].status == Status::clear);
  CHECK(execute(recorder, {}, {.meshes = {&deformed, 1}}).empty());
  CHECK(execute(recorder, {&query, 1})[0].status == Status::clear);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("the recorder refuses bad geometry, names what is wrong and stays usable") {
  Wall wall;
  Recorder recorder(test::device(), wall.scene);
  const OnDevice buffer(floats({-1, -1, 1, 1, -1, 1, 0, 1, 1, 0, 0, 0}));
  gpu::Submission submission(test::device().impl(), false);
  const gpu::Commands commands = submission.begin();
  const auto refused = [&](const HostGeometry& geometry, const char* why) {
    CHECK_THROWS_WITH(recorder.record(commands, wall.queries, geometry), test::Contains(why));
  };
  const auto mesh = [&](DeformedMesh deformed, const char* why) { refused({.meshes = {&deformed, 1}}, why); };
  mesh({7, {.buffer = buffer.get()}}, "record: geometry: mesh 7 does not exist");
  mesh({wall.mesh, {}}, "mesh 1: expected a buffer of positions");
  mesh({wall.mesh, {.buffer = buffer.get(), .stride = 11}}, "mesh 1: stride: expected at least 12 bytes, got 11");
  mesh({wall.mesh, {.buffer = buffer.get(), .format = VK_FORMAT_R8_UNORM}}, "mesh 1: format: expected");
  const DeformedMesh good{wall.mesh, {.buffer = buffer.get()}}, twice[] = {good, good};
  refused({.meshes = twice}, "meshes: expected each at most once");
  const auto objects = [&](MovedObjects moved, const char* why) { refused({.objects = {&moved, 1}}, why); };
  const ObjectId missing = 9, same[] = {wall.wall, wall.wall};
  objects({.transforms = buffer.get(), .objects = {&missing, 1}}, "object 9 does not exist");
  objects({.transforms = buffer.get(), .objects = same}, "objects: expected each at most once");
  objects({.transforms = buffer.get(), .stride = 44, .objects = {&wall.wall, 1}}, "at least 48 bytes, got 44");
  objects({.objects = {&wall.wall, 1}}, "expected a buffer of transforms");
  for (const VkDeviceSize stride : {VkDeviceSize{1} << 40, VkDeviceSize{1} << 63, ~VkDeviceSize{0}}) {
    mesh({wall.mesh, {.buffer = buffer.get(), .stride = stride}}, "bytes of the device's maxStorageBufferRange");
    const ObjectId both[] = {wall.wall, wall.far};
    objects({.transforms = buffer.get(), .stride = stride, .objects = both},
            "bytes of the device's maxStorageBufferRange");
  }

  const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const uint32_t triangle[] = {0, 1, 2};
  CHECK_THROWS_WITH(wall.scene.addMesh(corners, triangle, Bounds{{0, 1, 0}, {1, 0, 1}}),
                    test::Contains("addMesh: bounds: expected lo <= hi"));
  CHECK_THROWS_WITH(wall.scene.setBounds(wall.wall, {{0, 0, 0}, {1, NAN, 1}}), test::Contains("setBounds: bounds"));
  CHECK_THROWS_WITH(wall.scene.setBounds(9, {}), test::Contains("object 9 does not exist"));
  // The recorder still works.
  CHECK(execute(recorder, wall.queries)[0].t == Approx(5));
}

TEST_CASE("a host that writes geometry in the same command buffer without the documented barrier causes a hazard") {
  Wall wall;
  Recorder recorder(test::device(), wall.scene);
  const float vertices[] = {-1, -1, 1, 1, -1, 1, 0, 1, 1}, transform[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 7};
  const OnDevice buffer(std::vector<std::byte>(sizeof(vertices) + sizeof(transform)));
  const DeformedMesh deformed{wall.mesh, {.buffer = buffer.get()}};
  const MovedObjects moved{.transforms = buffer.get(), .first = sizeof(vertices), .objects = {&wall.wall, 1}};
  gpu::Submission submission(test::device().impl(), false);
  for (const bool withBarrier : {true, false, true}) {
    const gpu::Commands commands = submission.begin();
    vkCmdUpdateBuffer(commands, buffer.get(), 0, sizeof(vertices), vertices);
    vkCmdUpdateBuffer(commands, buffer.get(), sizeof(vertices), sizeof(transform), transform);
    const VkMemoryBarrier2 writtenToCopy{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                         .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                         .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                         .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                         .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT};
    const VkDependencyInfo info{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &writtenToCopy};
    if (withBarrier) commands->CmdPipelineBarrier2(commands, &info);
    recorder.record(commands, wall.queries, {.meshes = {&deformed, 1}, .objects = {&moved, 1}});
    submission.submitAndWait();
    CHECK(recorder.read().results[0].t == Approx(8));
    const std::vector<std::string> messages = test::takeValidationMessages();
    CHECK(messages.empty() == withBarrier);
    if (!messages.empty()) CHECK(messages[0].find("SYNC-HAZARD-READ-AFTER-WRITE") != std::string::npos);
  }
}

TEST_CASE(
    "recording frames in which a host skins and moves on the device allocates nothing, submits nothing and waits for "
    "nothing") {
  test::Host host;
  const Device hosts = Device::adopt(host.handles);
  host.handles.getInstanceProcAddr = test::countingLoader();
  host.handles.allocator = test::countingAllocator();
  test::resetCounts();
  {
    const Device device = Device::adopt(host.handles);
    const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    const uint32_t triangle[] = {0, 1, 2};
    // At rest: three vertices of 8 floats each, then 20 transforms that translate by 10 along x.
    std::vector<float> rest(24);
    for (size_t i = 0; i < 9; ++i) rest[8 * (i / 3) + i % 3] = corners[i];
    for (int i = 0; i < 20; ++i) rest.insert(rest.end(), {1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 0});
    gpu::Buffer atRest(hosts.impl(), "at rest", gpu::BufferDomain::upload,
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    constexpr VkBufferUsageFlags kWritten = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    gpu::Buffer skinned(hosts.impl(), "skinned", gpu::BufferDomain::device, kWritten),
        transforms(hosts.impl(), "transforms", gpu::BufferDomain::device, kWritten);
    atRest.reserve(gpu::bytesOf(rest));
    skinned.reserve(24 * sizeof(float));
    transforms.reserve(240 * sizeof(float));
    std::memcpy(atRest.mapped(), rest.data(), gpu::bytesOf(rest));

    Scene scene;
    const MeshId crate = scene.addMesh(corners, triangle);
    Moving moving{.body = kNone, .skinned = skinned.get(), .transforms = transforms.get(), .crates = {}};
    addMoving(scene, device, {.positions = {.buffer = atRest.get(), .stride = 32}, .vertexCount = 3}, crate, moving);
    std::vector<Query> queries(2, {.mesh = crate, .direction = {0, 0, 1}, .distance = 20});
    for (Query& query : queries) query.worldFromMesh.m[11] = -3;
    queries[1].worldFromMesh.m[3] = 10;

    test::Bindings bindings(hosts.impl(), 3, sizeof(float));
    const gpu::Pipeline skin = gpu::computePipeline(hosts.impl(), bindings.layout(), k_skin_comp, "skin");
    bindings.setBuffer(0, atRest.get());
    bindings.setBuffer(1, skinned.get());
    bindings.setBuffer(2, transforms.get());
    Recorder recorder(device, scene);
    gpu::Submission submission(hosts.impl(), false);
    const test::Counts before = test::counts();
    int64_t allocations = 0;
    for (uint32_t frame = 0; frame < 100; ++frame) {
      if (frame == 4) allocations = test::counts().allocations;
      const float lift = static_cast<float>(frame) / 64;
      const gpu::Commands commands = submission.begin();
      bindings.bind(commands);
      commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, skin.get());
      commands->CmdPushConstants(commands, bindings.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(lift), &lift);
      commands->CmdDispatch(commands, 5, 1, 1);
      recordMoving(commands, recorder, queries, moving);
      submission.submitAndWait();
      for (const Result& result : recorder.read().results) CHECK(result.t == 3 + double{lift});
    }
    const test::Counts after = test::counts();
    CHECK(after.allocations == allocations);
    CHECK(after.submissions == before.submissions);
    CHECK(after.waits == before.waits);
  }
  CHECK(test::counts().live == 0);
  CHECK(test::takeValidationMessages().empty());
}
