// The corners of the pair in hand. Loops turn them in place, and compute all else anew where they need it: there is no room in
// registers for more, nor for corners that an index selects.
dvec3 a0, a1, a2, b0, b1, b2;

#include "shared/turn.glsl"

void setCorners(dvec3 a[3], dvec3 b[3]) {
  a0 = a[0];
  a1 = a[1];
  a2 = a[2];
  b0 = b[0];
  b1 = b[1];
  b2 = b[2];
}

void cycleA() { cycle(a0, a1, a2); }
void cycleB() { cycle(b0, b1, b2); }
