// How the cases of each stability family are made. In a maker's own frame the sensor moves along +z unless it says
// otherwise, and is made for being turned and moved as a whole.
#pragma once

#include <vector>

#include "workloads/placement.h"
#include "workloads/workload.h"

namespace radar::tools {

struct PlacedMesh {
  MeshData mesh;
  Transform worldFromMesh;
};

/// One sweep among a few objects.
struct StabilityCase {
  PlacedMesh sensor;
  std::vector<PlacedMesh> objects;
  Vec3 direction{0, 0, 1};
  double distance = 0;
};

/// Turns everything by `frame`, then moves it.
void place(StabilityCase& made, const Rotation& frame, const Vec3& origin);
/// By quarter turns and whole steps half of the time, else at random.
void placeAnywhere(StabilityCase& made, Random& random);

StabilityCase thinCase(double pixels, Random& random);
StabilityCase edgeOnCase(double angle, Random& random);
StabilityCase slopeCase(double degrees, Random& random);
StabilityCase touchingCase(double when, Random& random);
StabilityCase ulpCase(double ulps, Random& random);  ///< placed already
StabilityCase nearCase(double gap, Random& random);
StabilityCase depthCase(double depth, Random& random);
StabilityCase containmentCase(double ratio, Random& random);
StabilityCase degenerateCase(double kind, Random& random);
StabilityCase farPosedCase(double distance, Random& random);  ///< placed already
StabilityCase farBakedCase(double distance, Random& random);  ///< placed already
StabilityCase scaleCase(double scale, Random& random);
StabilityCase floorCase(double size, Random& random);
StabilityCase directionCase(double off, Random& random);
StabilityCase distanceCase(double distance, Random& random);
StabilityCase singleCase(double which, Random& random);
StabilityCase openCase(double cells, Random& random);
StabilityCase crossingCase(double copies, Random& random);
StabilityCase tiesCase(double objects, Random& random);
/// `Which`: of interlockedShapes.
StabilityCase interlockedCase(size_t which, double angle, Random& random);

}  // namespace radar::tools
