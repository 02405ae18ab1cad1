#include <cmath>
#include <stdexcept>

#include "batch/atomic_file.h"
#include "batch/binary_queries.h"
#include "batch/json_output.h"
#include "batch/query_file.h"
#include "workloads/query_fields.h"

namespace radar::tools {

namespace {

constexpr size_t kMostInline = 64;

std::string plyOf(const MeshData& mesh) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertexCount()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.triangleCount()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 4 * mesh.positions.size() + 5 * mesh.indices.size());
  for (float value : mesh.positions) appendBytes(bytes, value);
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    if (i % 3 == 0) bytes += '\3';
    appendBytes(bytes, mesh.indices[i]);
  }
  return bytes;
}

std::string instanceText(const Instance& instance) {
  std::string text = "[" + std::to_string(instance.mesh);
  if (instance.worldFromMesh == Transform{}) return text + "]";
  for (double value : instance.worldFromMesh.m) {
    text += ",";
    appendNumber(text, value);
  }
  return text + "]";
}

// The file of a mesh's positions in a scene.
std::string positionsFile(size_t scene, uint32_t mesh) {
  return "scene-" + std::to_string(scene) + "-mesh-" + std::to_string(mesh) + ".f32";
}

std::string poseText(const Transform& pose) {
  return listOf(pose.m, ",", appendNumber);
}

std::string chainText(const ChainSpec& chain) {
  const auto nameOf = [&](uint32_t link) { return quoted(chain.linkNames[link]); };
  size_t number = 0;
  JsonObject object;
  object.add("links", listOf(chain.links, ",", [&](std::string& text, const Link& link) {
               JsonObject out;
               out.add("name", nameOf(static_cast<uint32_t>(number++)));
               if (link.parent != kNone) out.add("parent", nameOf(link.parent));
               out.add("origin", poseText(link.parentFromJoint));
               if (link.joint != JointType::fixed) {
                 out.addString("joint", link.joint == JointType::revolute ? "revolute" : "prismatic");
                 out.add("axis", listOf(link.axis, ",", appendNumber));
                 out.addString("variable", chain.variableNames[link.variable]);
               }
               out.add("meshes", listOf(link.meshes, ",", [](std::string& meshes, const LinkMesh& mesh) {
                         meshes += instanceText({mesh.mesh, mesh.linkFromMesh});
                       }));
               text += out.text();
             }));
  object.add("pairs", listOf(chain.pairs, ",", [&](std::string& text, const std::array<uint32_t, 2>& pair) {
               text += "[" + nameOf(pair[0]) + "," + nameOf(pair[1]) + "]";
             }));
  return object.text();
}

std::string sceneText(const SceneSpec& scene, size_t number, const std::string& instanceFile) {
  JsonObject object;
  if (!scene.id.empty()) object.addString("id", scene.id);
  if (scene.base) object.add("base", std::to_string(*scene.base));
  if (!instanceFile.empty()) {
    object.addString("instances_file", instanceFile);
  } else {
    object.add("instances", listOf(scene.instances, ",", [](std::string& text, const Instance& instance) {
                 text += instanceText(instance);
               }));
  }
  if (!scene.masks.empty()) {
    object.add("masks", listOf(scene.masks, ",", [](std::string& text, const ObjectMask& mask) {
                 text += "[" + std::to_string(mask.first) + "," + std::to_string(mask.second) + "]";
               }));
  }
  if (!scene.motions.empty()) {
    object.add("motions", listOf(scene.motions, ",", [](std::string& text, const ObjectMotion& motion) {
                 text += "[" + std::to_string(motion.first);
                 for (double value : motion.second) {
                   text += ",";
                   appendNumber(text, value);
                 }
                 text += "]";
               }));
  }
  if (!scene.deforms.empty()) {
    object.add("deforms", listOf(scene.deforms, ",", [&](std::string& text, const Deformation& deformed) {
                 text += "[" + std::to_string(deformed.mesh) + "," + quoted(positionsFile(number, deformed.mesh)) + "]";
               }));
  }
  return object.text();
}

void addField(JsonObject& to, const QueryField& field, const QuerySpec& query) {
  const double value = valueIn(query, field);
  if (field.kind() == 'o') {
    to.add(field.name, listOf(query.exclude, ",", [](std::string& text, ObjectId id) { text += std::to_string(id); }));
  } else if (field.kind() == 'b') {
    to.add(field.name, "true");
  } else if (field.kind() == 'f') {
    to.addNumber(field.name, value);
  } else {
    to.add(field.name, std::isinf(value) ? quoted(field.word) : std::to_string(static_cast<uint32_t>(value)));
  }
}

std::string queryText(const QuerySpec& query) {
  JsonObject object;
  object.addString("id", query.id);
  object.add("scene", std::to_string(query.scene));
  object.add("batch", std::to_string(query.batch));
  if (query.chain) {
    object.add("chain", std::to_string(query.chain->chain));
    object.add("from", listOf(query.chain->from, ",", appendNumber));
    object.add("to", listOf(query.chain->to, ",", appendNumber));
    object.add("base", poseText(query.worldFromMesh));
  } else {
    object.add("sensor", instanceText(query.sensor()));
  }
  if (query.motion) object.add("motion", listOf(*query.motion, ",", appendNumber));
  if (query.turn) {
    JsonObject turn;
    turn.add("axis", listOf(query.turn->axis, ",", appendNumber));
    turn.addNumber("angle", query.turn->angle);
    turn.add("centre", listOf(query.turn->centre, ",", appendNumber));
    object.add("turn", turn.text());
  }
  if (!takesStep(query)) {
    object.add("dir", listOf(query.direction, ",", appendNumber));
    object.addNumber("D", query.distance);
  }
  if (query.mode && !query.chain) object.addString("mode", nameOf(*query.mode));
  for (const QueryField& field : queryFields()) {
    if (isGiven(query, field)) addField(object, field, query);
  }
  return object.text();
}

}  // namespace

std::filesystem::path writeQueryFile(const Workload& workload, const std::filesystem::path& folder, bool binary) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": expected a folder, got " + error.message());

  std::string text = "{\"format\": \"cyber-radar-queries-1\",\n \"meshes\": [";
  for (size_t i = 0; i < workload.meshes.size(); ++i) {
    const std::string name = "mesh-" + std::to_string(i) + ".ply";
    writeAtomically(folder / name, plyOf(workload.meshes[i]));
    text += (i > 0 ? ", " : "") + quoted(name);
  }
  if (!workload.chains.empty()) {
    text += "],\n \"chains\": ";
    text += listOf(workload.chains, ",\n  ", [](std::string& to, const ChainSpec& chain) { to += chainText(chain); });
    text.pop_back();
  }
  text += "],\n \"scenes\": [";
  for (size_t i = 0; i < workload.scenes.size(); ++i) {
    const SceneSpec& scene = workload.scenes[i];
    std::string instanceFile;
    if (scene.instances.size() > kMostInline) {
      instanceFile = "scene-" + std::to_string(i) + ".npy";
      writePlaced(scene.instances, folder / instanceFile);
    }
    for (const Deformation& deformed : scene.deforms) {
      std::string bytes;
      for (float value : deformed.positions) appendBytes(bytes, value);
      writeAtomically(folder / positionsFile(i, deformed.mesh), bytes);
    }
    text += (i > 0 ? ",\n  " : "\n  ") + sceneText(scene, i, instanceFile);
  }
  if (binary) {
    writeBinaryQueries(workload.queries, folder / "queries.npy");
    text += "],\n \"queries_file\": \"queries.npy\"}\n";
  } else {
    text += "],\n \"queries\": [";
    for (size_t i = 0; i < workload.queries.size(); ++i) {
      text += (i > 0 ? ",\n  " : "\n  ") + queryText(workload.queries[i]);
    }
    text += "]}\n";
  }
  std::filesystem::path file = folder / "queries.json";
  writeAtomically(file, text);
  return file;
}

}  // namespace radar::tools
