// A hash of two numbers, and numbers from -1 to 1 made of one.
uint hash(uint a, uint b) {
  uint h = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return h ^ h >> 15;
}

vec3 random(uint h) {
  return vec3(h & 0x3ffu, h >> 10 & 0x3ffu, h >> 20 & 0x3ffu) / 511.5 - 1.0;
}
