// Copies the vertices of meshes that a host deforms from the host's buffers; one invocation per vertex.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"

layout(local_size_x = kHostGroup) in;

// A Vertex whose position is copied as bits: copying it as floats may flush subnormals to 0.
struct VertexBits {
  uvec3 position;
  uint number;
};
layout(scalar, binding = kSlotVertices) restrict buffer Vertices { VertexBits vertices[]; };
layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotBoundsViolation) restrict buffer BoundsViolations { BoundsViolation violation; };
#include "byte_load.glsl"
#include "deformed.glsl"
#include "shared/workgroup.glsl"

layout(push_constant) uniform PushConstants { DeformedPush push; };

// Bits of the float nearest to c / (2^bits - 1), for 0 < c < 2^bits. The quotient's binary digits repeat those of c.
uint quotientBits(uint c, int bits) {
  const int leading = findMSB(c);
  const uint twice = c << bits | c;  // its leading digit is at `bits` + leading; 25 digits from there are needed
  const int more = 24 - bits - leading;
  const uint digits = more <= 0 ? twice >> -more : twice << more | c >> (bits - more);
  return floatBitsToUint(float((digits + 1) >> 1)) + (uint(leading - bits - 23) << 23);
}

uint bitsOfNorm(uint c, int bits) {
  return c == 0 ? 0 : c == (1u << bits) - 1 ? floatBitsToUint(1.0) : quotientBits(c, bits);
}

uint bitsOfHalf(uint h) {
  const uint sign = (h & 0x8000u) << 16, exponent = h >> 10 & 31, fraction = h & 1023;
  if (exponent == 31) return sign | 0x7f800000u | fraction << 13;
  if (exponent != 0) return sign | (exponent + 112) << 23 | fraction << 13;
  return fraction == 0 ? sign : sign | (floatBitsToUint(float(fraction)) - (24u << 23));
}

uint component(uint format, uint at, uint k) {
  if (format == kFloat32) return loadWord(at + 4 * k);
  const uint c = loadWord(at + 2 * k) & 0xffffu;
  if (format == kFloat16) return bitsOfHalf(c);
  if (format == kUnorm16) return bitsOfNorm(c, 16);
  const bool negative = c > 0x7fffu;
  const uint magnitude = min(negative ? 0x10000u - c : c, 0x7fffu);
  return bitsOfNorm(magnitude, 15) | (negative ? 0x80000000u : 0u);
}

void main() {
  const uint group = workgroupIndex();
  if (group >= push.groups) return;
  const Deformed own = deformed[deformedOf(group, kByDeform, push.meshes)];
  const uint i = (group - own.firstGroup[kByDeform]) * kHostGroup + gl_LocalInvocationID.x;
  if (i >= own.vertices) return;
  const MeshRecord mesh = meshes[own.mesh];
  const uint to = mesh.firstVertex + i, number = vertices[to].number, at = own.firstByte + number * own.stride;
  const uvec3 bits =
      uvec3(component(own.format, at, 0), component(own.format, at, 1), component(own.format, at, 2));
  const vec3 local = uintBitsToFloat(bits) - mesh.origin;
  // Bounds are at most 2^120; differences of coordinates from 2^121 on might overflow.
  const bool outside = any(greaterThanEqual(bits >> 23 & 0xffu, uvec3(0xf8u))) ||
                      own.extent == kNobody && (any(greaterThan(local, mesh.hi)) || any(greaterThan(mesh.lo, local)));
  if (outside && atomicCompSwap(violation.mesh, kNobody, own.mesh) == kNobody) atomicExchange(violation.vertex, number);
  // The recording is invalid now, but the search must still terminate, so any position that is in range is written.
  vertices[to].position = outside ? floatBitsToUint(mesh.origin + mesh.lo) : bits;
}
