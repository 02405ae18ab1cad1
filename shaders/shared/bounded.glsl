// Doubles with error bounds.
#ifndef RADAR_BOUNDED_GLSL
#define RADAR_BOUNDED_GLSL

// u = 2^-53.
const double kHalfUlp = 1.1102230246251565e-16LF;
// More than a few products or quotients lose to rounding, relative to their value.
const double kRounded = 8.0LF * kHalfUlp;
// More than a product may lose to underflow.
const double kTiny = 1.0e-280LF;
// Far above every contact; its products with lengths and scales do not overflow.
const double kNever = 1.0e200LF;

struct Bounded {
  double value, error;
};

#endif
