// The workloads of each section of the chart.
#pragma once

#include <string>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

/// How much: the counts of a full run, of a quick one, of a test.
enum class Extent { full, quick, least };

/// A workload with a place in the chart.
struct Case {
  std::string section;  ///< front, table1 or growth
  std::string name, about;
  double x = 0;  ///< on its section's axis
  Workload workload;
};

/// Section front: the paper's Table 1 and Figure 7, convex, non-convex, interlocking, thin, grazing shapes.
std::vector<Case> frontCases(Extent extent);
/// Meshes in random poses; not empty.
Case meshesCase(Extent extent, std::vector<MeshData> meshes);
/// Section table1: teapots among 10,000 to 30,000 boxes; x is the number of boxes.
std::vector<Case> table1Cases(Extent extent);
/// Section growth: x is the number of boxes, of sensors in a batch, of triangles of each mesh, as the name says.
std::vector<Case> growthCases(Extent extent);

}  // namespace radar::tools
