// The operations are those of engine/exact, in the same order, so that both give the same bits. Included where loops have
// attributes.
#include "shared/divide.glsl"
#include "shared/double_double.glsl"

// The square root of 1 <= x < 16, by sums, products and quotients only, which have the same bits on the CPU.
double rootOf(double x) {
  double root = 0.5LF * (1.0LF + x);
  [[dont_unroll]] for (uint i = 0; i < 7; ++i) root = 0.5LF * (root + quotient(x, root));
  return root;
}
