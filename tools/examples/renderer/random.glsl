// A hash of two numbers, and numbers from 0 to 1 made of it.
uint hash(uint a, uint b) {
  uint h = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return h ^ h >> 15;
}

float unit(uint h) {
  return float(h >> 8) / 16777216.0;
}
