// Scenes as the method itself sees them: R of a disc that looks in from a corner of the cube in which boxes and teapots
// are, shaded by its slope.
#pragma once

#include "cyber_radar/canvas.h"
#include "workloads/vectors.h"
#include "workloads/workload.h"

namespace radar::tools {

/// The disc, in mesh coordinates; viewOf() places it.
MeshData viewingDisc(double side);
/// From the corner to the opposite one. `resolution`: pixels along the picture's side.
Query viewOf(uint32_t discMesh, double side, uint32_t resolution);

/// Where a place is in a picture that begins at (margin, margin).
std::pair<double, double> pixelOf(const Scopes& view, const Vec3& place, double margin);

/// Draws the surfaces of the view `all`. Where `moving`, a view of some of them, is as near, they are coloured.
void drawSurfaces(const Canvas& canvas, double margin, double side, const Scopes& all, const Scopes& moving);

}  // namespace radar::tools
