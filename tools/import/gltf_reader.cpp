#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "import/gltf_document.h"
#include "import/readers.h"
#include "workloads/vectors.h"

namespace radar::tools {

namespace {

template <size_t kSize>
std::array<double, kSize> numbersOf(const JsonValue& node, const char* key, std::array<double, kSize> otherwise) {
  node.ifHas(key, [&](const JsonValue& list) {
    if (list.size() != kSize) list.expected(std::to_string(kSize) + " numbers");
    for (size_t i = 0; i < kSize; ++i) otherwise[i] = list[i].number();
  });
  return otherwise;
}

/// Of a quarter turn whose two numbers are equal, every entry is exact.
Transform poseOf(const std::array<double, 3>& translation, const std::array<double, 4>& quaternion,
                 const std::array<double, 3>& scale) {
  const auto [x, y, z, w] = quaternion;
  const double square = x * x + y * y + z * z + w * w;
  const double rotation[9] = {
      w * w + x * x - y * y - z * z, 2 * (x * y - w * z),           2 * (x * z + w * y),
      2 * (x * y + w * z),           w * w - x * x + y * y - z * z, 2 * (y * z - w * x),
      2 * (x * z - w * y),           2 * (y * z + w * x),           w * w - x * x - y * y + z * z};
  Transform pose;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 3; ++k) pose.m[4 * row + k] = rotation[3 * row + k] / square * scale[k];
    pose.m[4 * row + 3] = translation[row];
  }
  return pose;
}

Transform poseOf(const std::array<double, 16>& columns) {
  Transform pose;
  for (size_t i = 0; i < 12; ++i) pose.m[i] = columns[4 * (i % 4) + i / 4];
  return pose;
}

Transform poseOf(const JsonValue& node) {
  Transform pose;
  if (node.has("matrix")) {
    const auto columns = numbersOf<16>(node, "matrix", {});
    if (columns[3] != 0 || columns[7] != 0 || columns[11] != 0 || columns[15] != 1) {
      node.member("matrix").expected("a matrix whose last row is 0 0 0 1");
    }
    pose = poseOf(columns);
  } else {
    pose = poseOf(numbersOf<3>(node, "translation", {}), numbersOf<4>(node, "rotation", {0, 0, 0, 1}),
                  numbersOf<3>(node, "scale", {1, 1, 1}));
  }
  if (!std::ranges::all_of(pose.m, [](double x) { return std::isfinite(x); })) node.expected("a finite transform");
  return pose;
}

class GltfReader {
 public:
  explicit GltfReader(Text text) : document_(text), most_(std::max<uint64_t>(text.rest().size(), uint64_t(1) << 27)) {}
  MeshFile read();

 private:
  /// The skin's joints: fileFromJoint * jointFromMesh.
  using Joints = std::vector<Transform>;

  void findParents(const JsonValue& nodes);
  const Transform& fileFromNode(const JsonValue& nodes, uint32_t number);
  void place(const JsonValue& nodes, uint32_t number);
  std::vector<Transform> instancesOf(const JsonValue& node, const Transform& fileFromNode);
  Joints jointsOf(const JsonValue& nodes, const JsonValue& skinNumber);
  std::vector<uint32_t> partsOf(const JsonValue& node, const Joints* joints);
  MeshFile::Part partOf(const JsonValue& primitive, const std::vector<double>& weights, const Joints* joints);

  GltfDocument document_;
  MeshFile file_;
  std::vector<uint32_t> parents_;
  std::vector<std::optional<Transform>> poses_;                                      // fileFromNode
  std::map<std::pair<uint32_t, std::vector<double>>, std::vector<uint32_t>> parts_;  // of a mesh and its weights
  std::vector<uint32_t> numbers_;  // of a primitive's vertices in its part
  uint64_t most_, stored_ = 0;     // vertices and triangles
};

constexpr uint32_t kNone = UINT32_MAX;
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

bool hasExtension(const JsonValue& value, const char* name) {
  return value.has("extensions") && value.json()["extensions"].contains(name);
}

void GltfReader::findParents(const JsonValue& nodes) {
  parents_.assign(nodes.size(), kNone);
  poses_.resize(nodes.size());
  for (uint32_t i = 0; i < parents_.size(); ++i) {
    const JsonValue node = nodes[i];
    node.ifHas("children", [&](const JsonValue& children) {
      children.forEach([&](const JsonValue& child) {
        uint32_t& parent = parents_[child.index(parents_.size(), "nodes")];
        if (parent != kNone) child.expected("a node that has no other parent");
        parent = i;
      });
    });
  }
}

const Transform& GltfReader::fileFromNode(const JsonValue& nodes, uint32_t number) {
  std::vector<uint32_t> open;  // no recursion: a file may nest its nodes as deeply as it likes
  for (uint32_t i = number; i != kNone && !poses_[i]; i = parents_[i]) {
    open.push_back(i);
    if (open.size() > parents_.size()) nodes[number].refuse("expected a node that is not among those below it");
  }
  for (; !open.empty(); open.pop_back()) {
    const uint32_t i = open.back();
    const JsonValue node = nodes[i];
    poses_[i] = parents_[i] == kNone ? poseOf(node) : product(*poses_[parents_[i]], poseOf(node));
  }
  return *poses_[number];
}

std::vector<Transform> GltfReader::instancesOf(const JsonValue& node, const Transform& fileFromNode) {
  if (!hasExtension(node, kInstancing)) return {fileFromNode};
  const JsonValue extensions = node.member("extensions"), instancing = extensions.member(kInstancing),
                  attributes = instancing.member("attributes");
  std::optional<GltfAccessor> translation, rotation, scale;
  std::optional<size_t> count;
  const auto take = [&](const char* key, const char* type, std::optional<GltfAccessor>& to) {
    attributes.ifHas(key, [&](const JsonValue& number) {
      to = document_.accessor(number, type);
      if (count && *count != to->count()) number.expected("as many elements as the other attributes have");
      count = to->count();
    });
  };
  take("TRANSLATION", "VEC3", translation);
  take("ROTATION", "VEC4", rotation);
  take("SCALE", "VEC3", scale);
  if (!count) attributes.expected("TRANSLATION, ROTATION or SCALE");
  if (*count > most_) attributes.refuse("expected at most " + std::to_string(most_) + " instances");
  std::vector<Transform> poses;
  for (size_t i = 0; i < *count; ++i) {
    const Transform own = poseOf(translation ? translation->row<3>(i) : std::array<double, 3>{},
                                 rotation ? rotation->row<4>(i) : std::array<double, 4>{0, 0, 0, 1},
                                 scale ? scale->row<3>(i) : std::array<double, 3>{1, 1, 1});
    if (!std::ranges::all_of(own.m, [](double x) { return std::isfinite(x); })) {
      attributes.refuse("expected a finite transform of instance " + std::to_string(i));
    }
    poses.push_back(product(fileFromNode, own));
  }
  return poses;
}

GltfReader::Joints GltfReader::jointsOf(const JsonValue& nodes, const JsonValue& skinNumber) {
  return document_.use("skins", skinNumber, [&](const JsonValue& skin) {
    const JsonValue list = skin.member("joints");
    std::optional<GltfAccessor> bound;
    skin.ifHas("inverseBindMatrices", [&](const JsonValue& number) {
      bound = document_.accessor(number, "MAT4");
      if (bound->count() < list.size()) number.expected("a matrix for each joint");
    });
    Joints joints;
    list.forEach([&](const JsonValue& joint) {
      const Transform& pose = fileFromNode(nodes, joint.index(nodes.size(), "nodes"));
      joints.push_back(bound ? product(pose, poseOf(bound->row<16>(joints.size()))) : pose);
    });
    return joints;
  });
}

/// Moves vertices as their joints do.
class Skinning {
 public:
  Skinning(GltfDocument& document, const JsonValue& attributes, const std::vector<Transform>& joints, size_t vertices)
      : attributes_(attributes), joints_(joints) {
    for (size_t set = 0; set == 0 || attributes.has(("JOINTS_" + std::to_string(set)).c_str()); ++set) {
      const std::string names[] = {"JOINTS_" + std::to_string(set), "WEIGHTS_" + std::to_string(set)};
      const JsonValue first = attributes.member(names[0].c_str()), second = attributes.member(names[1].c_str());
      sets_.push_back({document.accessor(first, "VEC4"), document.accessor(second, "VEC4")});
      if (sets_.back().joints.count() < vertices) first.expected("four joints for each vertex");
      if (sets_.back().weights.count() < vertices) second.expected("four weights for each vertex");
    }
  }
  /// fileFromVertex. Weights are divided by their sum.
  Transform of(size_t vertex) const {
    Transform pose;
    pose.m = {};
    double sum = 0;
    for (const Set& set : sets_) {
      for (unsigned k = 0; k < 4; ++k) {
        const double weight = set.weights.at(vertex, k), joint = set.joints.at(vertex, k);
        if (weight == 0) continue;
        if (!(joint >= 0 && joint < double(joints_.size()))) refuse(vertex, "one of the skin's joints");
        sum += weight;
        const Transform& moved = joints_[static_cast<size_t>(joint)];
        for (size_t i = 0; i < 12; ++i) pose.m[i] += weight * moved.m[i];
      }
    }
    if (!(sum > 0 && std::isfinite(sum))) refuse(vertex, "weights whose sum is 1");
    for (double& entry : pose.m) entry /= sum;
    return pose;
  }

 private:
  struct Set {
    GltfAccessor joints, weights;
  };
  [[noreturn]] void refuse(size_t vertex, const char* what) const {
    attributes_.refuse(std::string("expected ") + what + " for vertex " + std::to_string(vertex) + ", got others");
  }
  const JsonValue& attributes_;
  const std::vector<Transform>& joints_;
  std::vector<Set> sets_;
};

/// Appends the corners of triangles: three numbers, each below `count`, of a primitive's indices.
std::vector<uint32_t> cornersOf(const JsonValue& primitive, uint32_t mode, size_t count) {
  std::vector<uint32_t> corners;
  if (mode == 4 && count % 3 != 0) {
    primitive.refuse("expected three corners for each triangle, got " + std::to_string(count) + " corners");
  }
  const auto end = static_cast<uint32_t>(count);
  if (mode == 4) {
    for (uint32_t i = 0; i < end; ++i) corners.push_back(i);
  }
  for (uint32_t i = 0; mode == 5 && i + 2 < end; ++i) {
    corners.insert(corners.end(), {i, i + 1 + i % 2, i + 2 - i % 2});
  }
  for (uint32_t i = 1; mode == 6 && i + 1 < end; ++i) corners.insert(corners.end(), {0, i, i + 1});
  return corners;
}

MeshFile::Part GltfReader::partOf(const JsonValue& primitive, const std::vector<double>& weights,
                                  const Joints* joints) {
  MeshFile::Part part;
  const JsonValue attributes = primitive.member("attributes");
  if (!attributes.has("POSITION")) return part;  // nothing to draw
  const char* compression = hasExtension(primitive, kDraco) ? kDraco : nullptr;
  const JsonValue positionNumber = attributes.member("POSITION");
  const GltfAccessor positions = document_.accessor(positionNumber, "VEC3", compression);
  std::optional<GltfAccessor> indices;
  primitive.ifHas("indices",
                  [&](const JsonValue& number) { indices = document_.accessor(number, "SCALAR", compression); });
  std::vector<std::pair<double, GltfAccessor>> moves;
  primitive.ifHas("targets", [&](const JsonValue& targets) {
    for (size_t i = 0; i < targets.size() && i < weights.size(); ++i) {
      const JsonValue target = targets[i];
      if (weights[i] == 0) continue;
      target.ifHas("POSITION", [&](const JsonValue& number) {
        moves.emplace_back(weights[i], document_.accessor(number, "VEC3"));
        if (moves.back().second.count() != positions.count()) number.expected("as many elements as POSITION has");
      });
    }
  });
  uint32_t mode = 4;
  primitive.ifHas("mode", [&](const JsonValue& value) {
    mode = value.wholeNumber<uint32_t>();
    if (mode > 6) value.expected("a mode from 0 to 6");
  });
  const uint64_t count = indices ? indices->count() : positions.count();
  if (mode == 0) part.points = count;
  if (mode > 0 && mode < 4) part.lines = mode == 1 ? count / 2 : mode == 2 && count > 1 ? count : count - (count > 0);
  if (mode < 4) return part;
  if ((stored_ += count) > most_) {
    primitive.refuse("expected at most " + std::to_string(most_) + " corners up to here, got " +
                     std::to_string(stored_));
  }
  std::optional<Skinning> skinning;
  if (joints) skinning.emplace(document_, attributes, *joints, positions.count());
  if (numbers_.size() < positions.count()) numbers_.resize(positions.count(), kNone);
  std::vector<uint32_t> used;
  std::vector<bool> isTurned;  // of the part's vertices
  const auto add = [&](uint32_t vertex) {
    auto position = positions.row<3>(vertex);
    for (const auto& [weight, move] : moves) {
      for (unsigned k = 0; k < 3; ++k) position[k] += weight * move.at(vertex, k);
    }
    if (skinning) {
      const Transform pose = skinning->of(vertex);
      const auto [x, y, z] = position;
      for (size_t k = 0; k < 3; ++k) {
        const double* row = &pose.m[4 * k];
        position[k] = row[0] * x + row[1] * y + row[2] * z + row[3];
      }
      isTurned.push_back(mirrors(pose));
    }
    for (const double coordinate : position) {
      if (!(std::abs(coordinate) <= std::numeric_limits<float>::max())) {
        std::ostringstream problem;
        problem << "expected 3 finite numbers as element " << vertex << ", got " << position[0] << " " << position[1]
                << " " << position[2];
        positionNumber.refuse(problem.str());
      }
      part.positions.push_back(coordinate);
    }
    used.push_back(vertex);
  };
  for (const uint32_t corner : cornersOf(primitive, mode, count)) {
    const double vertex = indices ? indices->at(corner, 0) : corner;
    if (!(vertex >= 0 && vertex < double(positions.count()) && vertex == std::floor(vertex))) {
      std::ostringstream problem;
      problem << "expected one of the " << positions.count() << " vertices as index " << corner << ", got " << vertex;
      primitive.refuse(problem.str());
    }
    uint32_t& number = numbers_[static_cast<size_t>(vertex)];
    if (number == kNone) {
      number = static_cast<uint32_t>(used.size());
      add(static_cast<uint32_t>(vertex));
    }
    part.indices.push_back(number);
  }
  for (const uint32_t vertex : used) numbers_[vertex] = kNone;
  for (size_t i = 0; skinning && i < part.indices.size(); i += 3) {
    if (isTurned[part.indices[i]]) std::swap(part.indices[i + 1], part.indices[i + 2]);
  }
  return part;
}

std::vector<uint32_t> GltfReader::partsOf(const JsonValue& node, const Joints* joints) {
  const JsonValue meshNumber = node.member("mesh");
  return document_.use("meshes", meshNumber, [&](const JsonValue& mesh) {
    std::vector<double> weights;
    const auto take = [&](const JsonValue& list) {
      weights.clear();
      list.forEach([&](const JsonValue& weight) { weights.push_back(weight.number()); });
    };
    mesh.ifHas("weights", take);
    node.ifHas("weights", take);
    const auto [known, isNew] = parts_.try_emplace({meshNumber.wholeNumber<uint32_t>(), weights});
    if (!isNew && !joints) return known->second;
    std::vector<uint32_t> parts;
    const JsonValue primitives = mesh.member("primitives");
    primitives.forEach([&](const JsonValue& primitive) {
      parts.push_back(static_cast<uint32_t>(file_.parts.size()));
      file_.parts.push_back(partOf(primitive, weights, joints));
    });
    if (joints) {
      if (isNew) parts_.erase(known);
    } else {
      known->second = parts;
    }
    return parts;
  });
}

void GltfReader::place(const JsonValue& nodes, uint32_t number) {
  const JsonValue node = nodes[number];
  if (!node.has("mesh")) return;
  std::string name;
  node.ifHas("name", [&](const JsonValue& value) { name = value.string(); });
  if (name.empty()) name = "nodes[" + std::to_string(number) + "]";
  if (node.has("skin")) {  // its joints place it, not its own transform
    const JsonValue skinNumber = node.member("skin");
    const Joints joints = jointsOf(nodes, skinNumber);
    file_.nodes.push_back({name, {}, partsOf(node, &joints)});
    return;
  }
  const std::vector<uint32_t> parts = partsOf(node, nullptr);
  for (const Transform& pose : instancesOf(node, fileFromNode(nodes, number))) {
    file_.nodes.push_back({name, pose, parts});
  }
}

MeshFile GltfReader::read() {
  const JsonValue top = document_.root(), scenes = top.member("scenes"), nodes = top.member("nodes");
  size_t chosen = 0;
  top.ifHas("scene", [&](const JsonValue& number) { chosen = number.index(scenes.size(), "scenes"); });
  if (scenes.size() == 0) scenes.expected("at least one scene");
  findParents(nodes);
  std::vector<uint32_t> open;
  std::set<uint32_t> roots;
  const JsonValue scene = scenes[chosen];
  scene.ifHas("nodes", [&](const JsonValue& list) {
    list.forEach([&](const JsonValue& root) {
      open.push_back(root.index(nodes.size(), "nodes"));
      if (parents_[open.back()] != kNone || !roots.insert(open.back()).second) {
        root.expected("a node that has no parent and is named once");
      }
    });
  });
  std::ranges::reverse(open);
  while (!open.empty()) {
    const uint32_t number = open.back();
    open.pop_back();
    place(nodes, number);
    const JsonValue node = nodes[number];
    node.ifHas("children", [&](const JsonValue& children) {
      for (size_t i = children.size(); i > 0; --i) open.push_back(children[i - 1].wholeNumber<uint32_t>());
    });
  }
  file_.unit = "meter";
  return std::move(file_);
}

}  // namespace

MeshFile readGltf(Text text) {
  return GltfReader(text).read();
}

}  // namespace radar::tools
