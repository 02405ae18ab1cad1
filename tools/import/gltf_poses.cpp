#include "import/gltf_poses.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>

namespace radar::tools {

namespace {

using Json = nlohmann::json;

const Json* member(const Json* object, const char* key) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found == object->end() ? nullptr : &*found;
}

const Json* element(const Json* list, size_t index) {
  return list != nullptr && list->is_array() && index < list->size() ? &(*list)[index] : nullptr;
}

/// The element that a number names.
const Json* element(const Json* list, const Json* number) {
  return number != nullptr && number->is_number_unsigned() ? element(list, number->get<size_t>()) : nullptr;
}

template <size_t kCount>
std::optional<std::array<double, kCount>> numbers(const Json* list) {
  std::array<double, kCount> values{};
  if (list == nullptr || !list->is_array() || list->size() != kCount) return {};
  for (size_t i = 0; i < kCount; ++i) {
    if (!(*list)[i].is_number()) return {};
    values[i] = (*list)[i].get<double>();
  }
  return values;
}

/// Of a quarter turn whose two numbers are equal, every entry is exact.
std::array<double, 9> rotationOf(const std::array<double, 4>& quaternion) {
  const auto [x, y, z, w] = quaternion;
  const double square = x * x + y * y + z * z + w * w;
  std::array<double, 9> rotation{
      w * w + x * x - y * y - z * z, 2 * (x * y - w * z),           2 * (x * z + w * y),
      2 * (x * y + w * z),           w * w - x * x + y * y - z * z, 2 * (y * z - w * x),
      2 * (x * z - w * y),           2 * (y * z + w * x),           w * w - x * x - y * y + z * z};
  for (double& entry : rotation) entry /= square;
  return rotation;
}

Transform poseOf(const Json* node) {
  Transform pose;
  if (const auto matrix = numbers<16>(member(node, "matrix"))) {
    for (size_t i = 0; i < 12; ++i) pose.m[i] = (*matrix)[4 * (i % 4) + i / 4];
    return pose;
  }
  const auto rotation = rotationOf(numbers<4>(member(node, "rotation")).value_or(std::array<double, 4>{0, 0, 0, 1}));
  const auto scale = numbers<3>(member(node, "scale")).value_or(std::array<double, 3>{1, 1, 1});
  const auto translation = numbers<3>(member(node, "translation")).value_or(std::array<double, 3>{});
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 3; ++k) pose.m[4 * row + k] = rotation[3 * row + k] * scale[k];
    pose.m[4 * row + 3] = translation[row];
  }
  return pose;
}

/// Equal but for rounding, and for a quaternion that is only roughly of length 1.
bool areClose(const Transform& a, const Transform& b) {
  double most[2] = {0, 0}, apart[2] = {0, 0};  // of the rotation and scale, of the translation
  for (size_t i = 0; i < 12; ++i) {
    const size_t part = i % 4 == 3;
    most[part] = std::fmax(most[part], std::abs(b.m[i]));
    apart[part] = std::fmax(apart[part], std::abs(a.m[i] - b.m[i]));
    if (!std::isfinite(a.m[i])) return false;
  }
  return apart[0] <= 0.01 * most[0] && apart[1] <= 0.01 * most[1];
}

std::string jsonOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char head[20] = {};  // of a binary file: what it is, its version and length; its first part's length and kind
  stream.read(head, sizeof head);
  if (stream && std::string_view(head, 4) == "glTF") {
    uint32_t length = 0;
    std::memcpy(&length, head + 12, sizeof length);
    std::string text(std::min<uintmax_t>(length, std::filesystem::file_size(file)), '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
  }
  stream.clear();
  stream.seekg(0);
  if (file.extension() != ".gltf" && file.extension() != ".GLTF") return {};
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Transform GltfPoses::Node::pose(const Transform& rounded) const {
  if (node_ == nullptr) return rounded;
  const Transform exact = poseOf(node_);
  return areClose(exact, rounded) ? exact : rounded;
}

GltfPoses::Node GltfPoses::Node::child(size_t number, size_t children) const {
  if (children_ == nullptr || children_->size() != children) return {};
  const Json* node = element(member(document_, "nodes"), element(children_, number));
  return {document_, node, member(node, "children")};
}

GltfPoses::GltfPoses(const std::filesystem::path& file) {
  // Buffers and pictures may be in the text, too.
  const auto isWanted = [](int depth, Json::parse_event_t event, const Json& key) {
    return depth != 1 || event != Json::parse_event_t::key || key == "nodes" || key == "scenes" || key == "scene";
  };
  document_ = Json::parse(jsonOf(file), isWanted, false);
}

GltfPoses::Node GltfPoses::root() const {
  const Json* chosen = member(&document_, "scene");
  const Json* scenes = member(&document_, "scenes");
  const Json* scene = chosen == nullptr ? element(scenes, size_t{0}) : element(scenes, chosen);
  const Node all(&document_, nullptr, member(scene, "nodes"));
  const Json* nodes = member(scene, "nodes");
  return nodes != nullptr && nodes->size() == 1 ? all.child(0, 1) : all;
}

}  // namespace radar::tools
