#include "batch/fingerprint.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdio>
#include <type_traits>

namespace radar::tools {

struct Fingerprint::State {
  XXH3_state_t hash;
};

Fingerprint::Fingerprint() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->hash);
}

Fingerprint::~Fingerprint() = default;

void Fingerprint::add(std::span<const std::byte> bytes) {
  XXH3_128bits_update(&state_->hash, bytes.data(), bytes.size());
}

template <class Value>
void Fingerprint::addValue(const Value& value) {
  static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);  // no padding
  add(std::as_bytes(std::span(&value, 1)));
}

template <class Value>
void Fingerprint::addList(const std::vector<Value>& list) {
  static_assert(std::is_arithmetic_v<Value>);
  addValue(uint64_t{list.size()});
  add(std::as_bytes(std::span(list)));
}

void Fingerprint::add(const std::string& text) {
  addValue(uint64_t{text.size()});
  add(std::as_bytes(std::span(text)));
}

void Fingerprint::add(const Instance& instance) {
  addValue(instance.mesh);
  add(std::as_bytes(std::span(instance.worldFromMesh.m)));
}

void Fingerprint::addWorld(const Workload& workload) {
  addValue(uint64_t{workload.meshes.size()});
  for (const MeshData& mesh : workload.meshes) {
    addList(mesh.positions);
    addList(mesh.indices);
  }
  addValue(uint64_t{workload.scenes.size()});
  for (const SceneSpec& scene : workload.scenes) {
    addValue(scene.base ? uint64_t{*scene.base} : ~uint64_t{0});
    addValue(uint64_t{scene.instances.size()});
    for (const Instance& instance : scene.instances) add(instance);
    addValue(uint64_t{scene.masks.size()});
    for (const auto& [object, bits] : scene.masks) {
      addValue(object);
      addValue(bits);
    }
    addValue(uint64_t{scene.motions.size()});
    for (const auto& [object, motion] : scene.motions) {
      addValue(object);
      add(std::as_bytes(std::span(motion)));
    }
    addValue(uint64_t{scene.deforms.size()});
    for (const Deformation& deformed : scene.deforms) {
      addValue(deformed.mesh);
      addList(deformed.positions);
    }
    addValue(uint64_t{scene.names.size()});
    for (const std::string& name : scene.names) add(name);
  }
}

void Fingerprint::add(const QuerySpec& query) {
  const auto addOptional = [&](const std::optional<double>& value) {
    addValue(value.has_value());
    addValue(value.value_or(0));
  };
  add(query.id);
  addValue(query.scene);
  add(query.sensor());
  addList(query.exclude);
  addValue(query.motion.has_value());
  if (query.motion) {
    add(std::as_bytes(std::span(*query.motion)));
  } else {
    add(std::as_bytes(std::span(query.direction)));
    addValue(query.distance);
  }
  addValue(query.mask);
  addValue(query.anyHit);
  addValue(query.ignoreLeaving);
  addValue(query.skipOverlapping);
  addOptional(query.slack);
  addValue(query.hits);
  addValue(query.clearance);
  addValue(query.mode ? static_cast<int>(*query.mode) : -1);
  addOptional(query.speed);
  addOptional(query.tolerance);
}

std::string Fingerprint::text() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_->hash);
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return digits;
}

}  // namespace radar::tools
