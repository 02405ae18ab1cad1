// Places a mesh in a sensor's window; only depth is written. R and M differ only in the matrix. RADAR_LAYERS: a render pass
// has layers, which devices with shaderOutputLayer let this choose.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"

layout(scalar, binding = kSlotDraws) readonly restrict buffer Draws { Draw draws[]; };

layout(location = 0) in vec3 position;

void main() {
  const uint i = gl_InstanceIndex;
  const vec3 local = position - draws[i].origin;
  vec3 clip;
  for (int row = 0; row < 3; ++row) {
    clip[row] = dot(vec3(draws[i].clipFromMesh[4 * row], draws[i].clipFromMesh[4 * row + 1],
                         draws[i].clipFromMesh[4 * row + 2]), local) + draws[i].clipFromMesh[4 * row + 3];
  }
  gl_Position = vec4(clip, 1.0);
#ifdef RADAR_LAYERS
  gl_Layer = int(draws[i].layer);
#endif
}
