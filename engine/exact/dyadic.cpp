#include "exact/dyadic.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace radar::exact {

namespace {

__extension__ using Wide = unsigned __int128;

}  // namespace

Dyadic::Dyadic(double value) {
  if (value == 0) return;
  assert(std::isfinite(value));
  const uint64_t image = std::bit_cast<uint64_t>(value);
  const int field = static_cast<int>(image >> 52 & 0x7ff);
  uint64_t mantissa = image & ((uint64_t{1} << 52) - 1);
  if (field != 0) mantissa |= uint64_t{1} << 52;
  // Trailing zeros go into the exponent, so that grids and small integers stay small.
  const int zeros = std::countr_zero(mantissa);
  limbs_[0] = mantissa >> zeros;
  size_ = 1;
  negative_ = value < 0;
  exponent_ = std::max(field, 1) - 1075 + zeros;
}

Dyadic::Dyadic(bool negative, const std::array<uint64_t, 3>& limbs, int exponent)
    : size_(3), negative_(negative), exponent_(exponent) {
  std::copy_n(limbs.begin(), 3, limbs_.begin());
  trim();
}

Dyadic& Dyadic::operator=(const Dyadic& other) {
  size_ = other.size_;
  negative_ = other.negative_;
  exponent_ = other.exponent_;
  std::copy_n(other.limbs_.begin(), size_, limbs_.begin());
  return *this;
}

void Dyadic::trim() {
  while (size_ > 0 && limbs_[size_ - 1] == 0) --size_;
}

uint32_t Dyadic::bits() const {
  return size_ == 0 ? 0 : 64 * size_ - static_cast<uint32_t>(std::countl_zero(limbs_[size_ - 1]));
}

void Dyadic::shiftLeft(uint32_t count) {
  if (size_ == 0 || count == 0) return;
  const uint32_t whole = count / 64, part = count % 64;
  assert(size_ + whole + 1 <= kLimbs);
  if (part == 0) {
    std::copy_backward(limbs_.begin(), limbs_.begin() + size_, limbs_.begin() + size_ + whole);
  } else {
    limbs_[size_ + whole] = limbs_[size_ - 1] >> (64 - part);
    for (uint32_t i = size_; i-- > 1;) limbs_[i + whole] = limbs_[i] << part | limbs_[i - 1] >> (64 - part);
    limbs_[whole] = limbs_[0] << part;
    ++size_;
  }
  std::fill_n(limbs_.begin(), whole, 0);
  size_ += whole;
  trim();
}

int Dyadic::compareMagnitudes(const Dyadic& p, const Dyadic& q) {
  if (p.size_ != q.size_) return p.size_ < q.size_ ? -1 : 1;
  for (uint32_t i = p.size_; i-- > 0;) {
    if (p.limbs_[i] != q.limbs_[i]) return p.limbs_[i] < q.limbs_[i] ? -1 : 1;
  }
  return 0;
}

void Dyadic::addMagnitude(const Dyadic& q) {
  uint64_t carry = 0;
  const uint32_t most = std::max(size_, q.size_);
  assert(most < kLimbs);
  for (uint32_t i = 0; i < most; ++i) {
    const Wide sum = Wide{i < size_ ? limbs_[i] : 0} + (i < q.size_ ? q.limbs_[i] : 0) + carry;
    limbs_[i] = static_cast<uint64_t>(sum);
    carry = static_cast<uint64_t>(sum >> 64);
  }
  size_ = most;
  if (carry != 0) limbs_[size_++] = carry;
}

void Dyadic::subtractMagnitude(const Dyadic& q) {
  uint64_t borrow = 0;
  for (uint32_t i = 0; i < size_; ++i) {
    const uint64_t take = i < q.size_ ? q.limbs_[i] : 0;
    const Wide difference = Wide{limbs_[i]} - take - borrow;
    limbs_[i] = static_cast<uint64_t>(difference);
    borrow = difference >> 64 != 0 ? 1 : 0;
  }
  assert(borrow == 0);
  trim();
}

Dyadic Dyadic::sum(const Dyadic& p, const Dyadic& q, bool negateQ) {
  if (q.size_ == 0) return p;
  const bool negativeQ = q.negative_ != negateQ;
  if (p.size_ == 0) {
    Dyadic out = q;
    out.negative_ = negativeQ;
    return out;
  }
  // The summand with the higher exponent is shifted to the lower exponent.
  const bool pHigher = p.exponent_ > q.exponent_;
  Dyadic out = pHigher ? p : q;
  const Dyadic& other = pHigher ? q : p;
  out.negative_ = pHigher ? p.negative_ : negativeQ;
  const bool otherNegative = pHigher ? negativeQ : p.negative_;
  out.shiftLeft(static_cast<uint32_t>(out.exponent_ - other.exponent_));
  out.exponent_ = other.exponent_;
  if (out.negative_ == otherNegative) {
    out.addMagnitude(other);
    return out;
  }
  if (compareMagnitudes(out, other) >= 0) {
    out.subtractMagnitude(other);
    return out;
  }
  Dyadic larger = other;
  larger.negative_ = otherNegative;
  larger.subtractMagnitude(out);
  return larger;
}

Dyadic operator*(const Dyadic& p, const Dyadic& q) {
  Dyadic out;
  if (p.size_ == 0 || q.size_ == 0) return out;
  assert(p.size_ + q.size_ <= Dyadic::kLimbs);
  out.size_ = p.size_ + q.size_;
  out.negative_ = p.negative_ != q.negative_;
  out.exponent_ = p.exponent_ + q.exponent_;
  std::fill_n(out.limbs_.begin(), out.size_, 0);
  for (uint32_t i = 0; i < p.size_; ++i) {
    uint64_t carry = 0;
    for (uint32_t k = 0; k < q.size_; ++k) {
      const Wide product = Wide{p.limbs_[i]} * q.limbs_[k] + out.limbs_[i + k] + carry;
      out.limbs_[i + k] = static_cast<uint64_t>(product);
      carry = static_cast<uint64_t>(product >> 64);
    }
    out.limbs_[i + q.size_] = carry;
  }
  out.trim();
  return out;
}

double quotient(const Dyadic& num, const Dyadic& den) {
  assert(den.size_ != 0);
  if (num.size_ == 0) return 0;
  // The operands are scaled so that the integer quotient has 63 or 64 bits; then restoring division, bit by bit.
  Dyadic rest = num, step = den;
  rest.negative_ = step.negative_ = false;
  const int shift = 63 - (static_cast<int>(num.bits()) - static_cast<int>(den.bits()));
  int exponent = num.exponent_ - den.exponent_ - shift;
  rest.shiftLeft(static_cast<uint32_t>(std::max(shift, 0)));
  step.shiftLeft(static_cast<uint32_t>(std::max(-shift, 0)));
  // The rest is doubled instead of halving the step; at first, rest < 2 * step * 2^63.
  step.shiftLeft(63);
  uint64_t digits = 0;
  for (int bit = 0; bit < 64; ++bit) {
    digits <<= 1;
    if (Dyadic::compareMagnitudes(rest, step) >= 0) {
      rest.subtractMagnitude(step);
      digits |= 1;
    }
    if (bit < 63) rest.shiftLeft(1);
  }
  if (rest.size_ != 0) digits |= 1;  // sticky: the lowest bit is far below the rounding position
  // Below the normal range fewer bits are kept; they must be rounded once, with the sticky bit, not twice.
  const int top = 64 - std::countl_zero(digits);
  const int surplus = -1074 - exponent;
  if (surplus > top - 53) {
    if (surplus > 64) return num.negative_ != den.negative_ ? -0.0 : 0.0;
    const uint64_t kept = surplus == 64 ? 0 : digits >> surplus;
    const uint64_t cut = surplus == 64 ? digits : digits & ((uint64_t{1} << surplus) - 1);
    const uint64_t half = uint64_t{1} << (surplus - 1);
    digits = kept + (cut > half || (cut == half && (kept & 1) != 0) ? 1 : 0);
    exponent = -1074;
  }
  const double value = std::ldexp(static_cast<double>(digits), exponent);
  return num.negative_ != den.negative_ ? -value : value;
}

}  // namespace radar::exact
