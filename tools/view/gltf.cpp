#include "view/gltf.h"

#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include "radar/displacement.h"
#include "view/round_sensors.h"
#include "workloads/answer_fields.h"
#include "workloads/vectors.h"

namespace radar::tools {

namespace {

constexpr double kSeconds = 3;  // of a whole way

/// Whether the columns of a pose are not at right angles.
bool isSheared(const Transform& pose) {
  const Rotation linear = linearPart(pose);
  const auto column = [&](size_t k) { return Vec3{linear[k], linear[3 + k], linear[6 + k]}; };
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 a = column(k), b = column((k + 1) % 3);
    if (std::abs(dot(a, b)) > 1e-6 * lengthOf(a) * lengthOf(b)) return true;
  }
  return false;
}

/// The part of the way that a sensor can go, 0 to 1; of a hit that only says whether (Query::anyHit), 0.
double shareOf(const QuerySpec& query, const Result& answer) {
  if (answer.status == Status::clear) return 1;
  if (query.anyHit && answer.status == Status::hit) return 0;
  const double whole = takesStep(query) ? 1 : query.distance;
  const double time = answer.status == Status::hit ? answer.t : answer.status == Status::undecided ? answer.lo : 0;
  return time > 0 && whole > 0 ? std::min(time / whole, 1.0) : 0;
}

/// Seconds; never 0, since one key alone would be no motion.
float arrivalOf(double share) {
  return static_cast<float>(std::max(kSeconds * share, 1e-3));
}

/// At length 1, however short or long; a zero stays.
Vec3 unitOf(Vec3 v) {
  const double most = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (most == 0) return v;
  for (double& value : v) value /= most;
  return (1 / lengthOf(v)) * v;
}

class Writer {
 public:
  Writer(const Workload& workload, std::span<const Result> answers, const LeftOut& left)
      : workload_(workload),
        answers_(answers),
        left_(left),
        cut_(workload, answers, left, workload.queries.size()),
        round_(workload, std::span(workload.queries).first(cut_.queries())) {
    model_.asset.version = "2.0";
    model_.asset.generator = "cyber-radar";
    model_.buffers.resize(1);
    addMaterial("object", {0.68, 0.72, 0.78});
    addMaterial("hit", {0.9, 0.42, 0.05});
    addMaterial("clear", {0.1, 0.6, 0.47});
    addMaterial("overlap", {0.85, 0.13, 0.5});
    addMaterial("undecided", {0.85, 0.65, 0});
    addMaterial("invalid", {0.35, 0.35, 0.35});
    addMaterial("clear, some left out", {0.85, 0.13, 0.5});
  }

  Gltf file() {
    const std::span<const QuerySpec> queries = std::span(workload_.queries).first(cut_.queries());
    std::map<uint32_t, std::vector<size_t>> scenes;  // with their queries
    for (size_t i = 0; i < queries.size(); ++i) scenes[queries[i].scene].push_back(i);
    if (scenes.empty()) {
      for (uint32_t scene = 0; scene < workload_.scenes.size(); ++scene) scenes[scene];
    }
    for (const auto& [scene, shown] : scenes) addScene(scene, shown);
    model_.defaultScene = 0;
    tinygltf::Value::Array notes;
    for (const std::string& note : cut_.notes()) notes.emplace_back(note);
    if (!notes.empty()) model_.asset.extras = tinygltf::Value({{"notes", tinygltf::Value(notes)}});
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, stream, false, true)) {
      throw std::runtime_error("glTF: expected a model that can be written");
    }
    return {stream.str(), cut_.notes()};
  }

 private:
  void addMaterial(const std::string& name, const Vec3& colour) {
    tinygltf::Material material;
    material.name = name;
    material.doubleSided = true;
    material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.8;
    model_.materials.push_back(std::move(material));
  }

  /// The number of an accessor to values of `width` components, appended to the buffer.
  template <class Value>
  int addAccessor(const std::vector<Value>& values, int type, int width, int target) {
    tinygltf::BufferView view;
    std::vector<unsigned char>& bytes = model_.buffers[0].data;
    const auto* const first = reinterpret_cast<const unsigned char*>(values.data());
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = values.size() * sizeof(Value);
    view.target = target;
    bytes.insert(bytes.end(), first, first + view.byteLength);
    model_.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
    accessor.componentType =
        std::is_same_v<Value, float> ? TINYGLTF_COMPONENT_TYPE_FLOAT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    accessor.count = values.size() / static_cast<size_t>(width);
    accessor.type = type;
    if constexpr (std::is_same_v<Value, float>) {
      accessor.minValues.assign(static_cast<size_t>(width), INFINITY);
      accessor.maxValues.assign(static_cast<size_t>(width), -INFINITY);
      for (size_t i = 0; i < values.size(); ++i) {
        const size_t part = i % static_cast<size_t>(width);
        accessor.minValues[part] = std::min(accessor.minValues[part], double{values[i]});
        accessor.maxValues[part] = std::max(accessor.maxValues[part], double{values[i]});
      }
    }
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  /// Of the workload, or a round sensor.
  const MeshData& meshOf(uint32_t number) const {
    const size_t own = workload_.meshes.size();
    return number < own ? workload_.meshes[number] : round_.meshes[number - own];
  }

  /// The triangles of a mesh; `turned`: wound the other way round.
  int addIndices(uint32_t number, bool turned) {
    const auto [found, isNew] = indices_.try_emplace({number, turned});
    if (!isNew) return found->second;
    std::vector<uint32_t> indices = meshOf(number).indices;
    for (size_t i = 0; turned && i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
    return found->second = addAccessor(indices, TINYGLTF_TYPE_SCALAR, 1, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  }

  /// A mesh, as deformed in a scene, and placed if `pose` is given.
  int addMesh(uint32_t scene, uint32_t number, size_t material, const Transform* pose) {
    const MeshData& mesh = meshOf(number);
    const std::vector<float>* positions = &mesh.positions;
    bool isDeformed = false;
    for (const Deformation& deformed : workload_.scenes[scene].deforms) {
      if (deformed.mesh != number) continue;
      positions = &deformed.positions;
      isDeformed = true;
    }
    const auto key = std::tuple(isDeformed ? scene + 1 : 0, number, material);
    if (const auto found = meshes_.find(key); !pose && found != meshes_.end()) return found->second;
    std::vector<float> placed;
    if (pose) {
      for (size_t i = 0; i < positions->size(); i += 3) {
        for (const double value : transformPoint(*pose, &(*positions)[i])) placed.push_back(static_cast<float>(value));
      }
      positions = &placed;
    }
    const auto own = std::pair(isDeformed ? scene + 1 : 0, number);
    if (pose || !positions_.contains(own)) {
      positions_[own] = addAccessor(*positions, TINYGLTF_TYPE_VEC3, 3, TINYGLTF_TARGET_ARRAY_BUFFER);
    }
    tinygltf::Primitive primitive;
    primitive.attributes["POSITION"] = positions_[own];
    primitive.indices = addIndices(number, pose && mirrors(*pose));
    primitive.material = static_cast<int>(material);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    if (pose) positions_.erase(own);
    tinygltf::Mesh made;
    made.name = mesh.name;
    made.primitives.push_back(std::move(primitive));
    model_.meshes.push_back(std::move(made));
    const int last = static_cast<int>(model_.meshes.size()) - 1;
    if (!pose) meshes_[key] = last;
    return last;
  }

  int addNode(tinygltf::Node node) {
    model_.nodes.push_back(std::move(node));
    return static_cast<int>(model_.nodes.size()) - 1;
  }

  int addPlaced(const std::string& name, uint32_t scene, const Instance& instance, size_t material) {
    tinygltf::Node node;
    node.name = name;
    const Transform& pose = instance.worldFromMesh;
    const bool isBaked = isSheared(pose);
    node.mesh = addMesh(scene, instance.mesh, material, isBaked ? &pose : nullptr);
    if (!isBaked) node.matrix = matrixOf(pose);
    return addNode(std::move(node));
  }

  /// By columns.
  static std::vector<double> matrixOf(const Transform& pose) {
    std::vector<double> matrix;
    for (size_t column = 0; column < 4; ++column) {
      for (size_t row = 0; row < 3; ++row) matrix.push_back(pose.m[4 * row + column]);
      matrix.push_back(column == 3 ? 1 : 0);
    }
    return matrix;
  }

  /// Lets a node go through values, a vector or quaternion at each of the times.
  void animate(int node, const char* what, const std::vector<float>& times, const std::vector<float>& values,
               tinygltf::Animation& animation) {
    const auto width = static_cast<int>(values.size() / times.size());
    tinygltf::AnimationSampler sampler;
    sampler.input = addAccessor(times, TINYGLTF_TYPE_SCALAR, 1, 0);
    sampler.output = addAccessor(values, width == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC4, width, 0);
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size());
    channel.target_node = node;
    channel.target_path = what;
    animation.samplers.push_back(std::move(sampler));
    animation.channels.push_back(std::move(channel));
  }

  /// A node around another, which moves in the time of a way to `share` of it; its origin is at `from` at the start.
  int addMoving(const std::string& name, int child, const Vec3& way, double share, tinygltf::Animation& animation,
                const Vec3& from = {}) {
    tinygltf::Node node;
    node.name = name;
    node.children = {child};
    node.translation = {from[0], from[1], from[2]};
    const int number = addNode(std::move(node));
    move(number, from, share * way, share, animation);
    return number;
  }

  void move(int node, const Vec3& from, const Vec3& by, double share, tinygltf::Animation& animation) {
    std::vector<float> places;
    for (const Vec3& place : {from, from + by}) {
      for (const double value : place) places.push_back(static_cast<float>(value));
    }
    animate(node, "translation", {0, arrivalOf(share)}, places, animation);
  }

  /// In the time of a way to `share` of it, from an angle on and by another one.
  void turn(int node, const Vec3& axis, double from, double by, double share, tinygltf::Animation& animation) {
    // Between two keys it turns by less than half a turn, or players would take the shorter way.
    const auto keys = static_cast<size_t>(std::ceil(std::abs(by))) + 1;
    const Vec3 along = unitOf(axis);
    std::vector<float> times, rotations;
    for (size_t i = 0; i <= keys; ++i) {
      const double part = double(i) / double(keys), half = 0.5 * (from + part * by);
      times.push_back(static_cast<float>(part) * arrivalOf(share));
      for (const double value : along) rotations.push_back(static_cast<float>(std::sin(half) * value));
      rotations.push_back(static_cast<float>(std::cos(half)));
    }
    animate(node, "rotation", times, rotations, animation);
  }

  /// The same, turning.
  int addTurning(const std::string& name, int child, const Turn& turn, const Vec3& way, double share,
                 tinygltf::Animation& animation) {
    tinygltf::Node arm;
    arm.children = {child};
    arm.translation = {-turn.centre[0], -turn.centre[1], -turn.centre[2]};
    const int number = addMoving(name, addNode(std::move(arm)), way, share, animation, turn.centre);
    this->turn(number, turn.axis, 0, share * turn.angle, share, animation);
    return number;
  }

  /// A chain on its base: nodes within nodes, of which those of joints move.
  int addChain(const std::string& name, const QuerySpec& query, size_t material, double share,
               tinygltf::Animation& animation) {
    const ChainSpec& chain = workload_.chains[query.chain->chain];
    tinygltf::Node root;
    root.name = name;
    root.matrix = matrixOf(query.worldFromMesh);
    const int base = addNode(std::move(root));
    std::vector<int> joints;
    const auto addTo = [&](int parent, int child) {
      model_.nodes[static_cast<size_t>(parent)].children.push_back(child);
    };
    for (size_t i = 0; i < chain.links.size(); ++i) {
      const Link& link = chain.links[i];
      tinygltf::Node origin, joint;
      origin.matrix = matrixOf(link.parentFromJoint);
      joint.name = query.id + " " + chain.linkNames[i];
      const std::string placed = joint.name + " mesh ";
      const int stand = addNode(std::move(origin)), moving = addNode(std::move(joint));
      addTo(link.parent == kNone ? base : joints[link.parent], stand);
      addTo(stand, moving);
      joints.push_back(moving);
      if (link.joint != JointType::fixed) {
        const double from = query.chain->from[link.variable], by = share * (query.chain->to[link.variable] - from);
        if (link.joint == JointType::revolute) {
          turn(moving, link.axis, from, by, share, animation);
        } else {
          move(moving, from * unitOf(link.axis), by * unitOf(link.axis), share, animation);
        }
      }
      for (size_t k = 0; k < link.meshes.size(); ++k) {
        const auto& [mesh, pose] = link.meshes[k];
        addTo(moving, addPlaced(placed + std::to_string(k), query.scene, {mesh, pose}, material));
      }
    }
    return base;
  }

  int addMoved(size_t i, size_t material, double share, tinygltf::Animation& animation) {
    const QuerySpec& query = workload_.queries[i];
    const std::string name = "sensor " + query.id;
    if (query.chain) return addChain(name, query, material, share, animation);
    const int body = addPlaced(query.id, query.scene, round_.sensors[i], material);
    return query.turn ? addTurning(name, body, *query.turn, displacementOf(query), share, animation)
                      : addMoving(name, body, displacementOf(query), share, animation);
  }

  /// Numbers of a scene's objects, its base's included, as far as there is room.
  std::vector<uint32_t> objectsOf(uint32_t scene) {
    std::vector<uint32_t> numbers;
    if (const std::optional<uint32_t> base = workload_.scenes[scene].base) numbers = cut_.objects(*base, 0);
    const auto first = static_cast<uint32_t>(workload_.baseOf(scene).size());
    for (const uint32_t i : cut_.objects(scene, first)) numbers.push_back(first + i);
    return numbers;
  }

  void addScene(uint32_t number, std::span<const size_t> queries) {
    tinygltf::Animation animation;
    animation.name = "motion";
    tinygltf::Node root;
    root.name = "z up";
    root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    const std::vector<std::string> names = workload_.objectNames(number);
    std::map<uint32_t, Vec3> motions(workload_.scenes[number].motions.begin(), workload_.scenes[number].motions.end());
    for (const uint32_t i : objectsOf(number)) {
      const Instance& instance = workload_.instance(number, i);
      std::string name = "object " + std::to_string(i);
      if (!names.empty() && !names[i].empty()) name += " " + names[i];
      int node = addPlaced(name, number, instance, 0);
      if (motions.contains(i)) node = addMoving(name + " moves", node, motions[i], 1, animation);
      root.children.push_back(node);
    }
    for (const size_t i : queries) root.children.push_back(addSensor(i, animation));
    tinygltf::Scene scene;
    scene.name = workload_.scenes[number].id;
    scene.nodes = {addNode(std::move(root))};
    model_.scenes.push_back(std::move(scene));
    if (!animation.channels.empty()) model_.animations.push_back(std::move(animation));
  }

  int addSensor(size_t i, tinygltf::Animation& animation) {
    const QuerySpec& query = workload_.queries[i];
    const Result& answer = answers_[i];
    const auto left = left_.find(static_cast<uint32_t>(i));
    const bool isPart = answer.status == Status::clear && left != left_.end();
    const size_t material = isPart ? model_.materials.size() - 1 : 1 + static_cast<size_t>(answer.status);
    const int node = addMoved(i, material, shareOf(query, answer), animation);
    tinygltf::Value::Object extras{{"status", tinygltf::Value(model_.materials[material].name)}};
    const auto add = [&](const char* name, double value) {
      if (std::isfinite(value)) extras.insert({name, tinygltf::Value(value)});
    };
    add("t", answer.t);
    add("lo", answer.lo);
    add("hi", answer.hi);
    if (answer.object != kNone) extras.insert({"object", tinygltf::Value(static_cast<int>(answer.object))});
    if (left != left_.end()) {
      tinygltf::Value::Array objects;
      for (const uint32_t object : left->second) objects.emplace_back(static_cast<int>(object));
      extras.insert({"overlapping", tinygltf::Value(objects)});
    }
    model_.nodes[static_cast<size_t>(node)].extras = tinygltf::Value(extras);
    return node;
  }

  const Workload& workload_;
  std::span<const Result> answers_;
  const LeftOut& left_;
  Cut cut_;
  RoundSensors round_;
  tinygltf::Model model_;
  std::map<std::pair<uint32_t, bool>, int> indices_;              // accessors by mesh, and whether it is turned
  std::map<std::pair<uint32_t, uint32_t>, int> positions_;        // accessors by deforming scene + 1, or 0, and mesh
  std::map<std::tuple<uint32_t, uint32_t, size_t>, int> meshes_;  // the same and material
};

}  // namespace

Gltf gltfOf(const Workload& workload, std::span<const Result> answers, const LeftOut& left) {
  return Writer(workload, answers, left).file();
}

}  // namespace radar::tools
