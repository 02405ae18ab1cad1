// Answers as glTF, loaded again by assimp.
#include "view/gltf.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <map>

#include "radar/cpu_sweeper.h"
#include "radar/displacement.h"
#include "support/catch.h"
#include "workloads/generate.h"
#include "workloads/vectors.h"

namespace {

using namespace radar;
using namespace radar::tools;

std::array<unsigned, 3> outwards(const Transform& pose) {
  return mirrors(pose) ? std::array{0u, 2u, 1u} : std::array{0u, 1u, 2u};
}

struct Loaded {
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  std::map<std::string, const aiNode*> nodes;

  explicit Loaded(const std::string& bytes) {
    scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_ValidateDataStructure, "glb");
    INFO(importer.GetErrorString());
    REQUIRE(scene != nullptr);
    add(scene->mRootNode);
  }
  /// From a node to the node that turns z upwards.
  Transform poseOf(const aiNode* node) const {
    aiMatrix4x4 all;
    for (; std::string(node->mName.C_Str()) != "z up"; node = node->mParent) all = node->mTransformation * all;
    Transform pose;
    for (unsigned i = 0; i < 12; ++i) pose.m[i] = all[i / 4][i % 4];
    return pose;
  }
  /// The corners of a node's triangles, in the world, counterclockwise where glTF says that they are seen from outside.
  std::vector<Vec3> corners(const std::string& name) const {
    const aiNode* node = nodes.at(name);
    const Transform pose = poseOf(node);
    std::vector<Vec3> out;
    const aiMesh* mesh = scene->mMeshes[node->mMeshes[0]];
    for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
      REQUIRE(mesh->mFaces[f].mNumIndices == 3);
      for (const unsigned i : outwards(pose)) {
        const aiVector3D& p = mesh->mVertices[mesh->mFaces[f].mIndices[i]];
        out.push_back(transformPoint(pose, &p.x));
      }
    }
    return out;
  }

 private:
  void add(const aiNode* node) {
    nodes[node->mName.C_Str()] = node;
    for (unsigned i = 0; i < node->mNumChildren; ++i) add(node->mChildren[i]);
  }
};

/// Checks corners of a mesh's triangles, for floats.
void checkPlaced(const std::vector<Vec3>& found, const MeshData& mesh, const Transform& pose) {
  REQUIRE(found.size() == mesh.indices.size());
  double farthest = 10, worst = 0;
  for (const float value : mesh.positions) farthest = std::max(farthest, std::abs(double{value}));
  for (size_t i = 0; i < found.size(); ++i) {
    const uint32_t corner = mesh.indices[i - i % 3 + outwards(pose)[i % 3]];
    worst = std::max(worst, lengthOf(found[i] - transformPoint(pose, &mesh.positions[3 * size_t{corner}])));
  }
  CHECK(worst < 1e-6 * farthest);
}

}  // namespace

TEST_CASE("a glTF file has every object where it is, and every sensor on its way to its contact") {
  Workload workload = makeWorkload(Soups{.objects = 30, .sensors = 40});  // many poses have shear
  workload.scenes[0].motions = {{3, {1, 2, 3}}};
  workload.scenes[0].names.assign(30, "");
  workload.scenes[0].names[4] = "a name";
  Scene scene;
  replaceBy(workload, 0, scene);
  const std::vector<Result> answers = CpuSweeper(scene).run(queriesOf(workload.queries)).results;
  // Where nobody has asked how far it can go, a sensor does not go at all.
  const auto hit = std::ranges::find(answers, Status::hit, &Result::status);
  workload.queries[static_cast<size_t>(hit - answers.begin())].anyHit = true;
  const Loaded loaded(gltfOf(workload, answers, {}).bytes);

  for (uint32_t i = 0; i < 30; ++i) {
    const Instance& instance = workload.instance(0, i);
    const std::string name = "object " + std::to_string(i) + (i == 4 ? " a name" : "");
    CAPTURE(name);
    checkPlaced(loaded.corners(name), workload.meshes[instance.mesh], instance.worldFromMesh);
  }
  REQUIRE(loaded.scene->mNumAnimations == 1);
  const aiAnimation& animation = *loaded.scene->mAnimations[0];
  CHECK(animation.mNumChannels == 41);
  std::map<std::string, const aiNodeAnim*> channels;
  for (unsigned i = 0; i < animation.mNumChannels; ++i) {
    channels[animation.mChannels[i]->mNodeName.C_Str()] = animation.mChannels[i];
  }
  size_t hits = 0;
  for (size_t i = 0; i < workload.queries.size(); ++i) {
    const QuerySpec& query = workload.queries[i];
    CAPTURE(query.id, answers[i].status);
    checkPlaced(loaded.corners(query.id), workload.meshes[query.mesh], query.worldFromMesh);
    const aiNodeAnim& moves = *channels.at("sensor " + query.id);
    const aiVectorKey& last = moves.mPositionKeys[moves.mNumPositionKeys - 1];
    const bool isHit = answers[i].status == Status::hit && !query.anyHit;
    const double gone = isHit ? answers[i].t : answers[i].status == Status::clear ? query.distance : 0;
    hits += isHit;
    const Vec3 end{last.mValue.x, last.mValue.y, last.mValue.z};
    CHECK(lengthOf(end - (gone / query.distance) * displacementOf(query)) < 1e-5);
    CHECK(last.mTime / animation.mTicksPerSecond == Approx(3 * gone / query.distance).margin(1e-3));
  }
  CHECK(hits > 5);
  const aiVectorKey& moved = channels.at("object 3 moves")->mPositionKeys[1];
  CHECK(lengthOf(Vec3{moved.mValue.x, moved.mValue.y, moved.mValue.z} - Vec3{1, 2, 3}) < 1e-6);
}

TEST_CASE("a sensor that turns in a glTF file is at each key where the turn takes it") {
  Workload workload = makeWorkload(Soups{.objects = 1, .sensors = 3});
  const std::array<Turn, 3> turns{Turn{{0, 0, -2}, 7, {3, -1, 2}}, Turn{{1e-310, 0, 0}, -0.5, {}},
                                  Turn{{}, 0, {1, 2, 3}}};
  for (size_t i = 0; i < 3; ++i) {
    QuerySpec& query = workload.queries[i];
    query.direction = {};
    query.distance = 0;
    query.turn = turns[i];
    if (i != 1) query.motion = Vec3{1, 2, -3};
  }
  std::vector<Result> answers(3, Result(Status::clear));
  answers[0] = Result(Status::hit);
  answers[0].t = 0.75;
  const Loaded loaded(gltfOf(workload, answers, {}).bytes);
  const aiAnimation& animation = *loaded.scene->mAnimations[0];
  CHECK(animation.mNumChannels == 3);
  for (unsigned c = 0; c < animation.mNumChannels; ++c) {
    const aiNodeAnim& moves = *animation.mChannels[c];
    const auto i = static_cast<size_t>(
        std::ranges::find_if(workload.queries,
                             [&](const QuerySpec& query) { return "sensor " + query.id == moves.mNodeName.C_Str(); }) -
        workload.queries.begin());
    const QuerySpec& query = workload.queries[i];
    const double share = i == 0 ? 0.75 : 1, seconds = moves.mPositionKeys[1].mTime / animation.mTicksPerSecond;
    CHECK(seconds == Approx(3 * share));
    checkPlaced(loaded.corners(query.id), workload.meshes[query.mesh], query.worldFromMesh);
    REQUIRE(moves.mNumRotationKeys >= 2);
    CHECK(moves.mRotationKeys[moves.mNumRotationKeys - 1].mTime == moves.mPositionKeys[1].mTime);
    const Vec3 arm{2, 1, -1};  // from the centre
    for (unsigned k = 0; k < moves.mNumRotationKeys; ++k) {
      const aiQuatKey& key = moves.mRotationKeys[k];
      const double s = share * key.mTime / moves.mPositionKeys[1].mTime, by = s * turns[i].angle;
      if (k > 0) CHECK(std::abs(turns[i].angle) * share / (moves.mNumRotationKeys - 1) < 1.1);
      const aiVector3D found = key.mValue.Rotate({float(arm[0]), float(arm[1]), float(arm[2])});
      Vec3 expected = arm;
      if (i == 0) {  // by -z
        expected = {std::cos(by) * arm[0] + std::sin(by) * arm[1], std::cos(by) * arm[1] - std::sin(by) * arm[0],
                    arm[2]};
      } else if (i == 1) {
        expected = {arm[0], std::cos(by) * arm[1] - std::sin(by) * arm[2],
                    std::cos(by) * arm[2] + std::sin(by) * arm[1]};
      }
      CHECK(lengthOf(Vec3{found.x, found.y, found.z} - expected) < 1e-5);
    }
    for (unsigned k = 0; k < 2; ++k) {
      const aiVector3D& place = moves.mPositionKeys[k].mValue;
      const Vec3 expected = turns[i].centre + (k * share) * query.motion.value_or(Vec3{});
      CHECK(lengthOf(Vec3{place.x, place.y, place.z} - expected) < 1e-5);
    }
  }
}

TEST_CASE("a chain in a glTF file has its meshes where its joints take them") {
  Workload workload = makeWorkload(Soups{.objects = 1, .sensors = 1});
  ChainSpec& chain = workload.chains.emplace_back();
  chain.linkNames = {"rail", "arm", "hand"};
  chain.variables = 2;
  const Transform up{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4}}, sheared{{1, 0.5, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3}};
  chain.links = {{.joint = JointType::prismatic, .axis = {0, 1e-310, 0}, .variable = 1},
                 {.parent = 0,
                  .parentFromJoint = up,
                  .joint = JointType::revolute,
                  .axis = {0, 2, 0},
                  .variable = 0,
                  .meshes = {{0, {}}}},
                 {.parent = 1, .parentFromJoint = up, .meshes = {{0, {}}, {0, sheared}}}};
  QuerySpec& query = workload.queries.front();
  query = {};
  query.id = "q";
  query.worldFromMesh.m[3] = 100;
  query.chain = ChainWay{0, {0, 1}, {12, 3}};
  Result answer(Status::hit);
  answer.t = 0.5;
  const Loaded loaded(gltfOf(workload, {&answer, 1}, {}).bytes);
  // As the file has them at rest, all joints are at 0.
  const auto placed = [](const Transform& pose, double z) {
    Transform out = pose;
    out.m[3] += 100;
    out.m[11] += z;
    return out;
  };
  checkPlaced(loaded.corners("q arm mesh 0"), workload.meshes[0], placed({}, 4));
  checkPlaced(loaded.corners("q hand mesh 0"), workload.meshes[0], placed({}, 8));
  checkPlaced(loaded.corners("q hand mesh 1"), workload.meshes[0], placed(sheared, 8));
  const aiAnimation& animation = *loaded.scene->mAnimations[0];
  REQUIRE(animation.mNumChannels == 2);
  for (unsigned c = 0; c < 2; ++c) {
    const aiNodeAnim& moves = *animation.mChannels[c];
    if (moves.mNodeName.C_Str() == std::string("q rail")) {
      CHECK((moves.mPositionKeys[0].mValue == aiVector3D(0, 1, 0) &&
             moves.mPositionKeys[1].mValue == aiVector3D(0, 2, 0)));
      CHECK(moves.mPositionKeys[1].mTime == Approx(1.5 * animation.mTicksPerSecond));
      continue;
    }
    CHECK(moves.mNodeName.C_Str() == std::string("q arm"));
    REQUIRE(moves.mNumRotationKeys == 8);
    for (unsigned k = 0; k < 8; ++k) {
      const aiVector3D found = moves.mRotationKeys[k].mValue.Rotate({0, 0, 1});
      CHECK(std::abs(found.x - std::sin(6.0 * k / 7)) + std::abs(found.z - std::cos(6.0 * k / 7)) < 1e-5);
    }
  }
}

TEST_CASE("meshes are stored once, whatever their statuses, but deformed or sheared ones") {
  const Workload workload = makeWorkload(Figure7{.teapots = 6, .boxes = 50, .steps = 4});
  Scene scene;
  replaceBy(workload, 1, scene);
  const std::vector<Result> answers(workload.queries.size());
  const std::string bytes = gltfOf(workload, answers, {}).bytes;
  CHECK(bytes.size() < 400'000);  // a teapot has 120,000
  const Loaded loaded(bytes);
  CHECK(loaded.nodes.contains("object 55"));
}

TEST_CASE("a glTF file of many queries and objects is cut as a page is, and says so") {
  Workload workload = makeWorkload(Soups{.objects = 5, .sensors = 1});
  const QuerySpec query = workload.queries.front();
  const Instance instance = workload.scenes[0].instances.front();
  workload.queries.assign(kMostShownQueries + 1, query);
  for (size_t i = 0; i < workload.queries.size(); ++i) workload.queries[i].id = std::to_string(i);
  workload.scenes[0].instances.assign(100'002, instance);
  std::vector<Result> answers(workload.queries.size(), Result(Status::clear));
  answers[0] = Result(Status::hit);
  answers[0].object = 100'001;
  const Gltf file = gltfOf(workload, answers, {{1, {100'000}}});
  CHECK(file.notes == std::vector<std::string>{"The first 10000 of 10001 queries.",
                                               "Scene " + workload.scenes[0].id +
                                                   ": 100000 of 100002 objects, with all that answers name."});
  CHECK(file.bytes.find(file.notes[1]) != std::string::npos);
  CHECK(file.bytes.find("\"sensor 9999\"") != std::string::npos);
  CHECK(file.bytes.find("\"sensor 10000\"") == std::string::npos);
  CHECK(file.bytes.find("\"object 100001\"") != std::string::npos);
  CHECK(file.bytes.find("\"object 100000\"") != std::string::npos);
  CHECK(file.bytes.find("\"object 99999\"") == std::string::npos);
}

TEST_CASE("balls and capsules are drawn as what they are, where their points and segments are") {
  Workload workload;
  workload.meshes = {{.name = "ball", .positions = {0, 0, 0}, .indices = {0, 0, 0}, .radius = 2},
                     {.name = "point", .positions = {1, 2, 3}, .indices = {0, 0, 0}},
                     {.name = "rod", .positions = {0, 0, 0, 3, 0, 0}, .indices = {0, 1, 1}, .radius = 0.5},
                     {.name = "face", .positions = {0, 0, 0, 3, 0, 0, 0, 1, 0}, .indices = {0, 1, 2}, .radius = 0.5}};
  workload.scenes.push_back({"scene", {}, {}, {}});
  const Transform pose{{0, -2, 0, 5, 2, 0, 0, 6, 0, 0, 2, 7}};  // a quarter turn about z, twice as large
  for (uint32_t mesh = 0; mesh < 4; ++mesh) {
    QuerySpec& query = workload.queries.emplace_back();
    query.id = workload.meshes[mesh].name;
    query.setSensor({mesh, pose});
    query.direction = {0, 0, 1};
    query.distance = 1;
    query.clearance = mesh == 1 ? 0.75 : workload.meshes[mesh].radius + 0.25;
  }
  const Loaded loaded(gltfOf(workload, std::vector<Result>(4, Result(Status::clear)), {}).bytes);
  const auto check = [&](const char* name, const Vec3& from, const Vec3& to, double radius) {
    const std::vector<Vec3> corners = loaded.corners(name);
    REQUIRE(corners.size() > 500);
    const Vec3 along = to - from;
    double least = INFINITY, most = 0, farthest = -INFINITY, nearest = INFINITY;
    for (const Vec3& corner : corners) {
      const double at = dot(along, along) > 0 ? dot(corner - from, along) / dot(along, along) : 0;
      const double distance = lengthOf(corner - (from + std::clamp(at, 0.0, 1.0) * along));
      least = std::min(least, distance), most = std::max(most, distance);
      nearest = std::min(nearest, at), farthest = std::max(farthest, at);
    }
    CHECK(least > radius - 1e-5);
    CHECK(most < radius + 1e-5);
    if (dot(along, along) == 0) return;
    CHECK(nearest == Approx(-radius / lengthOf(along)));
    CHECK(farthest == Approx(1 + radius / lengthOf(along)));
  };
  check("ball", {5, 6, 7}, {5, 6, 7}, 2);
  check("point", {1, 8, 13}, {1, 8, 13}, 0.75);
  check("rod", {5, 6, 7}, {5, 12, 7}, 0.5);
  checkPlaced(loaded.corners("face"), workload.meshes[3], pose);
}
