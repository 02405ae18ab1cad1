// What a sensor can reach: its window along the motion, and the objects in its swept prism (tier select).
#pragma once

#include <vector>

#include "math/frame.h"
#include "sampled/select.h"

namespace radar {

/// Half an ulp of 1 in float.
inline constexpr double kFloatUnit = 0x1p-24;

/// Where the sensor is, in the frame of its view.
struct SensorWindow {
  std::array<Vector, 3> axes;  ///< of the frame, world; the last along the motion
  Vector origin;               ///< of the frame, world: the sensor's centre
  Affine frameFromMesh;        ///< from recentred vertices
  Box box;                     ///< the sensor's extents, widened by `margin` across
  double length;               ///< of the sensor along the motion
  double margin;               ///< world units
  double error;                ///< how far a vertex that a shader places may be off
  double size;                 ///< greatest extent
};

SensorWindow lookAlong(const Query& query, const Mesh& sensor);

struct SelectedObject {
  ObjectId object;
  Affine frameFromMesh;  ///< from recentred vertices
  double error;          ///< how far a vertex that a shader places may be off
  Box box;               ///< around it, and around all that a host may make of it
};

struct Selection {
  Prism prism;                          ///< the sensor's window, swept
  std::vector<SelectedObject> objects;  ///< those in it, by id; none: certainly clear
  double depth = 0;                     ///< from the back plane to the farthest of them, sensor length + D at most
  double error = 0;                     ///< the greatest placement error
};

Selection selectionOf(const Query& query, const Scene::Impl& scene, const SensorWindow& window);

/// What double precision may lose of a point within `box`, placed in the world and seen from `origin`, world units.
double doubleErrorWithin(const Box& box, const Vector& origin);

/// Whether the query leaves the object out, by its mask or by name.
bool isExcluded(const Query& query, const Object& object, ObjectId id);

/// Whether no entry of the matrix and no vertex that it places is beyond what a float can say.
bool fitsFloats(const Mesh& mesh, const Affine& frameFromMesh);

/// How far a vertex that a shader places may lie from the true one, world units (docs/method.md, "Placement in the
/// pictures").
double placementError(const Mesh& mesh, const Affine& frameFromMesh);

}  // namespace radar
