// The city, its terrain and the agents: as the engine's scene, and as what is drawn.
#pragma once

#include <vector>

#include "radar/cpu_sweeper.h"
#include "radar/scene.h"
#include "shared.h"

namespace example {

/// A mesh as it is uploaded. The fourth number of a walker's vertex says to which leg it belongs, that of the terrain's
/// how much sun it gets.
struct Mesh {
  std::vector<vec4> vertices;
  std::vector<uint32_t> indices;
};

/// Objects of one mesh, one after another.
struct Model {
  uint kind;
  Mesh mesh;
  radar::ObjectId first = 0;
  uint32_t count = 0;
};

class World {
 public:
  /// Places agents where they touch nothing, some of them walkers.
  explicit World(uint32_t agents);

  /// Tells the scene where the agents are, and counts those that touch or cross anything, exactly. `transforms`: of
  /// the agents; `skinned`: two shapes of each walker, of which it has the second if it has advanced in this frame.
  uint32_t crossings(const std::vector<std::array<float, 12>>& transforms, const std::vector<vec3>& skinned,
                     const std::vector<Agent>& states, uint32_t frame);
  /// How far a camera may be from `target` towards `eye` without a building or a hill in between.
  double boom(const vec3& target, const vec3& eye);

  radar::Scene scene;                             ///< objects 0, 1, 2, ... are the agents, walkers first
  std::vector<radar::MeshId> bodies, nextBodies;  ///< of walkers: as they stand, and in the next phase
  std::vector<Model> models;                      ///< what is drawn: walkers, drones, buildings, terrain
  std::vector<Agent> agents;                      ///< at the beginning
  std::vector<std::array<float, 12>> transforms;  ///< of all objects, at the beginning
  uint32_t walkers = 0;
  float half;  ///< of the city's side

 private:
  void addCity();
  void addTerrain();
  std::vector<vec3> freePlaces(const Mesh& mesh, uint32_t most, float within, float spacing, float lowest,
                               float highest);
  void addAgent(const vec3& place, radar::MeshId body, radar::MeshId sensor, float radius, float speed);

  radar::Scene city_;  ///< what never moves
  radar::CpuSweeper cityRays_{city_}, sceneRays_{scene};
  radar::MeshId camera_ = radar::kNone;  ///< a box around it
};

}  // namespace example
