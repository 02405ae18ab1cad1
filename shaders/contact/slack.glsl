// How far surfaces at rest may sink into each other by rounding.
#include "shared/bounded.glsl"
#include "magnitude.glsl"

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };

Bounded slackOf(Sweep sweep, RefinedPair c) {
  if (sweep.slack >= 0.0LF) return Bounded(sweep.slack, 0.0LF);
  const double magnitude = max(sweep.magnitude, magnitudeOf(objects[c.object].pose, meshes[objects[c.object].mesh]));
  const double value = 3.552713678800501e-15LF * magnitude;  // 2^-48
  return Bounded(value, 3.8e-6LF * value);                   // more than the rounding of a box to floats
}
