// Objects where a host's transforms put them: first their placements, in the frames of the sensors that may reach them, then
// their poses; an invocation each. What arithmetic loses is added to the placement's error (docs/method.md, "A host's
// geometry").
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kBindMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kBindObjects) restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kBindPlacements) restrict buffer Placements { Placement placements[]; };
layout(scalar, binding = kBindMoved) readonly restrict buffer MovedObjects { Moved movedObjects[]; };
#include "double_bits.glsl"
#include "words.glsl"

layout(push_constant) uniform Push { uint count; uint groupsX; uint placements; } push;

const float kUnit = 5.9604645e-8;  // 2^-24

struct Transform {
  uvec4 bits[3];
  bool isFinite;
  bvec3 flushes;  // a row has an entry that a device may take for 0
};

Transform transformOf(Moved moved) {
  Transform t;
  t.isFinite = true;
  for (uint row = 0; row < 3; ++row) {
    for (uint k = 0; k < 4; ++k) t.bits[row][k] = wordAt(moved.firstByte + 16 * row + 4 * k);
    t.isFinite = t.isFinite && all(notEqual(t.bits[row] >> 23 & 0xffu, uvec4(0xffu)));
    t.flushes[row] = any(lessThan((t.bits[row].xyz & 0x7fffffffu) - 1u, uvec3(0x7fffffu)));
  }
  return t;
}

// The mesh about the anchor: its middle, and how far it reaches; `sum`: what the middle is the sum of.
void middleOf(Transform t, Moved moved, MeshRecord mesh, out vec3 middle, out vec3 reach, out vec3 sum) {
  for (int row = 0; row < 3; ++row) {
    const vec4 m = uintBitsToFloat(t.bits[row]);
    const float offset = m.w - moved.anchor[row];
    sum[row] = dot(abs(m.xyz), abs(mesh.centre)) + abs(offset);
#ifdef RADAR_NO_DOUBLES
    middle[row] = dot(m.xyz, mesh.centre) + offset;
#else
    // A mesh far from its origin keeps its precision.
    middle[row] = float(dot(dvec3(m.xyz), dvec3(mesh.centre)) + (double(m.w) - double(moved.anchor[row])));
    sum[row] = abs(middle[row]) + 1.5e-8 * sum[row];
#endif
    reach[row] = dot(abs(m.xyz), mesh.halfExtent);
  }
}

// Whether it may be out of its bounds. What overflows may be no number in `middle`, but is infinite in `sum` or `reach`.
bool strays(Transform t, Moved moved, MeshRecord mesh, vec3 middle, vec3 reach, vec3 sum) {
  const vec3 coordinates = abs(mesh.centre) + mesh.halfExtent;
  const vec3 flushed = vec3(t.flushes) * (1.2e-38 * (coordinates.x + coordinates.y + coordinates.z));
  const vec3 lost = 16.0 * kUnit * (sum + reach) + flushed;
  return !t.isFinite || any(greaterThan(sum + reach, vec3(1e37))) ||
         !all(lessThanEqual(abs(middle) + reach + lost, moved.halfExtent));
}

void place(uint i) {
  const Moved moved = movedObjects[placements[i].moved];
  const MeshRecord mesh = meshes[moved.mesh];
  const Transform t = transformOf(moved);
  vec3 middle, reach, sum;
  middleOf(t, moved, mesh, middle, reach, sum);
  Rows frameFromMesh;
  float most = 0.0, entries = 0.0;
  for (int row = 0; row < 3; ++row) {
    const vec4 axis = placements[i].frameFromMesh[row];
    for (int k = 0; k < 3; ++k) {
      frameFromMesh[row][k] = dot(axis.xyz, uintBitsToFloat(uvec3(t.bits[0][k], t.bits[1][k], t.bits[2][k])));
    }
    frameFromMesh[row].w = dot(axis.xyz, middle) + axis.w;
    most = max(most, abs(axis.w) + dot(abs(axis.xyz), sum + reach));
    entries = max(entries, dot(abs(frameFromMesh[row].xyz), vec3(1.0)));
  }
  const vec3 coordinates = abs(mesh.centre) + mesh.halfExtent;
  float lost = 48.0 * kUnit * most + 1e-36 + 1e-37 * (coordinates.x + coordinates.y + coordinates.z + entries);
  const bool astray = strays(t, moved, mesh, middle, reach, sum);
  if (astray || !(most < 1e37 && entries < 1e37)) {
    // What has strayed counts no more, but must not send the search astray. What else float cannot place is solved in
    // double precision.
    frameFromMesh = Rows(vec4(0.0), vec4(0.0), vec4(0.0));
    lost = astray ? 1e36 : uintBitsToFloat(0x7f800000u);
  }
  placements[i].frameFromMesh = frameFromMesh;
  placements[i].error += lost;
}

void tellPose(Moved moved) {
  const Transform t = transformOf(moved);
  vec3 middle, reach, sum;
  middleOf(t, moved, meshes[moved.mesh], middle, reach, sum);
  if (strays(t, moved, meshes[moved.mesh], middle, reach, sum)) {
    atomicMin(stray.object, moved.object);
    return;
  }
  for (uint row = 0; row < 3; ++row) {
    const uvec2 x = doubleBits(t.bits[row].x), y = doubleBits(t.bits[row].y), z = doubleBits(t.bits[row].z),
                w = doubleBits(t.bits[row].w);
#ifdef RADAR_NO_DOUBLES
    objects[moved.object].pose[2 * row] = uvec4(x, y);
    objects[moved.object].pose[2 * row + 1] = uvec4(z, w);
#else
    objects[moved.object].pose[row] =
        dvec4(packDouble2x32(x), packDouble2x32(y), packDouble2x32(z), packDouble2x32(w));
#endif
  }
}

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX) * 64 + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  if (i >= push.placements) {
    tellPose(movedObjects[i - push.placements]);
  } else if (placements[i].moved != kNobody) {
    place(i);
  }
}
