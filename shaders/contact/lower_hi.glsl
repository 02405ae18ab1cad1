// Lowers a sensor's upper bound of first contact to that of a pair in doubles.

// Lower bounds are lowered and upper bounds raised by this, relative to their value: products may round them inwards.
const double kRounded = 8.881784197001252e-16LF;
// The same for a float.
const double kRoundedFloat = 2.4e-7LF;

// `by`: the pair certainly meets by this multiple of the direction.
void lowerHi(uint sensor, Sweep sweep, double by) {
  const double scaled = max(by, 0.0LF) * sweep.directionLength * double(sweep.scale);
  if (scaled < double(uintBitsToFloat(states[sensor].hi))) {
    atomicMin(states[sensor].hi, floatBitsToUint(float(scaled * (1.0LF + kRoundedFloat)) + 1e-37));
  }
}
