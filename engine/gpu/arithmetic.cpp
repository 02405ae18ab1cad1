#include "gpu/arithmetic.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "exact/double_double.h"
#include "gpu/barrier.h"
#include "gpu/kernel.h"
#include "gpu/submission.h"
#include "math/float_environment.h"
#include "spirv/radar_shaders.h"

namespace radar::gpu {

namespace {

// The kind of numbers in a trial. Ordinary numbers have both signs and use every bit of the significand.
enum class Kind {
  wide,       ///< magnitudes far apart
  cancelled,  ///< a sum cancels, which shows whether a product was rounded before, or fused into a multiply-add
  halfway,    ///< doubles: a quotient close to the middle between two doubles
  subnormal   ///< x is subnormal
};

Kind kindOf(size_t trial) {
  constexpr Kind kKinds[] = {Kind::wide, Kind::cancelled, Kind::wide,      Kind::halfway,
                             Kind::wide, Kind::cancelled, Kind::subnormal, Kind::wide};
  return kKinds[trial % std::size(kKinds)];
}

class Numbers {
 public:
  double significand() { return 1 + std::ldexp(static_cast<double>(random_() >> 12), -52); }
  double wide(int exponents) {
    const double x = std::ldexp(significand(), static_cast<int>(random_() % (2 * exponents + 1)) - exponents);
    return random_() % 2 == 0 ? x : -x;
  }
  uint64_t bits() { return random_(); }

 private:
  std::mt19937_64 random_{1};
};

std::vector<FloatTrial> floatTrials() {
  Numbers numbers;
  std::vector<FloatTrial> trials(kTrials);
  for (size_t i = 0; i < trials.size(); ++i) {
    FloatTrial& t = trials[i];
    t.x = static_cast<float>(numbers.wide(40));
    t.y = static_cast<float>(numbers.wide(40));
    t.z = static_cast<float>(numbers.wide(40));
    t.integer = static_cast<uint32_t>(numbers.bits() & 0xffffff);
    if (kindOf(i) == Kind::cancelled) {
      t.z = -(t.x * t.y);
      t.y = i % 16 < 8 ? t.y : static_cast<float>(-t.x * 1.0000003);
    }
    if (kindOf(i) == Kind::subnormal) {
      const auto fraction = static_cast<uint32_t>(numbers.bits() & 0x7fffff) | 1;
      t.x = std::bit_cast<float>(fraction);
      t.y = 0x1p30f;
      t.z = 0;
    }
    t.low = static_cast<float>(0x1p-24 * double{t.x} * numbers.wide(0));
    const double precise = numbers.wide(79);
    t.bits[0] = static_cast<uint32_t>(std::bit_cast<uint64_t>(precise));
    t.bits[1] = static_cast<uint32_t>(std::bit_cast<uint64_t>(precise) >> 32);
    // Any bits but those of infinities and NaNs; includes subnormal numbers.
    const auto bits = static_cast<uint32_t>(numbers.bits());
    t.copied = std::bit_cast<float>((bits & 0x7f800000u) == 0x7f800000u || i % 4 == 0 ? bits & 0x807fffffu : bits);
  }
  return trials;
}

std::vector<DoubleTrial> doubleTrials() {
  Numbers numbers;
  std::vector<DoubleTrial> trials(kTrials);
  for (size_t i = 0; i < trials.size(); ++i) {
    DoubleTrial& t = trials[i];
    t.x = numbers.wide(60);
    t.y = numbers.wide(60);
    for (double& factor : t.row) factor = numbers.wide(60);
    for (float& coordinate : t.p) coordinate = static_cast<float>(numbers.wide(60));
    switch (kindOf(i)) {
      case Kind::wide:
        break;
      case Kind::cancelled:
        t.y = -t.x * 1.0000001;
        t.row[3] = -(t.row[0] * t.p[0]);
        if (i % 4 == 1) t.row[1] = t.row[2] = 0;
        break;
      case Kind::halfway: {
        const double quotient = numbers.wide(20), half = std::ldexp(1.0, std::ilogb(quotient) - 53);
        t.x = std::fma(t.y, quotient, t.y * half);
        break;
      }
      case Kind::subnormal:
        t.p[0] = std::bit_cast<float>(static_cast<uint32_t>(numbers.bits() & 0x7fffff) | 1);
        t.x = std::bit_cast<double>((numbers.bits() >> 12) | 1);
        t.y = 0x1p60;
        break;
    }
  }
  return trials;
}

// Runs a shader on the trials and reads its outcomes.
template <class Outcome, class Trial>
std::vector<Outcome> outcomesOf(const Device::Impl& device, const Program& program, const std::vector<Trial>& trials,
                                Slot<Trial> trialSlot, Slot<Outcome> outcomeSlot) {
  Upload upload(device);
  Array<Trial> given(device, "trials", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  Array<Outcome> computed(device, "outcomes", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  Buffer readback(device, "outcome readback", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const VkBufferCopy copy{0, 0, kTrials * sizeof(Outcome)};
  given.reserve(kTrials);
  computed.reserve(kTrials);
  readback.reserve(copy.size);
  upload.begin();
  upload.add(trials.data(), bytesOf(trials), given);

  Submission submission(device, false);
  const Commands commands = submission.begin();
  submission.stage(program.shader->name);
  upload.record(commands);
  transferToComputeReadWrite(commands);
  Passes run(device);
  run(commands, program, kTrials / kTrialGroup, {{trialSlot, given}, {outcomeSlot, computed}});
  computeWriteToCopy(commands);
  commands->CmdCopyBuffer(commands, computed.get(), readback.get(), 1, &copy);
  copyToHost(commands);
  submission.submitAndWait();
  std::vector<Outcome> outcomes(kTrials);
  std::memcpy(outcomes.data(), readback.mapped(), copy.size);
  return outcomes;
}

// What a trial was given, and what the device made of it.
template <class Trial, class Outcome>
struct Case {
  const Trial& given;
  const Outcome& found;
  const Trial& first;  ///< the first trial of all
};
using FloatCase = Case<FloatTrial, FloatOutcome>;
using DoubleCase = Case<DoubleTrial, DoubleOutcome>;

struct Verdict {
  bool isRight;
  double ulps = std::numeric_limits<double>::quiet_NaN();  ///< off, if measured
};

// Which trials a check looks at.
enum class On { normal, subnormal, all };

template <class Case>
struct Check {
  const char* operation;
  const char* needed;
  Verdict (*judge)(const Case&);
  On on = On::normal;
};

template <class Real>
bool sameBits(Real p, Real q) {
  using Bits = std::array<std::byte, sizeof(Real)>;
  return std::bit_cast<Bits>(p) == std::bit_cast<Bits>(q);
}

// A unit in the last place of x.
double ulpOf(float x) {
  return std::ldexp(1.0, std::max(x == 0 ? -126 : std::ilogb(x), -126) - 23);
}
double ulpOf(double x) {
  return std::ldexp(1.0, std::max(x == 0 ? -1022 : std::ilogb(x), -1022) - 52);
}

// Off by less than an ulp, whatever the rounding direction. The larger ulp counts: just below a power of two, `exact`
// has half the ulp of a result that reaches that power.
Verdict rounded(float result, exact::DoubleDouble exact) {
  const double off = std::abs((result - exact.high) - exact.low);
  const double ulps = off / std::max(ulpOf(static_cast<float>(exact.high)), ulpOf(result));
  return {ulps < 1, ulps};
}

Verdict within(float result, double exact, double mostUlps) {
  const double ulps = std::abs(result - exact) / ulpOf(static_cast<float>(exact));
  return {ulps <= mostUlps, ulps};
}

// The bits that the CPU computes.
Verdict same(double result, double exact) {
  return {sameBits(result, exact), std::abs(result - exact) / ulpOf(exact)};
}

Verdict ordered(uint32_t found, bool isLess) {
  return {found == (isLess ? 3u : 4u)};
}

Verdict sumsInParts(const FloatCase& c) {
  const auto leading = [](float x, uint32_t mask) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) & mask); };
  const FloatTrial& t = c.given;
  const double product = double{leading(t.x, 0xffffff00u)} * leading(t.z, 0xffff0000u);
  const double exact = t.low + (double{t.y} + product);
  const double terms = 2 * std::abs(t.x) + std::abs(t.low) + std::abs(t.y) + std::abs(product);
  return {std::abs(c.found.addedHigh - exact + c.found.addedLow) <= 0x1p-40 * terms};
}

Verdict differencesInParts(const FloatCase& c) {
  const auto isNear = [](double high, double low, double result) {
    const double exact = high + low;
    return std::abs(result - exact) <= 0x1p-23 * (std::abs(high) + std::abs(low) + std::abs(exact));
  };
  const FloatTrial &t = c.given, &first = c.first;
  return {isNear(double{t.x} - t.y, double{t.low} - t.z, c.found.apart) &&
          isNear(double{t.x} - first.x, double{t.low} - first.low, c.found.apartFirst)};
}

Verdict splitByBits(const FloatCase& c) {
  const double exact = std::bit_cast<double>(uint64_t{c.given.bits[1]} << 32 | c.given.bits[0]);
  const double off = (exact - std::bit_cast<float>(c.found.high)) - c.found.rest;
  return {std::abs(off) <= 0x1p-46 * std::abs(exact) + 0x1p-126};
}

Verdict boxed(const FloatCase& c) {
  const double x = c.given.x, most = x + std::abs(x) * (0.0001 - 0x1p-22);
  const double centre = c.found.centre, halfExtent = c.found.halfExtent;
  return {centre - halfExtent <= x && centre + halfExtent >= most && halfExtent <= 0.0001 * std::abs(x)};
}

// On what the bounds of mode contact rest.
constexpr Check<FloatCase> kFloatChecks[] = {
    {"float addition", "less than 1 ulp off",
     [](const FloatCase& c) { return rounded(c.found.sum, exact::sum(c.given.x, c.given.y)); }},
    {"float multiplication", "less than 1 ulp off",
     [](const FloatCase& c) { return rounded(c.found.product, {double{c.given.x} * c.given.y}); }},
    {"float division", "at most 2.5 ulp off",
     [](const FloatCase& c) { return within(c.found.quotient, double{c.given.x} / c.given.y, 2.5); }},
    {"float x * y + z, declared precise", "the product is rounded before the sum",
     [](const FloatCase& c) { return rounded(c.found.chain, exact::sum(c.found.product, c.given.z)); }},
    {"float sums in two parts, declared precise", "within 2^-40 of the terms", sumsInParts},
    {"float differences in two parts, declared precise", "within 2^-23 of each part's and the result's",
     differencesInParts},
    {"double to two floats, by bits", "within 2^-46 of itself", splitByBits, On::all},
    {"float box around two corners, declared precise", "contains them", boxed},
    {"float inverse square root", "at most 2 ulp off",
     [](const FloatCase& c) { return within(c.found.inverseRoot, 1 / std::sqrt(std::abs(double{c.given.y})), 2); }},
    {"float comparison, least and greatest", "exact",
     [](const FloatCase& c) { return ordered(c.found.order, c.given.x < c.given.y); }},
    {"integer to float, below 2^24", "exact",
     [](const FloatCase& c) { return Verdict{c.found.ofInteger == static_cast<float>(c.given.integer)}; }, On::all},
    {"loading and storing floats", "the same bits, subnormal numbers included",
     [](const FloatCase& c) { return Verdict{sameBits(c.found.copied, c.given.copied)}; }, On::all},
    {"float multiplication of subnormal numbers", "correct, or as if they were 0",
     [](const FloatCase& c) { return Verdict{c.found.product == c.given.x * c.given.y || c.found.product == 0}; },
     On::subnormal}};

Verdict placed(const DoubleCase& c) {
  Transform pose;
  std::copy(std::begin(c.given.row), std::end(c.given.row), pose.m.begin());
  return same(c.found.placed, transformPoint(pose, c.given.p)[0]);
}

// What x + y, the larger plus the smaller, and x * y lost to rounding.
Verdict rests(const DoubleCase& c) {
  const double x = c.given.x, y = c.given.y, lost = exact::sum(x, y).low;
  const double* found = c.found.rests;
  return {found[0] == lost && found[1] == lost && found[2] == std::fma(x, y, -(x * y))};
}

Verdict chained(const DoubleCase& c) {
  const exact::DoubleDouble x{c.given.x, 0}, y{c.given.y, 0}, xy = exact::product(x.high, y.high);
  const exact::DoubleDouble chain = (x + xy) * (xy - y);
  return {c.found.chain[0] == chain.high && c.found.chain[1] == chain.low};
}

Verdict split(const DoubleCase& c) {
  const double off = (c.given.x - c.found.high) - c.found.low;
  return {std::abs(off) <= 0x1p-46 * std::abs(c.given.x)};
}

constexpr const char* kBits = "the bits of IEEE 754, rounded to nearest";

// On what the solution of pairs of triangles in doubles rests.
constexpr Check<DoubleCase> kDoubleChecks[] = {
    {"double addition", kBits, [](const DoubleCase& c) { return same(c.found.sum, c.given.x + c.given.y); }},
    {"double multiplication", kBits, [](const DoubleCase& c) { return same(c.found.product, c.given.x * c.given.y); }},
    {"double placement of a vertex, declared precise", kBits, placed, On::all},
    {"float to double, by bits", kBits, [](const DoubleCase& c) { return same(c.found.ofFloat, double{c.given.p[0]}); },
     On::all},
    {"double division, composed of the above", kBits,
     [](const DoubleCase& c) { return same(c.found.corrected, c.given.x / c.given.y); }},
    {"loading and storing doubles", kBits, [](const DoubleCase& c) { return same(c.found.copied, c.given.row[0]); },
     On::all},
    {"what double sums and products lose, declared precise", "exact", rests},
    {"sums and products of two doubles each, declared precise", "the bits of the CPU", chained},
    {"double split into two floats", "within 2^-46 of itself", split},
    {"double comparison, least and greatest", "exact",
     [](const DoubleCase& c) { return ordered(c.found.order, c.given.x < c.given.y); }},
    {"double to float", "less than 1 ulp off",
     [](const DoubleCase& c) { return rounded(c.found.ofDouble, {c.given.x}); }}};

constexpr Check<DoubleCase> kDivision[] = {
    {"double division", kBits, [](const DoubleCase& c) { return same(c.found.quotient, c.given.x / c.given.y); }}};

// Appends the results; returns whether all are as needed.
template <class Trial, class Outcome>
bool judge(std::span<const Check<Case<Trial, Outcome>>> table, const std::vector<Trial>& trials,
           const std::vector<Outcome>& outcomes, const char* ifWrong, std::vector<ArithmeticCheck>& checks) {
  bool passed = true;
  for (const auto& row : table) {
    ArithmeticCheck check{.operation = row.operation, .needed = row.needed, .ifWrong = ifWrong};
    for (size_t i = 0; i < trials.size(); ++i) {
      if (row.on != On::all && (kindOf(i) == Kind::subnormal) != (row.on == On::subnormal)) continue;
      const Verdict verdict = row.judge({trials[i], outcomes[i], trials[0]});
      check.worst = check.tried == 0 ? verdict.ulps : std::max(check.worst, verdict.ulps);
      ++check.tried;
      check.wrong += verdict.isRight ? 0 : 1;
    }
    passed = passed && check.passed();
    checks.push_back(std::move(check));
  }
  return passed;
}

}  // namespace

Arithmetic tryArithmetic(const Device::Impl& device, bool hasDoubles, uint32_t falsified) {
  Arithmetic arithmetic;
  const std::vector<FloatTrial> floats = floatTrials();
  const std::vector<FloatOutcome> floatOutcomes =
      outcomesOf(device, {shaders::kFloats, {falsified}}, floats, kSlotFloatTrials, kSlotFloatOutcomes);
  arithmetic.floats =
      judge<FloatTrial, FloatOutcome>(kFloatChecks, floats, floatOutcomes,
                                      "the search's bounds do not hold: the device is not used", arithmetic.checks);
  if (!hasDoubles) return arithmetic;
  const std::vector<DoubleTrial> doubles = doubleTrials();
  const std::vector<DoubleOutcome> outcomes =
      outcomesOf(device, {shaders::kDoubles, {falsified}}, doubles, kSlotDoubleTrials, kSlotDoubleOutcomes);
  arithmetic.doubles = judge<DoubleTrial, DoubleOutcome>(
      kDoubleChecks, doubles, outcomes, "doubles are not used: the CPU decides pairs that are too close for floats",
      arithmetic.checks);
  arithmetic.dividesRight = judge<DoubleTrial, DoubleOutcome>(
      kDivision, doubles, outcomes, "it is not used: divisions are composed of sums and products", arithmetic.checks);
  return arithmetic;
}

}  // namespace radar::gpu

namespace radar {

std::vector<ArithmeticCheck> checkArithmetic(const Device& device) {
  const FloatEnvironment floats;
  device.impl().requireQueue("checkArithmetic()");
  return gpu::tryArithmetic(device.impl(), device.handles().doubles).checks;
}

}  // namespace radar
