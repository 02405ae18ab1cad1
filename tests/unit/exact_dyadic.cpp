// Compares the integers and double-doubles of engine/exact with Boost's rationals.
#include <bit>
#include <limits>

#include "exact/double_double.h"
#include "exact/dyadic.h"
#include "exact_oracle.h"
#include "soups.h"
#include "support/catch.h"

using namespace radar::exact;
using oracle::Rational;
using soups::Random;

namespace {

/// Any finite double: ordinary, integer, subnormal, huge, zero.
double anyDouble(Random& random) {
  switch (random.integer(0, 5)) {
    case 0:
      return random.integer(-9, 9);
    case 1:
      return std::ldexp(random.uniform(-1, 1), random.integer(-1074, 1024));
    case 2:
      return std::ldexp(static_cast<double>(random.integer(-7, 7)), random.integer(-1074, 1000));
    case 3:
      return random.chance(0.5) ? std::numeric_limits<double>::max() : -std::numeric_limits<double>::denorm_min();
    default:
      return random.uniform(-100, 100);
  }
}

}  // namespace

TEST_CASE("sums and products of dyadics are exact for all finite doubles") {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    double v[6];
    for (double& c : v) c = anyDouble(random);
    const Dyadic ours = (Dyadic(v[0]) - Dyadic(v[1])) * Dyadic(v[2]) + (Dyadic(v[3]) + Dyadic(v[4])) * Dyadic(v[5]);
    const Rational truth =
        (Rational(v[0]) - Rational(v[1])) * Rational(v[2]) + (Rational(v[3]) + Rational(v[4])) * Rational(v[5]);
    INFO("case " << i);
    REQUIRE(ours.sign() == truth.sign());
    // The quotient is rounded to nearest, so it is off by at most half a unit in its last place.
    const Dyadic one(1);
    const double nearest = quotient(ours, one);
    if (std::abs(nearest) > 0x1p-1000 && std::abs(nearest) < 0x1p1000) {
      const Rational off = abs(Rational(truth - Rational(nearest)));
      REQUIRE(off * Rational(0x1p53) <= abs(truth));
    }
    // A quotient of 53 bits by itself uses all digits.
    if (truth.sign() != 0) REQUIRE(quotient(ours, ours) == 1);
    REQUIRE((ours - ours).sign() == 0);
  }
}

TEST_CASE("a Dyadic holds the largest expression of engine/exact") {
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  const Dyadic gap = Dyadic(most) - Dyadic(-least), minor = gap * gap - gap * Dyadic(least);
  const Dyadic det = gap * minor + gap * minor + gap * minor, square = gap * gap + gap * gap + gap * gap;
  const Dyadic left = det * det * square, right = det * det * (gap * gap);
  REQUIRE((left - right).sign() == 1);
  REQUIRE(quotient(left, right) == 3);
}

TEST_CASE("a quotient is rounded to the nearest double, ties to even") {
  Random random(2);
  int subnormal = 0;
  for (int i = 0; i < 20000; ++i) {
    const double p = anyDouble(random), q = anyDouble(random), r = anyDouble(random);
    if (q == 0 || r == 0) continue;
    INFO("case " << i << ": " << p << " / (" << q << " * " << r << ")");
    const double ours = quotient(Dyadic(p), Dyadic(q) * Dyadic(r));
    const Rational truth = Rational(p) / (Rational(q) * Rational(r));
    if (!std::isfinite(ours)) {
      REQUIRE(abs(truth) > Rational(std::numeric_limits<double>::max()));
      continue;
    }
    REQUIRE((truth == 0 || ours == 0 || (truth > 0) == (ours > 0)));
    if (std::abs(ours) == std::numeric_limits<double>::max()) continue;
    const auto [below, above] = oracle::roundedTo(ours);
    REQUIRE(below <= truth);
    REQUIRE(truth <= above);
    if (truth == below || truth == above) REQUIRE((std::bit_cast<uint64_t>(ours) & 1) == 0);
    subnormal += ours != 0 && std::abs(ours) < std::numeric_limits<double>::min();
  }
  REQUIRE(subnormal > 100);
}

TEST_CASE("double-double sums and products keep their error bounds") {
  Random random(3);
  const Rational u = Rational(1) / (Rational(2) * (uint64_t{1} << 52)), square = u * u;
  for (int i = 0; i < 20000; ++i) {
    const auto any = [&] {
      const double high = std::ldexp(random.uniform(-1, 1), random.integer(-60, 60));
      return quickSum(high, high * 0x1p-53 * random.uniform(-1, 1));
    };
    const auto exact = [](const DoubleDouble& t) { return Rational(t.high) + Rational(t.low); };
    const DoubleDouble p = any(), q = random.chance(0.2) ? quickSum(-p.high, p.low * random.uniform(-1, 1)) : any();
    const Rational s = exact(p) + exact(q), m = exact(p) * exact(q);
    REQUIRE(abs(exact(p + q) - s) <= 4 * square * abs(s));
    REQUIRE(abs(exact(p * q) - m) <= 8 * square * abs(m));
  }
}
