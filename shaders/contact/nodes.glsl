// The trees and placements, in texel buffers.
layout(binding = kSlotMeshNodes) uniform utextureBuffer meshNodeTexels;
layout(binding = kSlotObjectNodes) uniform utextureBuffer objectNodeTexels;
layout(binding = kSlotPlacements) uniform utextureBuffer placementTexels;
layout(binding = kSlotSensors) uniform utextureBuffer sensorTexels;

// MeshNode.
struct Node {
  vec3 centre;
  uint link;
  vec3 halfExtent;
  float middle;
  vec3 normal;
  float slab;
};

Node nodeAt(uint i) {
  const int t = int(3 * i);
  const uvec4 x = texelFetch(meshNodeTexels, t);
  const vec4 y = uintBitsToFloat(texelFetch(meshNodeTexels, t + 1)), z = uintBitsToFloat(texelFetch(meshNodeTexels, t + 2));
  return Node(uintBitsToFloat(x.xyz), x.w, y.xyz, y.w, z.xyz, z.w);
}

bool isLeaf(uint link) { return (link & kLinkLeaf) != 0; }

// Texels of a Placement, and what is in the last places of some.
const int kTexelCoarse = 0, kTexelFine = 3, kTexelInverse = 6, kTexelReach = 9, kTexelOrigin = 10, kTexelError = 11;
uvec4 objectBits(uint object, int texel) { return texelFetch(placementTexels, int(kPlacementTexels * object) + texel); }
vec4 objectTexel(uint object, int texel) { return uintBitsToFloat(objectBits(object, texel)); }
uint objectRoot(uint object) { return objectBits(object, kTexelReach).w; }
uint objectMask(uint object) { return objectBits(object, kTexelError).z; }

// Texels of a Sensor, its placement's first.
const int kTexelAcross = 12, kTexelUpwards = 13, kTexelAlong = 14, kTexelDirection = 15, kTexelCentre = 16, kTexelHalfExtent = 17,
          kTexelMask = 18;
uvec4 sensorBits(uint search, int texel) { return texelFetch(sensorTexels, int(kSensorTexels * search) + texel); }
vec4 sensorTexel(uint search, int texel) { return uintBitsToFloat(sensorBits(search, texel)); }
uint sensorRoot(uint search) { return sensorBits(search, kTexelReach).w; }
float statedClearance(uint search) { return sensorTexel(search, kTexelAcross).w; }
float slackShare(uint search) { return sensorTexel(search, kTexelUpwards).w; }
float tolerance(uint search) { return sensorTexel(search, kTexelAlong).w; }
float scaleOf(uint search) { return sensorTexel(search, kTexelDirection).w; }
float distanceOf(uint search) { return sensorTexel(search, kTexelCentre).w; }
float stopBefore(uint search) { return sensorTexel(search, kTexelHalfExtent).w; }
uint sensorMask(uint search) { return sensorBits(search, kTexelMask).x; }
uvec2 excludedOf(uint search) { return sensorBits(search, kTexelMask).yz; }  // the first, and where they end
float unscaleOf(uint search) { return sensorTexel(search, kTexelMask).w; }

// Rows x, y, z.
mat3 rows(vec3 x, vec3 y, vec3 z) { return transpose(mat3(x, y, z)); }

// Three texels: a matrix, and a vector in their last places.
struct MatrixRows {
  vec4 x, y, z;
};
MatrixRows sensorRows(uint s, int t) { return MatrixRows(sensorTexel(s, t), sensorTexel(s, t + 1), sensorTexel(s, t + 2)); }
MatrixRows objectRows(uint o, int t) { return MatrixRows(objectTexel(o, t), objectTexel(o, t + 1), objectTexel(o, t + 2)); }
mat3 matrixOf(MatrixRows m) { return rows(m.x.xyz, m.y.xyz, m.z.xyz); }
mat3 matrixOf(MatrixRows m, MatrixRows rest) { return rows(m.x.xyz + rest.x.xyz, m.y.xyz + rest.y.xyz, m.z.xyz + rest.z.xyz); }
vec3 lastOf(MatrixRows m) { return vec3(m.x.w, m.y.w, m.z.w); }

float max3(vec3 v) { return max(v.x, max(v.y, v.z)); }
float min3(vec3 v) { return min(v.x, min(v.y, v.z)); }
mat3 abs3(mat3 m) { return mat3(abs(m[0]), abs(m[1]), abs(m[2])); }

vec3 awayFromZero(vec3 v, vec3 least) { return mix(max(v, least), min(v, -least), lessThan(v, vec3(0.0))); }

// A sensor's box in the world, about the anchor of the tree over objects.
struct SensorBox {
  vec3 centre, halfExtent, inverseDirection;
};

SensorBox sensorBoxOf(uint search) {
  // `halfExtent` has a margin for the raised velocity.
  return SensorBox(sensorTexel(search, kTexelCentre).xyz, sensorTexel(search, kTexelHalfExtent).xyz,
                   1.0 / awayFromZero(sensorTexel(search, kTexelDirection).xyz, vec3(9.0949470e-13)));
}

// The distances at which the sensor's box meets that of an ObjectNode; x > y: never.
vec2 meetsBox(SensorBox box, vec4 middle, vec4 extent) {
  const vec3 gap = middle.xyz - box.centre, at = gap * box.inverseDirection;
  const vec3 reach = ((extent.xyz + box.halfExtent) * 1.00001 + 1e-6 * abs(gap)) * abs(box.inverseDirection);
  return vec2(max(max3(at - reach), 0.0), min3(at + reach));
}
