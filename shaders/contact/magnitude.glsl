#include "shared/inner.glsl"
#include "shared/widen.glsl"

// radar::placedMagnitude.
double magnitudeOf(PreciseRows pose, MeshRecord mesh) {
  const dvec3 origin = widened(floatBitsToUint(mesh.origin));
  const dvec3 most = max(abs(origin + widened(floatBitsToUint(mesh.lo))), abs(origin + widened(floatBitsToUint(mesh.hi))));
  double greatest = 0.0LF;
  for (int row = 0; row < 3; ++row) greatest = max(greatest, inner(abs(pose[row].xyz), most) + abs(pose[row].w));
  return greatest;
}
