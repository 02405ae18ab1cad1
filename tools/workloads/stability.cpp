#include "workloads/stability.h"

#include <algorithm>
#include <utility>

namespace radar::tools {

namespace {

template <size_t which>
StabilityCase interlocked(double angle, Random& random) {
  return interlockedCase(which, angle, random);
}

/// 10^first, 10^(first + step) ... 10^last.
std::vector<double> powers(int first, int last) {
  std::vector<double> values;
  for (int k = first; k != last; k += first < last ? 1 : -1) values.push_back(powerOfTen(k));
  values.push_back(powerOfTen(last));
  return values;
}

std::vector<double> zeroAnd(std::vector<double> values) {
  values.insert(values.begin(), 0);
  return values;
}

std::vector<StabilityFamily> makeFamilies() {
  const std::string turn = "turned out of place by about as many radians";
  const std::vector<double> turns = zeroAnd(powers(-1, -6));
  return {
      {"thin", "width of a rod, in pixels of a 64 x 64 scope", powers(0, -6), thinCase},
      {"edge-on", "angle between a plate and the motion, radians", zeroAnd(powers(-1, -12)), edgeOnCase},
      {"slope",
       "angle between a face and the plane across the motion, degrees",
       {80, 85, 89, 89.9, 89.99, 89.999},
       slopeCase},
      {"touching", "contact exactly: 0 at the start, 1 in flight, 2 at D", {0, 1, 2}, touchingCase},
      {"ulp", "units in the last place by which an exact contact is missed", {-1, 0, 1, 2}, ulpCase, true},
      {"near", "sideways gap of a near miss, or overlap of a near hit", powers(-3, -9), nearCase},
      {"depth", "depth of the initial overlap", powers(0, -9), depthCase},
      {"containment", "size of the inner shape, of the outer one", {0.9, 0.5, 0.1, 0.01}, containmentCase},
      {"degenerate",
       "0 points, 1 segments, 2 doubled corners, 3 spikes, 4 slivers, 5 duplicates",
       {0, 1, 2, 3, 4, 5},
       degenerateCase},
      {"far pose", "distance from the origin, by the pose", powers(1, 7), farPosedCase, true},
      {"far baked", "distance from the origin, in the vertices", powers(1, 7), farBakedCase, true},
      {"scale", "size of everything", powers(-4, 4), scaleCase},
      {"floor", "size of a sensor beside a floor of 10^4", powers(0, -2), floorCase},
      {"direction", "how far the direction is off an axis", zeroAnd(powers(-2, -12)), directionCase},
      {"distance", "D", {0, 1e-300, 1e-12, 1e-6, 1, 1e6, 1e12}, distanceCase},
      {"single", "one triangle: 0 as sensor and scene, 1 as sensor, 2 as scene", {0, 1, 2}, singleCase},
      {"open", "cells along the side of an open sheet", {1, 2, 4, 8, 16}, openCase},
      {"crossing", "1 surfaces that cross themselves, 2 and 3 as many copies in one place", {1, 2, 3}, crossingCase},
      {"ties", "objects hit at exactly the same t", {2, 4, 16, 64}, tiesCase},
      {"ring on peg", turn, turns, interlocked<0>},
      {"ring through ring", turn, turns, interlocked<1>},
      {"hook behind bar", turn, turns, interlocked<2>},
      {"ball in cup", turn, turns, interlocked<3>},
      {"comb in comb", turn, turns, interlocked<4>},
      {"ball in teapot", turn, turns, interlocked<5>},
      {"key in keyhole", turn, turns, interlocked<6>},
  };
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

const std::vector<StabilityFamily>& stabilityFamilies() {
  static const std::vector<StabilityFamily> families = makeFamilies();
  return families;
}

StabilityCase stabilityCase(const StabilityFamily& family, uint64_t number, uint64_t seed) {
  Random random(seed * 1'000'003 + number);
  StabilityCase made = family.make(family.values[number % family.values.size()], random);
  if (!family.placesItself) placeAnywhere(made, random);
  if (made.objects.size() == 1 && random.oneIn(2)) {
    std::swap(made.sensor, made.objects[0]);
    made.direction = scaled(made.direction, -1);
  }
  return made;
}

Workload workloadOf(const std::vector<StabilityCase>& cases) {
  Workload workload;
  SceneSpec scene{"cases", {}, {}, {}};
  for (size_t i = 0; i < cases.size(); ++i) {
    const StabilityCase& made = cases[i];
    for (const PlacedMesh& object : made.objects) {
      scene.masks.emplace_back(static_cast<uint32_t>(scene.instances.size()), 1u << i);
      scene.instances.push_back({meshIn(workload, object.mesh), object.worldFromMesh});
    }
    QuerySpec query;
    query.id = std::to_string(i);
    query.sensor = {meshIn(workload, made.sensor.mesh), made.sensor.worldFromMesh};
    query.direction = made.direction;
    query.distance = made.distance;
    query.mask = 1u << i;
    workload.queries.push_back(std::move(query));
  }
  workload.scenes.push_back(std::move(scene));
  return workload;
}

}  // namespace radar::tools
