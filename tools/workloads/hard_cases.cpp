#include "workloads/hard_cases.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "workloads/shapes.h"
#include "workloads/turning_families.h"

namespace radar::tools {

namespace {

/// By quarter turns and whole steps half of the time, otherwise at random.
void placeAnywhere(HardCase& hard, Random& random) {
  const bool exact = random.oneIn(2);
  const Rotation frame = exact ? random.quarterTurns() : random.rotation();
  place(hard, frame, exact ? random.wholeVector(8) : random.inCube(10));
}

uint32_t meshIn(Workload& workload, const MeshData& mesh) {
  const auto found = std::find_if(workload.meshes.begin(), workload.meshes.end(), [&](const MeshData& known) {
    return known.indices == mesh.indices && known.positions == mesh.positions;
  });
  const auto number = static_cast<uint32_t>(found - workload.meshes.begin());
  if (found == workload.meshes.end()) workload.meshes.push_back(mesh);
  return number;
}

}  // namespace

void place(HardCase& hard, const Rotation& frame, const Vec3& origin) {
  const auto move = [&](Transform& pose) {
    const Transform old = pose;
    for (size_t row = 0; row < 3; ++row) {
      for (size_t column = 0; column < 4; ++column) {
        double sum = column == 3 ? origin[row] : 0;
        for (size_t k = 0; k < 3; ++k) sum += frame[3 * row + k] * old.m[4 * k + column];
        pose.m[4 * row + column] = sum;
      }
    }
  };
  move(hard.sensor.worldFromMesh);
  for (PlacedMesh& object : hard.objects) move(object.worldFromMesh);
  hard.direction = turned(frame, hard.direction);
  if (!hard.turn) return;
  hard.turn->axis = turned(frame, hard.turn->axis);
  hard.turn->centre = turned(frame, hard.turn->centre) + origin;
}

void resize(HardCase& hard, double factor) {
  for (double& value : hard.sensor.worldFromMesh.m) value *= factor;
  for (PlacedMesh& object : hard.objects) {
    for (double& value : object.worldFromMesh.m) value *= factor;
  }
  hard.distance *= factor;
  if (hard.turn) hard.turn->centre = factor * hard.turn->centre;
}

void moveVertices(PlacedMesh& placed, const Vec3& offset) {
  MeshData moved{placed.mesh.name, {}, {}};
  append(moved, placed.mesh, offset);
  placed.mesh = std::move(moved);
}

std::vector<std::string> namesOf(const std::vector<HardFamily>& families) {
  std::vector<std::string> names;
  for (const HardFamily& family : families) names.push_back(family.name);
  return names;
}

std::vector<std::string> hardFamilyNames() {
  return namesOf(hardFamilies());
}

const HardFamily& hardFamily(std::string_view name) {
  for (const std::vector<HardFamily>* families : {&hardFamilies(), &turningFamilies()}) {
    for (const HardFamily& family : *families) {
      if (family.name == name) return family;
    }
  }
  throw Error("no family of hard cases is called \"" + std::string(name) + "\"");
}

HardCase hardCase(const HardFamily& family, uint64_t seed, uint64_t number) {
  Random random(seed * 1'000'003 + number);
  HardCase hard = family.make(family.values[number % family.values.size()], random);
  if (!family.placesItself) placeAnywhere(hard, random);
  if (!hard.turn && hard.objects.size() == 1 && random.oneIn(2)) {
    std::swap(hard.sensor, hard.objects[0]);
    hard.direction = -1 * hard.direction;
  }
  hard.ignoreLeaving = family.ignoresLeaving;
  hard.skipOverlapping = family.skipsOverlapping;
  return hard;
}

Workload sceneOf(const std::vector<HardCase>& cases, Company company) {
  assert(company == Company::mixed || cases.size() <= kIsolatedCases);
  Workload workload;
  SceneSpec scene{"cases", {}, {}, {}};
  for (size_t i = 0; i < cases.size(); ++i) {
    const HardCase& hard = cases[i];
    const uint32_t mask = company == Company::mixed ? ~0u : 1u << i;
    const auto firstObject = static_cast<uint32_t>(scene.instances.size());
    for (const PlacedMesh& object : hard.objects) {
      if (mask != ~0u) scene.masks.emplace_back(static_cast<uint32_t>(scene.instances.size()), mask);
      scene.instances.push_back({meshIn(workload, object.mesh), object.worldFromMesh});
    }
    QuerySpec query;
    query.id = std::to_string(i);
    query.setSensor({meshIn(workload, hard.sensor.mesh), hard.sensor.worldFromMesh});
    if (hard.turn) {
      query.turn = hard.turn;
      query.motion = hard.distance * hard.direction;
    } else {
      query.direction = hard.direction;
      query.distance = hard.distance;
    }
    query.mask = mask;
    for (const uint32_t object : hard.exclude) query.exclude.push_back(firstObject + object);
    query.ignoreLeaving = hard.ignoreLeaving;
    query.skipOverlapping = hard.skipOverlapping;
    query.slack = hard.slack;
    workload.queries.push_back(std::move(query));
  }
  workload.scenes.push_back(std::move(scene));
  return workload;
}

Workload hardScene(const HardFamily& family, uint64_t seed, uint64_t first, uint32_t count, Company company) {
  std::vector<HardCase> cases;
  for (uint64_t i = first; i < first + count; ++i) cases.push_back(hardCase(family, seed, i));
  return sceneOf(cases, company);
}

void setMotions(const Workload& workload, Random& random, Scene& scene) {
  const auto count = static_cast<uint32_t>(workload.queries.size());
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    const double way = random.magnitude(-6, 0) * workload.queries[random.below(count)].distance;
    Vec3 motion = random.oneIn(3) ? random.axis() : random.direction();
    for (double& c : motion) c *= std::min(way, 1e200);
    if (!random.oneIn(4) && scene.hasObject(id)) scene.setMotion(id, motion);
  }
}

void takeStep(Query& query) {
  const double perLength = query.distance / std::hypot(query.direction[0], query.direction[1], query.direction[2]);
  query.motion = query.direction;
  for (double& c : *query.motion) c *= perLength;
  query.direction = {};
  query.distance = 0;
}

}  // namespace radar::tools
