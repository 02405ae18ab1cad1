// Loads a host's transform, which is a matrix of floats. Included after byte_load.glsl and transform.glsl.

uvec3 loadWords(uint byte) { return uvec3(loadWord(byte), loadWord(byte + 4), loadWord(byte + 8)); }

bool isFinite(uint bits) { return (bits & 0x7f800000u) != 0x7f800000u; }

Transform transformAt(uint firstByte, MatrixLayout format) {
  Transform t;
  t.isFinite = true;
  t.low = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
  for (uint row = 0; row < 3; ++row) {
    for (uint k = 0; k < 4; ++k) {
      t.bits[row][k] = loadWord(firstByte + row * format.row + k * format.column);
      t.isFinite = t.isFinite && isFinite(t.bits[row][k]);
    }
    t.flushes[row] = any(lessThan((t.bits[row].xyz & 0x7fffffffu) - 1u, uvec3(0x7fffffu)));
  }
  return t;
}

// The transform in doubles, exactly.
PreciseRows preciseRows(Transform t) {
  PreciseRows pose;
  for (uint row = 0; row < 3; ++row) {
    const uvec2 x = doubleBits(t.bits[row].x), y = doubleBits(t.bits[row].y), z = doubleBits(t.bits[row].z),
                w = doubleBits(t.bits[row].w);
#ifdef RADAR_NO_DOUBLES
    pose[2 * row] = uvec4(x, y);
    pose[2 * row + 1] = uvec4(z, w);
#else
    pose[row] = dvec4(packDouble2x32(x), packDouble2x32(y), packDouble2x32(z), packDouble2x32(w));
#endif
  }
  return pose;
}
