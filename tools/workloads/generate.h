// The workloads of the demo, the tests and the benchmarks. Equal arguments give equal bits on every platform.
#pragma once

#include <cstdint>
#include <vector>

#include "workloads/shapes.h"
#include "workloads/workload.h"

namespace radar::tools {

enum class SensorShape { box, teapot };

/// Side of the cube of Table 1 and Figure 7.
inline constexpr double kCubeSide = 100;

/// The paper's Table 1: `boxes` (10,000 to 30,000) boxes of random size, place and rotation in one cube, so that their
/// density grows with their number, and one batch of `sensors` in random poses and directions, each placed where no
/// box is near its bounding sphere if 64 tries find such a place. Box sensors have edges of 1 to 3, teapots are 3 wide;
/// the boxes' edges are 0.3 to 1.5; D is 10. The first boxes of a larger scene are those of a smaller one.
struct Table1 {
  uint32_t boxes = 10'000;
  uint32_t sensors = 64;
  SensorShape shape = SensorShape::teapot;
  uint64_t seed = 1;
};
Workload makeWorkload(const Table1& options);

/// Finds a place for a sphere of that radius.
using PlaceFor = std::function<Vec3(double radius)>;
/// Adds Table 1's sensors to a workload whose mesh 0 is a unit box and whose mesh 1 is the teapot.
void addSensors(Workload& workload, Random& random, uint32_t count, SensorShape shape, const PlaceFor& placeFor);

/// The paper's Figure 7: `teapots` (5 to 30), 5 wide, fly straight on through `boxes` fixed boxes, one unit a step, and
/// turn where something is in the way. One scene a step, whose base is scene 0 (the boxes); teapot k is object `boxes`
/// + k and sensor k of the step's batch, looking 15 units ahead, itself excluded. The speed is one unit a second.
struct Figure7 {
  uint32_t teapots = 5;
  uint32_t boxes = 2'000;
  uint32_t steps = 20;
  uint64_t seed = 7;
};
Workload makeWorkload(const Figure7& options);

/// Boxes at one density (that of Table 1 at 10,000) in a cube that grows with their number, 1,000 to 1,000,000, and one
/// batch of sensors, as in Table 1.
struct Scale {
  uint32_t boxes = 100'000;
  uint32_t sensors = 64;
  SensorShape shape = SensorShape::teapot;
  uint64_t seed = 11;
};
Workload makeWorkload(const Scale& options);

/// A scene of one mesh, a city of about `triangles` triangles at one density, 10^4 to 10^7, and one batch of sensors,
/// shaped as in Table 1, in random poses half a unit to six above what is highest below them; D is 10.
struct OneMesh {
  uint32_t triangles = 1'000'000;
  uint32_t sensors = 64;
  SensorShape shape = SensorShape::teapot;
  uint64_t seed = 19;
};
Workload makeWorkload(const OneMesh& options);

/// Random triangle soups of each kind in turn, in random affine poses with scales of 0.3 to 2 and with mirrors, that
/// overlap, interlock and miss: one scene, one batch. `origin` moves everything along x, y and z.
struct Soups {
  uint32_t objects = 30;
  uint32_t sensors = 64;
  uint32_t triangles = 20;  ///< of each mesh
  double origin = 0;
  uint64_t seed = 13;
};
Workload makeWorkload(const Soups& options);

/// `pose` after the step that brings a mesh of makeSoup into a cube of edge 2 around the origin.
Transform normalised(Soup soup, const Transform& pose);

/// Given meshes in random poses: each is scaled so that its longest edge is 1 to 3, in a cube that gives an object 200
/// cubic units; the sensors are the meshes in turn, placed as in Table 1, D is 10. `meshes` must not be empty.
struct RandomPoses {
  std::vector<MeshData> meshes;
  uint32_t objects = 200;
  uint32_t sensors = 64;
  uint64_t seed = 17;
};
Workload makeWorkload(const RandomPoses& options);

}  // namespace radar::tools
