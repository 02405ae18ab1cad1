// Where a transform puts a mesh, with error bounds (docs/method.md, "A host's geometry"). Included after
// transform.glsl.
#include "two_floats.glsl"
#ifndef RADAR_NO_DOUBLES
#include "inner.glsl"
#include "widen.glsl"
#endif

// The greatest coordinates, times `factor`.
vec3 coordinatesOf(MeshRecord mesh, float factor) {
  precise vec3 sum = factor * abs(mesh.origin) + factor * max(abs(mesh.lo), abs(mesh.hi));
  return sum;
}

// Whether the absolute terms that place a vertex add up to less than about 2^123. The test itself cannot overflow.
bool fitsFloats(Transform t, MeshRecord mesh) {
  const float small = 1.3552527e-20;  // 2^-66
  const vec3 coordinates = coordinatesOf(mesh, small);
  bool fits = t.isFinite;
  for (int row = 0; row < 3; ++row) {
    const vec4 m = uintBitsToFloat(t.bits[row]);
    precise vec3 scaled = abs(m.xyz) * small;
    precise vec3 terms = scaled * coordinates;
    fits = fits && sum3(terms) <= 0.001953125 && abs(m.w) <= 1e37;
  }
  return fits;
}

// The mesh's origin in the world is high + low, within `error` and what flushes to 0, below 4e-36.
struct Position {
  vec3 high, low, error;
};

Position positionOf(Transform t, vec3 origin) {
  Position p;
  for (int row = 0; row < 3; ++row) {
    const vec4 m = uintBitsToFloat(t.bits[row]);
    const float sum = dot(abs(m.xyz), abs(origin));
#ifdef RADAR_NO_DOUBLES
    float high = m.w, low = t.low[row].w;
    for (int k = 0; k < 3; ++k) {
      addProduct(high, low, m[k], origin[k]);
      addExactly(high, low, t.low[row][k] * origin[k]);
    }
    p.high[row] = p.low[row] = 0.0;
    addExactly(p.high[row], p.low[row], high);
    addExactly(p.high[row], p.low[row], low);
    p.error[row] = origin == vec3(0.0) ? 0.0 : 1.9e-12 * (sum + abs(m.w));  // 2^-39
#else
    const dvec4 exact = dvec4(m) + dvec4(t.low[row]);
    const double at = inner(exact.xyz, dvec3(origin)) + exact.w;
    split(at, p.high[row], p.low[row]);
    p.error[row] = 5.7e-14 * (sum + abs(m.w));  // 2^-44
#endif
  }
  return p;
}

// The box of a placed mesh about an anchor, with room for rounding, and for entries of the transform that flush to 0; what
// else may flush to 0, coordinates of the mesh and results, takes less than `flushed`.
struct PlacedBox {
  vec3 centre, halfExtent, flushed;
  bool isFinite;
};

// The anchor is the sum of two floats.
PlacedBox boxOf(Transform t, MeshRecord mesh, Position position, vec3 anchor, vec3 anchorLow) {
  precise vec3 middle = 0.5 * mesh.lo + 0.5 * mesh.hi, halfExtent = max(mesh.hi - middle, middle - mesh.lo);
  const vec3 ofEntries = vec3(t.flushes) * sum3(coordinatesOf(mesh, 1.2e-38));
  vec3 at, sum, reach, flushed;
  for (int row = 0; row < 3; ++row) {
    const vec3 m = uintBitsToFloat(t.bits[row].xyz);
    const float offset = differenceInParts(position.high[row], position.low[row], anchor[row], anchorLow[row]);
    at[row] = dot(m, middle) + offset;
    sum[row] = dot(abs(m), abs(middle)) + abs(offset) + position.error[row] / kUnit / 20.0;
    reach[row] = dot(abs(m), halfExtent);
    flushed[row] = dot(abs(m), vec3(1e-37)) + 1e-36;
  }
  return PlacedBox(at, reach + (20.0 * kUnit * (sum + reach) + ofEntries), flushed, all(lessThanEqual(sum + reach, vec3(1e37))));
}

// Approximate rows of the inverse of a matrix whose largest entry is 1 to 2. Any rows are valid, since the caller bounds
// their error. All components are smaller than `most`.
void inverseRows(vec3 m0, vec3 m1, vec3 m2, float most, out vec3 n[3]) {
  const vec3 c0 = vec3(m0.x, m1.x, m2.x), c1 = vec3(m0.y, m1.y, m2.y), c2 = vec3(m0.z, m1.z, m2.z);
  const vec3 r0 = cross(c1, c2), r1 = cross(c2, c0), r2 = cross(c0, c1);
  const float determinant = dot(c0, r0);
  const bool usable = abs(determinant) > 1e-37;
  n = vec3[3](r0, r1, r2);
  for (int k = 0; k < 3; ++k) {
    const vec3 row = n[k] / (usable ? determinant : 1.0);
    n[k] = usable && all(lessThan(abs(row), vec3(most))) ? row : vec3(0.0);
  }
}

// Exponents of the matrix's largest entry times the mesh's unit, and of the unit. A matrix that may flush to 0 gets an
// exponent out of range.
ivec2 exponentsOf(Transform t, MeshRecord mesh) {
  uint most = 0;
  for (int row = 0; row < 3; ++row) {
    const uvec3 m = t.bits[row].xyz & 0x7fffffffu;
    most = max(most, max(m.x, max(m.y, m.z)));
  }
  const int entry = int(most >> 23) - 127, unit = int(floatBitsToUint(mesh.unit) >> 23) - 127;
  return ivec2(entry == -127 ? -1000 : entry + unit, unit);
}

// All members but `mask` and `mesh`. perUnit is 0 if floats cannot hold the mesh or its pose.
Placement placementOf(MeshRecord mesh, Transform t, Position position) {
  Placement p;
  const ivec2 exponents = exponentsOf(t, mesh);
  // 2^80, tested before multiplying. Out of range, perUnit becomes 0 and the other members do not count.
  const bool inRange = all(lessThan(exponents, ivec2(80, 81))) && all(greaterThanEqual(exponents, ivec2(-80)));
  const float unit = inRange ? mesh.unit : 0.0, large = twoTo(inRange ? exponents.x : 0),
              perLarge = twoTo(inRange ? -exponents.x : 0);
  const vec3 m[3] = vec3[3](uintBitsToFloat(t.bits[0].xyz) * unit, uintBitsToFloat(t.bits[1].xyz) * unit,
                            uintBitsToFloat(t.bits[2].xyz) * unit);
  const vec3 scaled[3] = vec3[3](m[0] * perLarge, m[1] * perLarge, m[2] * perLarge);
  // None of what follows rests on the sign or the size of a number that a device may flush to 0.
  const vec3 reach = max(abs(mesh.lo), abs(mesh.hi)) * mesh.perUnit + 1.2e-38;
  // Of entries of the transform, per row; of vertices, before and after they are normalised, per unit of the matrix.
  const float flushed = 1.2e-38 * (unit * sum3(reach)) + sum3(1.2e-38 * abs(mesh.origin)),
              ofVertices = 3e-37 + 3e-37 * mesh.perUnit;
  vec3 n[3];
  inverseRows(scaled[0], scaled[1], scaled[2], 1e18 * min(1e12 * large, 1.0), n);
  float size = 0.0, error = 0.0;
  for (int row = 0; row < 3; ++row) {
    const vec3 leading = uintBitsToFloat(floatBitsToUint(m[row]) & 0xffffff00u);
    p.coarse[row] = vec4(leading, position.high[row]);
    p.fine[row] = vec4(differenceInParts(m[row], t.low[row].xyz * unit, leading, vec3(0.0)), position.low[row]);
    // Residual: n . matrix - unit vector, times the mesh's reach.
    float off = 0.0;
    for (int j = 0; j < 3; ++j) {
      const vec3 column = vec3(scaled[0][j], scaled[1][j], scaled[2][j]);
      off += (abs(dot(n[row], column) - (j == row ? 1.0 : 0.0)) + 10.0 * kUnit * (dot(abs(n[row]), abs(column)) + 1.0)) * reach[j];
    }
    p.inverse[row] = vec4(n[row] * perLarge, 1.00001 * off + 1e-37);
    const float ofRow = t.flushes[row] ? flushed : 0.0;
    size += dot(abs(m[row]), reach) + ofRow;
    error = max(error, position.error[row] + 5.7e-14 * abs(position.high[row]) + ofVertices * sum3(abs(m[row])) + ofRow);
  }
  p.reach = reach;
  p.root = mesh.firstNode;
  p.origin = mesh.origin;
  // 2^-35 of the size, and 4e-36 for numbers that flush to 0.
  p.error = 1.00001 * (error + 3.1e-11 * size) + 4e-36;
  p.size = 1.00001 * size + 4e-36;
  p.perUnit = inRange && size <= 1.2e24 ? mesh.perUnit : 0.0;
  return p;
}
