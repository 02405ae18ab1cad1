// The bounds that a host guarantees for meshes that it deforms and objects that it moves, the answers when they are
// violated, and the cost of such frames.
#include <cmath>
#include <cstring>

#include <vulkan/vulkan.h>

#include "embed/checks.h"
#include "embed/host_barrier.h"
#include "embed/host_world.h"
#include "embed/quiet_frames.h"
#include "gpu/kernel.h"
#include "spirv/skin_comp.h"
#include "support/bindings.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using namespace test;

/// A wall at z = 5 that a host may deform and move, and a sensor that moves towards it.
struct Wall {
  Wall() {
    scene.setBounds(wall, {{-4, -4, 0}, {4, 4, 10}});
    queries[1].worldFromMesh = at(100, 0, 0);
  }
  Scene scene;
  MeshId sensor = test::addMesh(scene, test::triangle()),
         mesh = test::addMesh(scene, test::triangle(), Bounds{{-2, -2, -2}, {2, 2, 2}});
  ObjectId wall = scene.addObject({.mesh = mesh, .worldFromMesh = at(0, 0, 5)}),
           far = scene.addObject({.mesh = sensor, .worldFromMesh = at(50, 0, 5)});
  std::vector<Query> queries = std::vector<Query>(2, {.mesh = sensor, .direction = {0, 0, 1}, .distance = 20});
};

/// `to` with another number.
template <class Numbers>
Numbers with(Numbers numbers, size_t i, double value) {
  numbers[i] = static_cast<typename Numbers::value_type>(value);
  return numbers;
}
Transform with(Transform pose, size_t i, double value) {
  pose.m[i] = value;
  return pose;
}

}  // namespace

TEST_CASE("every answer is invalid with Flag::bounds while any geometry is outside its bounds") {
  Wall wall;
  Recorder recorder(test::device(), wall.scene);
  const std::vector<float> inside = test::triangle(1).positions;
  const auto check = [&](const std::vector<float>& vertices, const Transform& pose, const std::string& violation) {
    HostFrame frame;
    const std::vector<Result> read =
        execute(recorder, wall.queries, frame.deform(wall.mesh, vertices).move(wall.wall, pose).geometry());
    CHECK(recorder.boundsViolation() == violation);
    if (violation.empty()) {
      CHECK(read[0].t == Approx(8));
      CHECK(read[0].flags == 0);
      CHECK(read[1].status == Status::clear);
    } else {
      for (const Result& result : read) CHECK(isRefused(result, Flag::bounds));
    }
  };
  const auto outside = [](int vertex) {
    return "mesh 1: vertex " + std::to_string(vertex) + " is outside its bounds or not finite";
  };
  const std::string away = "object 0: its mesh's box is outside its bounds, or its transform is not finite";
  check(inside, at(0, 0, 7), "");
  check(with(inside, 5, 2.001), at(0, 0, 7), outside(1));
  check(with(inside, 7, -INFINITY), at(0, 0, 7), outside(2));
  check(with(inside, 4, NAN), at(0, 0, 7), outside(1));
  check(with(inside, 7, 3e38), at(0, 0, 7), outside(2));
  check(inside, at(0, 0, 7), "");
  check(inside, at(0, 0, 9), away);
  check(inside, with(at(0, 0, 7), 5, 3e38), away);
  check(inside, with(at(0, 0, 7), 10, NAN), away);
  check(inside, at(0, 0, 7), "");
}

TEST_CASE(
    "geometry that floats cannot represent gives Flag::range or Flag::bounds, and only to the queries concerned") {
  Scene scene;
  const MeshId mesh = test::addMesh(scene, test::triangle());
  const ObjectId object = scene.addObject({.mesh = mesh, .worldFromMesh = at(0, 0, 5)});
  scene.addObject({.mesh = mesh, .worldFromMesh = at(30, 0, 5)});
  scene.setBounds(object, {{-2, -2, 3}, {2, 2, 7}});
  std::vector<Query> queries(3, {.mesh = mesh, .direction = {0, 0, 1}, .distance = 20});
  queries[0].distance = 1e38;
  queries[1].worldFromMesh = at(30, 0, 0);
  queries[2].worldFromMesh = at(0, 0, -1e25);
  Recorder recorder(test::device(), scene, kRoom);
  const auto sweep = [&](const Transform& pose) {
    return execute(recorder, queries, HostFrame().move(object, pose).geometry());
  };
  const auto checkHit = [](const Result& result, double t) {
    CHECK(result.status == Status::hit);
    CHECK(result.flags == 0);
    CHECK(result.t == Approx(t));
  };
  std::vector<Result> read = sweep(at(0, 0, 4));
  checkHit(read[0], 4);
  checkHit(read[1], 5);
  CHECK(isRefused(read[2], Flag::range));
  // A flat mesh does not use the third column, but the squares of its values overflow.
  read = sweep({{1, 0, 3e38, 0, 0, 1, 3e38, 0, 0, 0, 3e38, 4}});
  CHECK(isRefused(read[0], Flag::range));
  checkHit(read[1], 5);
  for (const Result& result : sweep({{3e38, -3e38, 0, 0, 3e38, -3e38, 0, 0, 0, 0, 1, 0}})) {
    CHECK(isRefused(result, Flag::bounds));
  }
  // If one object is too far away for the tree over objects, every query is invalid.
  scene.setTransform(object, at(0, 0, 1e25));
  for (const Result& result : execute(recorder, queries)) CHECK(isRefused(result, Flag::range));
}

TEST_CASE("a mesh flattened to a plane or a line is hit, and one flattened to a point gives Flag::range") {
  Scene scene;
  const MeshId cube = test::addBox(scene, 2);
  const ObjectId object = scene.addObject({.mesh = cube, .worldFromMesh = at(0, 0, 9)});
  scene.setBounds(object, {{-3, -3, 3}, {3, 3, 12}});
  const Query query{.mesh = cube, .direction = {0, 0, 1}, .distance = 20};
  Recorder recorder(test::device(), scene);
  const auto sweep = [&](double x, double y, double z) {
    const Transform pose{{x, 0, 0, 0.25, 0, y, 0, 0.25, 0, 0, z, 8}};
    return execute(recorder, {&query, 1}, HostFrame().move(object, pose).geometry())[0];
  };
  for (const auto& [x, y, z, t] : {std::array{1, 1, 1, 6}, std::array{1, 1, 0, 7}, std::array{1, 0, 0, 7}}) {
    CHECK(sweep(x, y, z).status == Status::hit);
    CHECK(sweep(x, y, z).t == t);
  }
  // A size of 0 is out of range.
  for (const double scale : {0.0, 1e-30}) CHECK(isRefused(sweep(scale, scale, scale), Flag::range));
}

TEST_CASE("geometry that a recording no longer names is the scene's own again") {
  Wall wall;
  Recorder recorder(test::device(), wall.scene);
  HostFrame deforming, moving, both;
  for (HostFrame* frame : {&deforming, &both}) frame->deform(wall.mesh, test::triangle(1).positions);
  for (HostFrame* frame : {&moving, &both}) frame->move(wall.wall, at(0, 0, 7));
  const HostGeometry deformed = deforming.geometry(), moved = moving.geometry();
  const auto sweep = [&](const HostGeometry& geometry) { return execute(recorder, wall.queries, geometry)[0].t; };
  CHECK(sweep({}) == Approx(5));
  CHECK(sweep(both.geometry()) == Approx(8));
  CHECK(sweep(deformed) == Approx(6));
  CHECK(sweep(moved) == Approx(7));
  CHECK(sweep({}) == Approx(5));
  // Recordings that never execute have no effect.
  gpu::Submission submission(test::device().impl(), false);
  recorder.record(submission.begin(), wall.queries, moved);
  recorder.reset();
  CHECK(sweep({}) == Approx(5));
  recorder.record(submission.begin(), wall.queries);
  recorder.reset();
  CHECK(sweep(moved) == Approx(7));
  // Changes of the scene apply, too.
  wall.scene.setTransform(wall.wall, at(0, 0, 4));
  CHECK(sweep(deformed) == Approx(5));
  wall.scene.removeObject(wall.wall);
  CHECK(sweep({}) == INFINITY);
}

TEST_CASE("a scene without objects can be recorded, also with a deformed mesh") {
  Scene empty;
  const MeshId mesh = test::addMesh(empty, test::triangle(), Bounds{{-1, -1, 0}, {1, 1, 0}});
  Recorder recorder(test::device(), empty);
  HostFrame frame;
  const HostGeometry geometry = frame.deform(mesh, test::triangle().positions).geometry();
  const Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 20};
  CHECK(execute(recorder, {&query, 1}, geometry)[0].status == Status::clear);
  CHECK(execute(recorder, std::span<const Query>(), geometry).empty());
  CHECK(execute(recorder, {&query, 1})[0].status == Status::clear);
}

TEST_CASE("a host that writes geometry in the same command buffer without the documented barrier causes a hazard") {
  Wall wall;
  Recorder recorder(test::device(), wall.scene);
  const float vertices[] = {-1, -1, 1, 1, -1, 1, 0, 1, 1}, transform[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 7};
  const test::OnDevice buffer(std::vector<std::byte>(sizeof(vertices) + sizeof(transform)));
  const DeformedMesh deformed{wall.mesh, {.buffer = buffer.get()}};
  const MovedObjects moved{.transforms = buffer.get(), .first = sizeof(vertices), .objects = {&wall.wall, 1}};
  gpu::Submission submission(test::device().impl(), false);
  for (const bool withBarrier : {true, false, true}) {
    const gpu::Commands commands = submission.begin();
    vkCmdUpdateBuffer(commands, buffer.get(), 0, sizeof(vertices), vertices);
    vkCmdUpdateBuffer(commands, buffer.get(), sizeof(vertices), sizeof(transform), transform);
    const Access updates{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
    if (withBarrier) test::barrier(commands, updates, Recorder::kReads);
    recorder.record(commands, wall.queries, {.meshes = {&deformed, 1}, .objects = {&moved, 1}});
    submission.submitAndWait();
    CHECK(recorder.read().results[0].t == Approx(8));
    test::checkHazard(!withBarrier);
  }
}

namespace {

/// Frames in which a host's shader skins a character and moves crates.
struct SkinningFrames {
  SkinningFrames(const Device& engine, const Device& hosts)
      : atRest(hosts.impl(), "at rest", gpu::BufferDomain::upload, kWritten),
        skinned(hosts.impl(), "skinned", gpu::BufferDomain::device, kWritten),
        transforms(hosts.impl(), "transforms", gpu::BufferDomain::device, kWritten),
        bindings(hosts.impl(), 3, sizeof(float)),
        skin(gpu::computePipeline(hosts.impl(), bindings.layout(), k_skin_comp, "skin")),
        submission(hosts.impl(), false) {
    // At rest: three vertices of 8 floats each, then 20 transforms that translate by 10 along x.
    std::vector<float> rest(24);
    for (size_t i = 0; i < 9; ++i) rest[8 * (i / 3) + i % 3] = test::triangle().positions[i];
    for (int i = 0; i < 20; ++i) rest.insert(rest.end(), {1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 0});
    atRest.reserve(gpu::bytesOf(rest));
    skinned.reserve(24 * sizeof(float));
    transforms.reserve(240 * sizeof(float));
    std::memcpy(atRest.mapped(), rest.data(), gpu::bytesOf(rest));
    const gpu::Buffer* all[] = {&atRest, &skinned, &transforms};
    for (uint32_t i = 0; i < 3; ++i) bindings.setBuffer(i, all[i]->get());

    const MeshId crate = test::addMesh(scene, test::triangle());
    const HostMesh restPose{.positions = {.buffer = atRest.get(), .stride = 32}, .vertexCount = 3};
    body = {radar::addMesh(scene, engine, restPose), {.buffer = skinned.get(), .stride = 32}};
    scene.addObject({.mesh = body.mesh});
    crates = {.transforms = transforms.get(), .firstObject = scene.objectLimit(), .count = 20};
    for (int i = 0; i < 20; ++i) scene.addObject({.mesh = crate});
    for (const double x : {0, 10}) {
      queries.push_back({.mesh = crate, .worldFromMesh = at(x, 0, -3), .direction = {0, 0, 1}, .distance = 20});
    }
    recorder.emplace(engine, scene);
  }
  void operator()(uint32_t frame) {
    const float lift = static_cast<float>(frame) / 64;
    const gpu::Commands commands = submission.begin();
    bindings.bind(commands);
    commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, skin.get());
    commands->CmdPushConstants(commands, bindings.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(lift), &lift);
    commands->CmdDispatch(commands, 5, 1, 1);
    test::barrier(commands, Recorder::kWrites, Recorder::kReads);
    recorder->record(commands, queries, {.meshes = {&body, 1}, .objects = {&crates, 1}});
    submission.submitAndWait();
    for (const Result& result : recorder->read().results) CHECK(result.t == 3 + double{lift});
  }
  static constexpr VkBufferUsageFlags kWritten = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | kHostBufferUsage;
  gpu::Buffer atRest, skinned, transforms;
  test::Bindings bindings;
  gpu::Pipeline skin;
  gpu::Submission submission;
  Scene scene;
  DeformedMesh body;
  MovedObjects crates;
  std::vector<Query> queries;
  std::optional<Recorder> recorder;
};

}  // namespace

TEST_CASE(
    "recording frames in which a host skins and moves on the device allocates nothing, submits nothing and waits for "
    "nothing") {
  test::checkQuiet<SkinningFrames>(100, 4);
}
