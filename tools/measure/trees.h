// The section of the chart that shows what trees cost.
#pragma once

#include "baselines/baseline.h"
#include "measure/case.h"
#include "measure/report.h"

namespace radar::tools {

using MeasureTree = std::optional<TreeCost>(const MeshData&, std::span<const float>, std::span<const Transform>);

/// Section trees, on all cores: a sphere of 10^5 to 10^7 triangles is added, and gets other waves; 10^6 boxes are added
/// and moved, with the tree over them. Adds a row to the part `trees` for each: the least of 1 to 15 times,
/// milliseconds, and the bytes held for each triangle or object, of ours and of another library's, if it is there.
void measureTrees(Extent extent, MeasureTree* other, Json& report);

}  // namespace radar::tools
