// Sums and products of floats, given as bits, rounded to the nearest float, ties to even: what the CPU computes. Devices
// round float operations as they like, and flush subnormal floats.

// Stands for every number that is not finite.
const uint kNotFinite = 0x7f800000u;

bool isFinite(uint x) { return (x & kNotFinite) != kNotFinite; }
int exponentFieldOf(uint x) { return max(int(x >> 23 & 0xffu), 1); }
// The magnitude is significandOf(x) * 2^(exponentFieldOf(x) - 150).
uint significandOf(uint x) { return (x & 0x7fffffu) | ((x & kNotFinite) != 0 ? 0x800000u : 0u); }

// The float nearest to n * 2^exponent, with a sign. The last bit of n may stand for all lower bits: then n > 2^25.
uint roundedFloat(uint sign, uint n, int exponent) {
  if (n == 0) return sign;
  int shift = max(findMSB(n) - 23, -149 - exponent);
  if (shift > 33) return sign;
  uint whole = n;
  if (shift < 0) {
    whole = n << -shift;
  } else if (shift > 0) {
    // In two steps, as a shift by 32 is undefined.
    const uint twice = shift == 33 ? 0u : n >> (shift - 1);
    const bool up = (twice & 1u) != 0 && ((twice & 2u) != 0 || (n & ((1u << (shift - 1)) - 1u)) != 0);
    whole = (twice >> 1) + (up ? 1u : 0u);
  }
  const int field = exponent + shift + 150;
  return sign | (field > 254 ? kNotFinite : min((uint(field) << 23) + whole - 0x800000u, kNotFinite));
}

uint floatProduct(uint x, uint y) {
  if (!isFinite(x) || !isFinite(y)) return kNotFinite;
  const uint sign = (x ^ y) & 0x80000000u, p = significandOf(x), q = significandOf(y);
  if (p == 0 || q == 0) return sign;
  // 24 bits each, so that the product has 47 or 48, of which the upper ones are kept.
  const int shiftP = 23 - findMSB(p), shiftQ = 23 - findMSB(q);
  uint high, low;
  umulExtended(p << shiftP, q << shiftQ, high, low);
  const uint kept = high << 16 | low >> 16 | ((low & 0xffffu) != 0 ? 1u : 0u);
  return roundedFloat(sign, kept, exponentFieldOf(x) - shiftP + exponentFieldOf(y) - shiftQ - 284);
}

uint floatSum(uint x, uint y) {
  if (!isFinite(x) || !isFinite(y)) return kNotFinite;
  const bool swap = (y & 0x7fffffffu) > (x & 0x7fffffffu);
  const uint large = swap ? y : x, small = swap ? x : y;
  // Three bits below the last one of `large` suffice; the lowest stands for all that follow.
  const int apart = exponentFieldOf(large) - exponentFieldOf(small);
  const uint p = significandOf(large) << 3, q = significandOf(small) << 3;
  const uint aligned = apart > 27 ? (q != 0 ? 1u : 0u) : q >> apart | ((q & ((1u << apart) - 1u)) != 0 ? 1u : 0u);
  const bool differ = ((x ^ y) & 0x80000000u) != 0;
  const uint n = differ ? p - aligned : p + aligned;
  return roundedFloat(n == 0 && differ ? 0u : large & 0x80000000u, n, exponentFieldOf(large) - 153);
}

uint floatDifference(uint x, uint y) { return floatSum(x, y ^ 0x80000000u); }
