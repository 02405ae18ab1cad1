// What ranks send each other, as bytes of cereal's binary format: all run the same program.
#pragma once

#include <cereal/archives/binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/common.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/vector.hpp>

#include <sstream>
#include <string>

#include "batch/query_file.h"
#include "workloads/workload.h"

namespace radar {

template <class Archive>
void serialize(Archive& archive, Transform& transform) {
  archive(transform.m);
}

namespace tools {

template <class Archive>
void serialize(Archive& archive, MeshData& mesh) {
  archive(mesh.name, mesh.positions, mesh.indices);
}

template <class Archive>
void serialize(Archive& archive, Instance& instance) {
  archive(instance.mesh, instance.worldFromMesh);
}

template <class Archive>
void serialize(Archive& archive, Deformation& deformed) {
  archive(deformed.mesh, deformed.positions);
}

template <class Archive>
void serialize(Archive& archive, SceneSpec& scene) {
  archive(scene.id, scene.base, scene.instances, scene.masks, scene.motions, scene.deforms, scene.names);
}

template <class Archive>
void serialize(Archive& archive, QuerySpec& query) {
  archive(query.id, query.scene, query.batch, query.mode, query.speed, query.mesh, query.worldFromMesh, query.exclude,
          query.direction, query.distance, query.motion, query.mask, query.anyHit, query.ignoreLeaving,
          query.skipOverlapping, query.slack, query.hits, query.clearance, query.tolerance);
}

template <class Archive>
void serialize(Archive& archive, ModesAsked& modes) {
  archive(modes.chosen, modes.byCommand, modes.exactOnly, modes.listed);
}

/// What every rank needs before the first chunk: meshes and scenes, with all that changes between batches.
struct Start {
  std::vector<MeshData> meshes;
  std::vector<SceneSpec> scenes;
  ModesAsked modes;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(meshes, scenes, modes);
  }
};

/// Consecutive queries; none: the work is done.
struct Chunk {
  uint64_t first = 0;
  std::vector<QuerySpec> queries;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(first, queries);
  }
};

/// The answers to a chunk, as rows of the answer file.
struct Answered {
  uint64_t first = 0, count = 0;
  std::string rows;
  double seconds = 0;
  bool someInvalid = false;
  std::string failure;  ///< what ended the rank, instead of answers
  template <class Archive>
  void serialize(Archive& archive) {
    archive(first, count, rows, seconds, someInvalid, failure);
  }
};

/// Who answers.
struct RankReport {
  std::string host, devices;
  std::string failure;  ///< why the rank cannot answer
  template <class Archive>
  void serialize(Archive& archive) {
    archive(host, devices, failure);
  }
};

template <class Message>
std::string packed(const Message& message) {
  std::ostringstream stream(std::ios::binary);
  cereal::BinaryOutputArchive archive(stream);
  archive(message);
  return std::move(stream).str();
}

template <class Message>
Message unpacked(std::string bytes) {
  std::istringstream stream(std::move(bytes), std::ios::binary);
  cereal::BinaryInputArchive archive(stream);
  Message message;
  archive(message);
  return message;
}

}  // namespace tools
}  // namespace radar
