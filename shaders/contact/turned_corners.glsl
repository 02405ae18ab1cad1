// The corners of the pair in hand. Loops turn them in place, and compute all else anew where they need it: there is no room in
// registers for more, nor for corners that an index selects.
dvec3 a0, a1, a2, b0, b1, b2;

void setCorners(dvec3 a[3], dvec3 b[3]) {
  a0 = a[0];
  a1 = a[1];
  a2 = a[2];
  b0 = b[0];
  b1 = b[1];
  b2 = b[2];
}

// The next corner becomes the first.
void cycleA() {
  const dvec3 first = a0;
  a0 = a1;
  a1 = a2;
  a2 = first;
}
void cycleB() {
  const dvec3 first = b0;
  b0 = b1;
  b1 = b2;
  b2 = first;
}
