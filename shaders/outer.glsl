// What a triangle may touch, pixel by pixel, and the depths it may have there: never less than the truth, whatever float
// loses (docs/method.md, "Outer scopes"). All of it is precise: several shaders must get the same bits. One unit is a pixel's side on all three axes; u = 2^-24.

const float kUnit = 5.9604644775390625e-8;

struct Facet {
  uvec2 first, end;           // pixels of the triangle's box; end <= first: none
  vec3 fromX, fromY;          // where the edges begin: the corners
  vec3 alongX, alongY;        // and where they lead
  vec3 least, most;           // side of an edge on which a pixel's centre may lie
  vec2 gradient;              // of depth
  float reach;                // depth within a pixel's square is that of the plane at its centre, give or take
  float base;                 // depth of the first corner
  float nearest, farthest;    // of all corners
};

// Of a triangle whose corners may each be off by `spread` across. `low`, `high`: the pixels that are asked for.
Facet facetOf(vec3 p0, vec3 p1, vec3 p2, float spread, uvec2 low, uvec2 high) {
  Facet f;
  const float halfSide = 0.5 + spread;
  // Closed squares: one that is only touched counts.
  const vec2 least = max(ceil(min(min(p0.xy, p1.xy), p2.xy) - spread) - 1.0, vec2(low));
  const vec2 most = min(floor(max(max(p0.xy, p1.xy), p2.xy) + spread), vec2(high) - 1.0);
  const bool any_ = all(lessThanEqual(least, most));
  f.first = any_ ? uvec2(least) : uvec2(0);
  f.end = any_ ? uvec2(most) + 1 : uvec2(0);
  f.fromX = vec3(p0.x, p1.x, p2.x);
  f.fromY = vec3(p0.y, p1.y, p2.y);
  // The greatest distance from an edge's beginning to a centre.
  const vec3 farX = max(abs(least.x + 0.5 - f.fromX), abs(most.x + 0.5 - f.fromX));
  const vec3 farY = max(abs(least.y + 0.5 - f.fromY), abs(most.y + 0.5 - f.fromY));

  precise const vec2 a = p1.xy - p0.xy, b = p2.xy - p0.xy, c = p2.xy - p1.xy;
  precise const float ab = a.x * b.y, ba = a.y * b.x;
  precise const float area = ab - ba;
  precise const float products = abs(ab) + abs(ba);
  f.alongX = vec3(a.x, c.x, -b.x);
  f.alongY = vec3(a.y, c.y, -b.y);
  precise const vec3 margin = (abs(f.alongX) + abs(f.alongY)) * halfSide +
                      16.0 * kUnit * (abs(f.alongY) * farX + abs(f.alongX) * farY) + 5.0 * kUnit * products + 1e-20;
  f.least = min(area, 0.0) - margin;
  f.most = max(area, 0.0) + margin;

  f.base = p0.z;
  f.nearest = min(min(p0.z, p1.z), p2.z);
  f.farthest = max(max(p0.z, p1.z), p2.z);
  // A sliver's plane is rounding, and a steep one says no more than the corners: then their range of depth stands alone.
  const bool sound = abs(area) > 0.0009765625 * products && products > 1e-18;
  const float divisor = sound ? area : 1.0;
  const vec2 rise = vec2(p1.z - p0.z, p2.z - p0.z);
  precise const vec2 gradient = vec2(rise.x * b.y - rise.y * a.y, rise.y * a.x - rise.x * b.x) / divisor;
  precise const vec2 sums = vec2(abs(rise.x * b.y) + abs(rise.y * a.y), abs(rise.y * a.x) + abs(rise.x * b.x));
  precise const vec2 gradientError = 6.0 * kUnit * (sums + abs(gradient) * products) / abs(divisor);
  precise const float across = (abs(gradient.x) + abs(gradient.y)) * halfSide;
  const vec2 far = vec2(farX.x, farY.x);
  const bool plane = sound && across < f.farthest - f.nearest;
  precise const float reach = across + dot(gradientError, far + halfSide) +
                              6.0 * kUnit * (abs(p0.z) + dot(abs(gradient), far) + across);
  f.gradient = plane ? gradient : vec2(0.0);
  f.reach = plane ? reach : 1e37;
  return f;
}

// Whether the triangle may touch the square about `centre`, which lies in its box.
bool covers(Facet f, vec2 centre) {
  precise const vec3 side = f.alongX * (centre.y - f.fromY) - f.alongY * (centre.x - f.fromX);
  return all(greaterThanEqual(side, f.least)) && all(lessThanEqual(side, f.most));
}

// The depths that the triangle may have in that square: nearest and farthest. `slack`: how far its corners' may be off.
vec2 depthsIn(Facet f, vec2 centre, float slack) {
  precise const float depth = f.base + (f.gradient.x * (centre.x - f.fromX.x) + f.gradient.y * (centre.y - f.fromY.x));
  precise const vec2 depths = vec2(max(depth - f.reach, f.nearest) - slack, min(depth + f.reach, f.farthest) + slack);
  return depths;
}

// Unsigned integers in the order of the floats, never 0 or kNobody; and back.
uint keyOf(float x) {
  const uint bits = floatBitsToUint(x);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

float depthOf(uint key) { return uintBitsToFloat((key & 0x80000000u) != 0 ? key ^ 0x80000000u : ~key); }

vec3 inPixels(Band band, vec3 q) {
  const vec4 corner = vec4(q, 1.0);
  precise const vec3 placed = vec3(dot(band.pixelsFromMesh[0], corner), dot(band.pixelsFromMesh[1], corner),
                                   dot(band.pixelsFromMesh[2], corner));
  return placed;
}
