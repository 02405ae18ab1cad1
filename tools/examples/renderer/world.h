// The city and the agents: as the engine's scene, and as what is drawn.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "radar/cpu_sweeper.h"
#include "radar/scene.h"
#include "shared.h"

namespace example {

using Triangles = std::vector<vec3>;  ///< three corners each

/// Adds a box around `centre`, turned about the vertical by `angle`.
inline void addBox(Triangles& to, const vec3& centre, const vec3& half, float angle = 0) {
  const float c = std::cos(angle), s = std::sin(angle);
  for (const uint32_t i :
       {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5}) {
    const float x = (i & 1) != 0 ? half[0] : -half[0], y = (i & 2) != 0 ? half[1] : -half[1];
    const float z = (i & 4) != 0 ? half[2] : -half[2];
    to.push_back({centre[0] + c * x - s * y, centre[1] + s * x + c * y, centre[2] + z});
  }
}

/// Four rings of boxes around a body: another agent's corner fits into them.
inline Triangles makeDrone() {
  const float quarter = 1.5707964f;
  Triangles drone;
  addBox(drone, {0.02f, 0, 0}, {0.24f, 0.15f, 0.09f});
  for (int arm = 0; arm < 4; ++arm) {
    const float turn = (static_cast<float>(arm) + 0.5f) * quarter, x = std::cos(turn), y = std::sin(turn);
    addBox(drone, {0.3f * x, 0.3f * y, 0.02f}, {0.14f, 0.03f, 0.025f}, turn);
    for (int side = 0; side < 8; ++side) {
      const float around = 0.5f * static_cast<float>(side) * quarter;
      addBox(drone, {0.62f * x + 0.27f * std::cos(around), 0.62f * y + 0.27f * std::sin(around), 0.02f},
             {0.04f, 0.12f, 0.05f}, around);
    }
  }
  return drone;
}

class World {
 public:
  /// Places so many agents above the city, where they touch nothing.
  explicit World(uint32_t count)
      : agent(makeDrone()),
        half(kPitch * std::ceil(std::max(36.0f, 1.3f * std::sqrt(static_cast<float>(count))) / kPitch)) {
    addBox(building, {0, 0, 0.5f}, {0.5f, 0.5f, 0.5f});
    agentMesh = addMesh(agent);
    buildingMesh = addMesh(building);

    // Agents first, layer upon layer.
    const float spacing = 2.5f, highest = 48;
    const auto row = static_cast<uint32_t>(2 * half / spacing);
    for (uint32_t i = 0; i < count; ++i) {
      const auto along = [&](uint32_t k) { return spacing * static_cast<float>(k % row) - half; };
      const vec3 place{along(i), along(i / row), highest + spacing * static_cast<float>(i / row / row)};
      agents.push_back({.place = place, .clear = kReach, .goal = 0});
      addObject(agentMesh, place, {1, 1, 1});
    }

    // Towers around a square, the farther out, the higher; and the ground.
    auto random = [engine = std::mt19937(2024)]() mutable { return static_cast<float>(engine() >> 8) / (1 << 24); };
    const int blocks = static_cast<int>(std::lround(half / kPitch));
    for (int i = -blocks; i < blocks; ++i) {
      for (int j = -blocks; j < blocks; ++j) {
        if ((i == -1 || i == 0) && (j == -1 || j == 0)) continue;
        const float x = (static_cast<float>(i) + 0.5f) * kPitch, y = (static_cast<float>(j) + 0.5f) * kPitch;
        const float outward = std::min(1.0f, std::hypot(x, y) / 60);
        const float wide = 7 + 3 * random(), deep = 7 + 3 * random(), high = 3 + 7 * random() + 16 * outward * random();
        addObject(buildingMesh, {x, y, -1}, {wide, deep, high + 1});
        if (random() < 0.6f)
          addObject(buildingMesh, {x, y, high}, {0.6f * wide, 0.6f * deep, 1 + 0.5f * high * random()});
      }
    }
    addObject(buildingMesh, {0, 0, -1}, {20 * half, 20 * half, 1});
  }

  /// Tells the scene where the agents are, and counts those that touch or cross anything, exactly.
  uint32_t crossings(const std::vector<Agent>& now) {
    std::vector<radar::Query> queries;
    for (radar::ObjectId id = 0; id < now.size(); ++id) {
      radar::Transform pose;
      for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] = now[id].place[k];
      scene.setTransform(id, pose);
      queries.push_back({.mesh = agentMesh, .worldFromMesh = pose, .direction = {0, 0, 1}, .exclude = {id}});
    }
    const std::vector<radar::Result> found = sweeper_.run(queries).results;
    return static_cast<uint32_t>(std::count_if(
        found.begin(), found.end(), [](const radar::Result& result) { return result.status != radar::Status::clear; }));
  }

  radar::Scene scene;  ///< objects 0, 1, 2, ... are the agents, and those after them the buildings
  Triangles agent, building;
  radar::MeshId agentMesh, buildingMesh;
  std::vector<Agent> agents;                      ///< at the beginning
  std::vector<std::array<float, 12>> transforms;  ///< of all objects, at the beginning
  float half;                                     ///< of the city's side

 private:
  radar::MeshId addMesh(const Triangles& triangles) {
    std::vector<uint32_t> indices(triangles.size());
    std::iota(indices.begin(), indices.end(), 0u);
    return scene.addMesh({triangles.front().data(), 3 * triangles.size()}, indices);
  }
  void addObject(radar::MeshId mesh, const vec3& at, const vec3& size) {
    transforms.push_back({size[0], 0, 0, at[0], 0, size[1], 0, at[1], 0, 0, size[2], at[2]});
    radar::Transform pose;
    std::copy(transforms.back().begin(), transforms.back().end(), pose.m.begin());
    scene.addObject({.mesh = mesh, .worldFromMesh = pose});
  }

  radar::CpuSweeper sweeper_{scene};
};

}  // namespace example
