// The objects that a sensor can reach: those in its swept prism (tier select).
#pragma once

#include <vector>

#include "math/frame.h"
#include "sampled/select.h"

namespace radar {

/// Half an ulp of 1 in float.
inline constexpr double kFloatUnit = 0x1p-24;

/// The sensor in the frame of its view.
struct SensorWindow {
  std::array<Vector, 3> axes;  ///< of the frame, in world coordinates; the last along the motion
  Vector origin;               ///< of the frame, in world coordinates: the sensor's centre
  Affine frameFromMesh;        ///< from recentred vertices
  Box box;                     ///< the sensor's extents, widened by `margin` across
  double length;               ///< of the sensor along the motion
  double margin;               ///< world units
  double error;                ///< bound on the error of a vertex placed by a shader
  double size;                 ///< greatest extent
};

SensorWindow lookAlong(const Query& query, const Mesh& sensor);

struct SelectedObject {
  ObjectId object;
  Affine frameFromMesh;  ///< from recentred vertices
  double error;          ///< bound on the error of a vertex placed by a shader
  Box box;               ///< around the object, within a host's bounds included
};

struct Selection {
  Prism prism;                          ///< the sensor's window, swept
  std::vector<SelectedObject> objects;  ///< objects in the prism, by id; none: certainly clear
  double depth = 0;                     ///< from the back plane to the farthest of them, at most sensor length + D
  double error = 0;                     ///< the greatest placement error
};

Selection selectionOf(const Query& query, const Scene::Impl& scene, const SensorWindow& window);

/// Bound on the double-precision error of a point within `box`, placed in the world, relative to `origin`, world units.
double doubleErrorWithin(const Box& box, const Vector& origin);

/// Whether floats hold every entry of the matrix and every vertex that it places.
bool fitsFloats(const Mesh& mesh, const Affine& frameFromMesh);

/// Bound on the error of a vertex placed by a shader, world units (docs/method.md, "Placement in the pictures").
double placementError(const Mesh& mesh, const Affine& frameFromMesh);

}  // namespace radar
