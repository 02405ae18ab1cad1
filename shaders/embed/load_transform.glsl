// Loads a host's transform, in any layout of radar/host_transforms.h. Included after byte_load.glsl and transform.glsl.
#include "float_bits.glsl"

uvec3 loadWords(uint byte) { return uvec3(loadWord(byte), loadWord(byte + 4), loadWord(byte + 8)); }

// 1 - (p + q).
uint oneWithout(uint p, uint q) { return floatDifference(0x3f800000u, floatSum(p, q)); }

void loadTurned(uint firstByte, TransformLayout format, inout Transform t) {
  const uvec3 position = loadWords(firstByte + format.offsets[0]), q = loadWords(firstByte + format.offsets[1]);
  const uint w = loadWord(firstByte + format.offsets[1] + 12);
  uvec3 scales = uvec3(0x3f800000u);
  if (format.parts == 3) scales = loadWords(firstByte + format.offsets[2]);
  if (format.parts == 1) scales = uvec3(loadWord(firstByte + format.offsets[2]));
  const uint twiceX = floatSum(q.x, q.x), twiceY = floatSum(q.y, q.y), twiceZ = floatSum(q.z, q.z);
  const uint xx = floatProduct(q.x, twiceX), yy = floatProduct(q.y, twiceY), zz = floatProduct(q.z, twiceZ);
  const uint xy = floatProduct(q.x, twiceY), xz = floatProduct(q.x, twiceZ), yz = floatProduct(q.y, twiceZ);
  const uint wx = floatProduct(w, twiceX), wy = floatProduct(w, twiceY), wz = floatProduct(w, twiceZ);
  t.bits[0] = uvec4(oneWithout(yy, zz), floatDifference(xy, wz), floatSum(xz, wy), position.x);
  t.bits[1] = uvec4(floatSum(xy, wz), oneWithout(xx, zz), floatDifference(yz, wx), position.y);
  t.bits[2] = uvec4(floatDifference(xz, wy), floatSum(yz, wx), oneWithout(xx, yy), position.z);
  for (uint row = 0; row < 3; ++row) {
    for (uint k = 0; k < 3; ++k) t.bits[row][k] = floatProduct(t.bits[row][k], scales[k]);
  }
}

Transform transformAt(uint firstByte, TransformLayout format) {
  Transform t;
  if (format.parts == kMatrix) {
    for (uint row = 0; row < 3; ++row) {
      for (uint k = 0; k < 4; ++k)
        t.bits[row][k] = loadWord(firstByte + row * format.offsets[0] + k * format.offsets[1]);
    }
  } else {
    loadTurned(firstByte, format, t);
  }
  t.isFinite = true;
  t.low = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
  for (uint row = 0; row < 3; ++row) {
    t.isFinite = t.isFinite && all(notEqual(t.bits[row] >> 23 & 0xffu, uvec4(0xffu)));
    t.flushes[row] = any(lessThan((t.bits[row].xyz & 0x7fffffffu) - 1u, uvec3(0x7fffffu)));
  }
  return t;
}
