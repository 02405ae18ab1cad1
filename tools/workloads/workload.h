// A workload: meshes, scenes that place them, and queries. It is what a query file says, in memory: the generators make
// one, tools/batch reads and writes one. Mesh and object ids are numbers in it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radar/chain.h"
#include "radar/radar.h"

namespace radar::tools {

/// A triangle mesh that owns its numbers. `name` is for people, and for the file it is written to.
struct MeshData {
  std::string name;
  std::vector<float> positions;   ///< 3 per vertex
  std::vector<uint32_t> indices;  ///< 3 per triangle
  /// Of a round sensor (radar/shapes.h); a query's clearance includes that of its mesh. No object has such a mesh.
  double radius = 0;
  Cutter cutter{};  ///< if it has parts, the triangles only show it; nor is it an object's
  uint32_t vertexCount() const { return static_cast<uint32_t>(positions.size() / 3); }
  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
};

/// A mesh of the workload, placed.
struct Instance {
  uint32_t mesh = 0;
  Transform worldFromMesh;
  friend bool operator==(const Instance&, const Instance&) = default;
};

using ObjectMask = std::pair<uint32_t, uint32_t>;                 ///< object, bits
using ObjectMotion = std::pair<uint32_t, std::array<double, 3>>;  ///< object, displacement during the step

/// New positions of all vertices of a mesh.
struct Deformation {
  uint32_t mesh = 0;
  std::vector<float> positions;
};

/// The base's objects have the first numbers, `instances` the next. A base has no base itself and comes earlier.
struct SceneSpec {
  std::string id;
  std::optional<uint32_t> base;
  std::vector<Instance> instances;
  std::vector<ObjectMask> masks;      ///< every other object has all bits
  std::vector<ObjectMotion> motions;  ///< every other object rests
  std::vector<Deformation> deforms;   ///< each mesh once; not inherited from the base, as masks and motions
  std::vector<std::string> names;     ///< of the instances, if they are the parts of an assembly; else empty
};

/// A chain with what only files say of it.
struct ChainSpec : Chain {
  std::vector<std::string> linkNames, variableNames;
};

/// A chain's way: from a configuration to another.
struct ChainWay {
  uint32_t chain = 0;
  std::vector<double> from, to;
  friend bool operator==(const ChainWay&, const ChainWay&) = default;
};

/// Which mesh of a chain touches something, and that of which other link, if it does; else kNone. As in ChainResult.
struct LinksMet {
  uint32_t link = kNone, mesh = kNone, otherLink = kNone, otherMesh = kNone;
};

/// How an answer is found.
enum class AnswerMode { sampled, contact, reference };

/// A query with what only files say of it.
struct QuerySpec : Query {
  std::string id;
  uint32_t scene = 0;
  std::optional<ChainWay> chain;   ///< moves instead of a sensor: `mesh` is kNone, and `worldFromMesh` places the base
  uint64_t batch = 0;              ///< queries of one scene and one batch number are answered in one submission
  std::optional<AnswerMode> mode;  ///< overrides the command's
  std::optional<double> speed;     ///< units per second

  Instance sensor() const { return {mesh, worldFromMesh}; }
  void setSensor(const Instance& placed) { mesh = placed.mesh, worldFromMesh = placed.worldFromMesh; }
};

/// The clearance of a query that asks for one beside the radius of its mesh. One that breaks its contract stays wrong.
inline double withRadius(double clearance, double radius) {
  return clearance >= 0 && clearance <= std::numeric_limits<double>::max() - radius ? clearance + radius : clearance;
}

/// Whether its answer's bracket is one of fractions.
inline bool takesStep(const Query& query) {
  return query.motion || query.turn;
}
inline bool takesStep(const QuerySpec& query) {
  return query.chain || takesStep(static_cast<const Query&>(query));
}

struct Workload {
  std::vector<MeshData> meshes;
  std::vector<ChainSpec> chains;
  std::vector<SceneSpec> scenes;
  std::vector<QuerySpec> queries;

  /// The objects that a scene has from its base.
  std::span<const Instance> baseOf(uint32_t scene) const;
  /// Objects of a scene, its base's included.
  uint32_t objectCount(uint32_t scene) const;
  const Instance& instance(uint32_t scene, uint32_t object) const;
  /// The names of a scene's objects, empty for those that have none; no names if none has one.
  std::vector<std::string> objectNames(uint32_t scene) const;
};

/// The queries alone, to be drawn with that resolution.
std::vector<Query> queriesOf(std::span<const QuerySpec> specs, uint32_t resolution = 0);

/// Greatest extent of the placed sensor's box.
double sensorSize(const Scene& scene, const Query& query);

/// What a query asks of its chain; the configurations stay in the query.
ChainQuery chainQueryOf(const QuerySpec& query);

/// The queries of one scene, one batch number and one mode; of one chain, if they are of chains.
struct Batch {
  uint32_t scene = 0;
  AnswerMode mode = AnswerMode::contact;
  std::optional<uint32_t> chain;
  std::vector<Query> queries;     ///< or else:
  std::vector<ChainQuery> moves;  ///< whose configurations are those of the given ones
  std::vector<uint32_t> numbers;  ///< where they stand among the given ones
};
/// In the order of first appearance. `mode`: of queries that do not choose one.
std::vector<Batch> batchesOf(std::span<const QuerySpec> specs, uint32_t resolution = 0,
                             AnswerMode mode = AnswerMode::contact);

/// Makes `to` hold the workload's meshes and one of its scenes, under the workload's numbers, and nothing else.
void replaceBy(const Workload& workload, uint32_t scene, Scene& to);

/// Shows a workload's scenes in one radar::Scene, whose mesh and object ids are the workload's numbers. An object that
/// two scenes share stays as it is; one that only moved is moved.
class ScenePlayer {
 public:
  /// Adds all meshes, shows nothing yet. The workload must outlive the player.
  explicit ScenePlayer(const Workload& workload);

  void show(uint32_t scene);
  const Scene& scene() const { return scene_; }

 private:
  void showObject(const Object& object, ObjectId id);
  void deform(uint32_t scene);

  const Workload& workload_;
  Scene scene_;
  std::optional<uint32_t> shown_;
};

}  // namespace radar::tools
