// Unevaluated sums of two doubles. The operations are those of engine/exact/double_double.h, in the same order, so that both
// give the same bits.
#ifndef RADAR_DOUBLE_DOUBLE_GLSL
#define RADAR_DOUBLE_DOUBLE_GLSL

struct DoubleDouble {
  double high;
  double low;
};

// Requires |p| >= |q| or p = 0.
DoubleDouble quickSum(double p, double q) {
  const double s = p + q;
  const double low = q - (s - p);
  return DoubleDouble(s, low);
}

DoubleDouble sum(double p, double q) {
  const double s = p + q;
  const double qPart = s - p;
  const double low = (p - (s - qPart)) + (q - qPart);
  return DoubleDouble(s, low);
}

DoubleDouble product(double p, double q) {
  const double kSplit = 134217729.0LF;  // 2^27 + 1
  const double pc = kSplit * p, qc = kSplit * q;
  const double p1 = pc - (pc - p), q1 = qc - (qc - q);
  const double p2 = p - p1, q2 = q - q1;
  const double r = p * q;
  const double low = ((p1 * q1 - r) + p1 * q2 + p2 * q1) + p2 * q2;
  return DoubleDouble(r, low);
}

DoubleDouble negated(DoubleDouble p) { return DoubleDouble(-p.high, -p.low); }

DoubleDouble plus(DoubleDouble p, DoubleDouble q) {
  const DoubleDouble s = sum(p.high, q.high), t = sum(p.low, q.low);
  const double below = s.low + t.high;
  const DoubleDouble v = quickSum(s.high, below);
  const double rest = t.low + v.low;
  return quickSum(v.high, rest);
}

DoubleDouble minus(DoubleDouble p, DoubleDouble q) { return plus(p, negated(q)); }

DoubleDouble times(DoubleDouble p, DoubleDouble q) {
  const DoubleDouble r = product(p.high, q.high);
  const double low = r.low + (p.high * q.low + p.low * q.high);
  return quickSum(r.high, low);
}

#endif
