#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "batch/atomic_file.h"
#include "batch/query_file.h"

namespace radar::tools {

namespace {

constexpr size_t kMostInline = 64;

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void appendLittleEndian(std::string& bytes, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
}

std::string plyOf(const MeshData& mesh) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertexCount()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.triangleCount()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 4 * mesh.positions.size() + 5 * mesh.indices.size());
  for (float value : mesh.positions) {
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    appendLittleEndian(bytes, bits);
  }
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    if (i % 3 == 0) bytes += '\3';
    appendLittleEndian(bytes, mesh.indices[i]);
  }
  return bytes;
}

void appendInstance(std::string& text, const Instance& instance, const char* separator) {
  text += std::to_string(instance.mesh);
  if (instance.worldFromMesh == Transform{}) return;
  for (double value : instance.worldFromMesh.m) {
    text += separator;
    appendNumber(text, value);
  }
}

template <class List, class Append>
void appendList(std::string& text, const List& list, Append append) {
  text += "[";
  for (size_t i = 0; i < list.size(); ++i) {
    if (i > 0) text += ",";
    append(list[i]);
  }
  text += "]";
}

void appendScene(std::string& text, const SceneSpec& scene, const std::string& instanceFile) {
  text.append("{\"id\": ").append(quoted(scene.id));
  if (scene.base) text.append(", \"base\": ").append(std::to_string(*scene.base));
  if (!instanceFile.empty()) {
    text += ", \"instances_file\": " + quoted(instanceFile);
  } else {
    text += ", \"instances\": ";
    appendList(text, scene.instances, [&](const Instance& instance) {
      text += "[";
      appendInstance(text, instance, ",");
      text += "]";
    });
  }
  if (!scene.masks.empty()) {
    text += ", \"masks\": ";
    appendList(text, scene.masks, [&](const ObjectMask& mask) {
      text.append("[").append(std::to_string(mask.first)).append(",").append(std::to_string(mask.second)).append("]");
    });
  }
  text += "}";
}

void appendQuery(std::string& text, const QuerySpec& query) {
  text += "{\"id\": " + quoted(query.id) + ", \"scene\": " + std::to_string(query.scene) +
          ", \"batch\": " + std::to_string(query.batch) + ", \"sensor\": [";
  appendInstance(text, query.sensor, ",");
  text += "]";
  if (!query.exclude.empty()) {
    text += ", \"exclude\": ";
    appendList(text, query.exclude, [&](uint32_t object) { text += std::to_string(object); });
  }
  text += ", \"dir\": ";
  appendList(text, query.direction, [&](double value) { appendNumber(text, value); });
  text += ", \"D\": ";
  appendNumber(text, query.distance);
  if (query.mask != ~0u) text.append(", \"mask\": ").append(std::to_string(query.mask));
  if (query.anyHit) text += ", \"decide\": true";
  if (query.mode) text += std::string(", \"mode\": \"") + nameOf(*query.mode) + "\"";
  if (query.speed) {
    text += ", \"speed\": ";
    appendNumber(text, *query.speed);
  }
  if (query.tolerance) {
    text += ", \"tolerance\": ";
    appendNumber(text, *query.tolerance);
  }
  text += "}";
}

}  // namespace

std::filesystem::path writeQueryFile(const Workload& workload, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": expected a folder, got " + error.message());

  std::string text = "{\"format\": \"cyber-radar-queries-1\",\n \"meshes\": [";
  for (size_t i = 0; i < workload.meshes.size(); ++i) {
    const std::string name = "mesh-" + std::to_string(i) + ".ply";
    writeAtomically(folder / name, plyOf(workload.meshes[i]));
    text += (i > 0 ? ", " : "") + quoted(name);
  }
  text += "],\n \"scenes\": [";
  for (size_t i = 0; i < workload.scenes.size(); ++i) {
    const SceneSpec& scene = workload.scenes[i];
    std::string instanceFile;
    if (scene.instances.size() > kMostInline) {
      instanceFile = "scene-" + std::to_string(i) + ".inst";
      std::string lines;
      for (const Instance& instance : scene.instances) {
        appendInstance(lines, instance, " ");
        lines += "\n";
      }
      writeAtomically(folder / instanceFile, lines);
    }
    text += i > 0 ? ",\n  " : "\n  ";
    appendScene(text, scene, instanceFile);
  }
  text += "],\n \"queries\": [";
  for (size_t i = 0; i < workload.queries.size(); ++i) {
    text += i > 0 ? ",\n  " : "\n  ";
    appendQuery(text, workload.queries[i]);
  }
  text += "]}\n";
  std::filesystem::path file = folder / "queries.json";
  writeAtomically(file, text);
  return file;
}

}  // namespace radar::tools
