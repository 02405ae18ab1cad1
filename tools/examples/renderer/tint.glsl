// Red, where nothing is free, over amber and green to blue.
vec3 tintOf(float free) {
  const vec3 tints[4] = vec3[4](vec3(0.90, 0.03, 0.03), vec3(1.0, 0.45, 0.02), vec3(0.12, 0.60, 0.12), vec3(0.02, 0.30, 0.75));
  const float at = clamp(free / 3.0, 0.0, 2.999);
  return mix(tints[int(at)], tints[int(at) + 1], fract(at));
}
