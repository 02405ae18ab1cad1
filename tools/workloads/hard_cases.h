// Cases in which collision queries are known to fail, in families. Equal arguments give equal bits on every platform.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "workloads/random.h"
#include "workloads/workload.h"

namespace radar::tools {

struct PlacedMesh {
  MeshData mesh;
  Transform worldFromMesh;
};

/// One sweep among a few objects.
struct HardCase {
  PlacedMesh sensor;
  std::vector<PlacedMesh> objects;
  Vec3 direction{0, 0, 1};
  double distance = 0;
  std::vector<uint32_t> exclude = {};  ///< of the objects
  std::optional<Turn> turn = {};       ///< then the motion is the direction, times the distance
  bool ignoreLeaving = false, skipOverlapping = false;
  std::optional<double> slack = {};
};

/// Turns everything by `frame`, then moves it.
void place(HardCase& hard, const Rotation& frame, const Vec3& origin);
/// Scales everything by `factor`.
void resize(HardCase& hard, double factor);
/// Moves the vertices by `offset` in the mesh's own coordinates.
void moveVertices(PlacedMesh& placed, const Vec3& offset);

struct HardFamily {
  std::string name;
  std::string parameter;       ///< what the values mean, with their unit; empty: there is one kind of case
  std::vector<double> values;  ///< the cases take them in turn
  HardCase (*make)(double value, Random& random);
  bool placesItself = false;  ///< otherwise cases are turned and moved at random, half of them by exact steps
  bool ignoresLeaving = false, skipsOverlapping = false;  ///< what its queries ask for; mode sampled offers neither
};

const std::vector<HardFamily>& hardFamilies();
std::vector<std::string> hardFamilyNames();
std::vector<std::string> namesOf(const std::vector<HardFamily>& families);
/// Of all, also of those that turn (turning_families.h). Throws Error if there is no family of that name.
const HardFamily& hardFamily(std::string_view name);

/// Case `number` does not depend on which others are made. Sensor and object are swapped in half of the cases with one
/// object, but where the sensor turns.
HardCase hardCase(const HardFamily& family, uint64_t seed, uint64_t number);

/// How many cases fit into one scene in which each meets its own objects only: each takes one bit of the masks.
inline constexpr uint32_t kIsolatedCases = 32;

enum class Company {
  isolated,  ///< each case meets its own objects only
  mixed      ///< each case meets the objects of all
};

/// The cases as one scene and one batch of queries.
Workload sceneOf(const std::vector<HardCase>& cases, Company company);
/// `count` cases from number `first` on.
Workload hardScene(const HardFamily& family, uint64_t seed, uint64_t first, uint32_t count, Company company);

/// Lets most objects of a scene, made of `workload`, move by up to the D of one of its queries.
void setMotions(const Workload& workload, Random& random, Scene& scene);
/// Makes a query with a direction that of a step in which the sensor moves by D.
void takeStep(Query& query);

}  // namespace radar::tools
