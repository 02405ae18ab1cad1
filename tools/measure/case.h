// The workloads of each section of the chart.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

/// How much: the counts of a full run, of a quick one, of a test.
enum class Extent { full, quick, least };

/// A workload with a place in the chart.
struct Case {
  std::string section;
  std::string workload;  ///< its name, which no other section has
  std::string about;
  std::string axis;  ///< what x is, where cases of one workload grow; empty: there is one, and a chart of its front
  double x = 0;
  std::function<Workload()> make;
};

/// Section front: the paper's Table 1 and Figure 7, convex, non-convex, interlocking, thin, grazing shapes.
std::vector<Case> frontCases(Extent extent);
/// Meshes in random poses; not empty.
Case meshesCase(Extent extent, std::vector<MeshData> meshes);
/// Section table1: teapots among 10,000 to 30,000 boxes.
std::vector<Case> table1Cases(Extent extent);
/// Section growth: more boxes, more sensors in a batch, more triangles of each mesh.
std::vector<Case> growthCases(Extent extent);

}  // namespace radar::tools
