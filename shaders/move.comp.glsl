// Objects where a host's transforms put them, an invocation each: their poses, exactly, and their placements, with what
// arithmetic loses of these (docs/method.md, "A host's geometry").
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotObjects) writeonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kSlotPlacements) writeonly restrict buffer Placements { Placement placements[]; };
layout(scalar, binding = kSlotMoved) readonly restrict buffer MovedObjects { Moved movedObjects[]; };
layout(scalar, binding = kSlotStray) restrict buffer Strays { Stray stray; };
#include "double_bits.glsl"
#include "words.glsl"
#include "workgroup.glsl"

layout(push_constant) uniform Push { uint count; } push;

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

// Where the mesh's origin is, as the sum of two floats, and how far that may be off.
struct Position {
  vec3 high, low, error;
};

Position positionOf(Transform t, vec3 origin) {
  Position p;
  for (int row = 0; row < 3; ++row) {
    const vec4 m = uintBitsToFloat(t.bits[row]);
    const float sum = dot(abs(m.xyz), abs(origin));
#ifdef RADAR_NO_DOUBLES
    // Exact where the origin is 0.
    p.high[row] = origin == vec3(0.0) ? m.w : dot(m.xyz, origin) + m.w;
    p.low[row] = 0.0;
    p.error[row] = origin == vec3(0.0) ? 0.0 : 16.0 * kUnit * (sum + abs(m.w));
#else
    const double at = dot(dvec3(m.xyz), dvec3(origin)) + double(m.w);
    p.high[row] = float(at);
    p.low[row] = float(at - double(p.high[row]));
    p.error[row] = 5.7e-14 * (sum + abs(m.w));  // 2^-44
#endif
  }
  return p;
}

// Whether the mesh's box may be out of the object's bounds. What overflows may be no number in the middle, but is infinite
// in `sum` or `reach`.
bool strays(Transform t, Moved moved, MeshRecord mesh, Position position) {
  const vec3 middle = 0.5 * mesh.lo + 0.5 * mesh.hi, halfExtent = max(mesh.hi - middle, middle - mesh.lo);
  const vec3 coordinates = abs(mesh.origin) + max(abs(mesh.lo), abs(mesh.hi));
  const vec3 flushed = vec3(t.flushes) * (1.2e-38 * (coordinates.x + coordinates.y + coordinates.z));
  vec3 at, sum, reach;
  for (int row = 0; row < 3; ++row) {
    const vec3 m = uintBitsToFloat(t.bits[row].xyz);
    const float offset = (position.high[row] - moved.anchor[row]) + position.low[row];
    at[row] = dot(m, middle) + offset;
    sum[row] = dot(abs(m), abs(middle)) + abs(offset) + position.error[row] / kUnit / 16.0;
    reach[row] = dot(abs(m), halfExtent);
  }
  const vec3 lost = 16.0 * kUnit * (sum + reach) + flushed;
  return !t.isFinite || any(greaterThan(sum + reach, vec3(1e37))) ||
         !all(lessThanEqual(abs(at) + reach + lost, moved.halfExtent));
}

// Rows that are about the inverse's: any will do, since what they are off is measured.
void inverseRows(vec3 m0, vec3 m1, vec3 m2, out vec3 n[3]) {
  const vec3 c0 = vec3(m0.x, m1.x, m2.x), c1 = vec3(m0.y, m1.y, m2.y), c2 = vec3(m0.z, m1.z, m2.z);
  const vec3 r0 = cross(c1, c2), r1 = cross(c2, c0), r2 = cross(c0, c1);
  const float determinant = dot(c0, r0);
  const bool usable = abs(determinant) > 1e-37 && abs(determinant) < 1e37;
  n = vec3[3](r0, r1, r2);
  for (int k = 0; k < 3; ++k) {
    const vec3 row = n[k] / (usable ? determinant : 1.0);
    n[k] = usable && all(lessThan(abs(row), vec3(1e30))) ? row : vec3(0.0);
  }
}

void place(Moved moved, MeshRecord mesh, Transform t, Position position) {
  const float unit = mesh.unit;
  const vec3 m[3] = vec3[3](uintBitsToFloat(t.bits[0].xyz) * unit, uintBitsToFloat(t.bits[1].xyz) * unit,
                            uintBitsToFloat(t.bits[2].xyz) * unit);
  const vec3 reach = max(abs(mesh.lo), abs(mesh.hi)) * mesh.perUnit;
  vec3 n[3];
  inverseRows(m[0], m[1], m[2], n);
  float size = 0.0, most = 0.0, error = 0.0;
  for (int row = 0; row < 3; ++row) {
    const vec3 leading = uintBitsToFloat(floatBitsToUint(m[row]) & 0xffffff00u);
    placements[moved.object].coarse[row] = vec4(leading, position.high[row]);
    placements[moved.object].fine[row] = vec4(m[row] - leading, position.low[row]);
    // n . matrix - unit vector, over the mesh.
    float off = 0.0;
    for (int j = 0; j < 3; ++j) {
      const vec3 column = vec3(m[0][j], m[1][j], m[2][j]);
      off += (abs(dot(n[row], column) - (j == row ? 1.0 : 0.0)) + 8.0 * kUnit * (dot(abs(n[row]), abs(column)) + 1.0)) * reach[j];
    }
    placements[moved.object].inverse[row] = vec4(n[row], 1.00001 * off);
    size += dot(abs(m[row]), reach);
    most = max(most, max(abs(m[row].x), max(abs(m[row].y), abs(m[row].z))));
    error = max(error, position.error[row] + 5.7e-14 * abs(position.high[row]));
  }
  placements[moved.object].reach = reach;
  placements[moved.object].root = mesh.firstNode;
  placements[moved.object].origin = mesh.origin;
  placements[moved.object].error = 1.00001 * (error + 3e-11 * size);  // 2^-35
  placements[moved.object].size = 1.00001 * size;
  placements[moved.object].mesh = moved.mesh;
  // Squares and cubes are to have room (kMostCoordinate).
  const bool inRange = most >= 8.3e-25 && most <= 1.2e24 && size <= 1.2e24 && unit >= 8.3e-25 && unit <= 1.2e24;
  placements[moved.object].perUnit = inRange ? mesh.perUnit : 0.0;
}

void tellPose(Moved moved, Transform t) {
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
  const uint i = workgroupIndex() * 64 + gl_LocalInvocationID.x;
  if (i >= push.count) return;
  const Moved moved = movedObjects[i];
  const MeshRecord mesh = meshes[moved.mesh];
  const Transform t = transformOf(moved);
  const Position position = positionOf(t, mesh.origin);
  if (strays(t, moved, mesh, position)) {
    // It counts no more, but must not send the search astray.
    atomicMin(stray.object, moved.object);
    placements[moved.object].perUnit = 0.0;
    return;
  }
  tellPose(moved, t);
  place(moved, mesh, t, position);
}
