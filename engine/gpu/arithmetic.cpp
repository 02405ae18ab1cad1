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
#include "spirv/arithmetic_doubles_comp.h"
#include "spirv/arithmetic_floats_comp.h"

namespace radar::gpu {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The kind of numbers in a trial. Ordinary numbers have both signs and use every bit of the significand.
enum class Kind {
  wide,       ///< magnitudes far apart
  cancelled,  ///< a sum cancels, which shows whether a product was rounded before, or fused into a multiply-add
  halfway,    ///< doubles: a quotient close to the middle between two doubles
  subnormal,  ///< x is subnormal
  overflow    ///< floats: the product overflows
};

Kind kindOf(size_t trial) {
  constexpr Kind kKinds[] = {Kind::wide, Kind::cancelled, Kind::wide,      Kind::halfway,
                             Kind::wide, Kind::cancelled, Kind::subnormal, Kind::overflow};
  return kKinds[trial % std::size(kKinds)];
}

bool isOrdinary(size_t trial) {
  return kindOf(trial) != Kind::subnormal && kindOf(trial) != Kind::overflow;
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
    if (kindOf(i) == Kind::overflow) {
      t.x = std::ldexp(t.x, 80);
      t.y = std::ldexp(t.y, 80);
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
      case Kind::overflow:
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
std::vector<Outcome> outcomesOf(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name,
                                std::span<const uint32_t> constants, const std::vector<Trial>& trials,
                                Slot<Trial> trialSlot, Slot<Outcome> outcomeSlot) {
  const Kernel kernel(device, spirv, name, constants);
  Upload upload(device);
  Array<Trial> given(device, "trials", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  Array<Outcome> computed(device, "outcomes", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  Buffer readback(device, "outcome readback", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const VkBufferCopy copy{0, 0, kTrials * sizeof(Outcome)};
  given.reserve(kTrials);
  computed.reserve(kTrials);
  readback.reserve(copy.size);
  KernelArguments arguments(kernel);
  arguments.set({{trialSlot, given}, {outcomeSlot, computed}});
  upload.begin(Upload::aligned(bytesOf(trials)));
  upload.add(trials.data(), bytesOf(trials), given);

  Submission submission(device, false);
  const Commands commands = submission.begin();
  submission.stage(name);
  upload.record(commands);
  transferToComputeReadWrite(commands);
  arguments.dispatch(commands, kTrials / kTrialGroup);
  computeWriteToCopy(commands);
  commands->CmdCopyBuffer(commands, computed.get(), readback.get(), 1, &copy);
  copyToHost(commands);
  submission.submitAndWait();
  std::vector<Outcome> outcomes(kTrials);
  std::memcpy(outcomes.data(), readback.mapped(), copy.size);
  return outcomes;
}

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

// An exact result as two doubles: high + low, |low| at most half an ulp of high.
struct ExactResult {
  double high, low;
};

ExactResult exactSum(double x, double y) {
  const double sum = x + y, part = sum - x;
  return {sum, (x - (sum - part)) + (y - part)};
}

// The rounding direction of a device: one that no result contradicts.
class Rounding {
 public:
  void add(ExactResult exact, float result) {
    const double off = (result - exact.high) - exact.low;
    if (std::abs(off) > 0.5 * ulpOf(result)) isNearest_ = false;
    if (off != 0 && (off > 0) == (result > 0)) isTowardsZero_ = false;
    if (off > 0) isDown_ = false;
    if (off < 0) isUp_ = false;
  }
  const char* words() const {
    if (isNearest_) return "rounded to nearest";
    if (isTowardsZero_) return "rounded towards zero";
    return isDown_ ? "rounded down" : isUp_ ? "rounded up" : "rounded in no fixed direction";
  }

 private:
  bool isNearest_ = true, isTowardsZero_ = true, isDown_ = true, isUp_ = true;
};

// Collects the results of the checks, one check after the other.
class Findings {
 public:
  explicit Findings(std::vector<ArithmeticCheck>& checks) : checks_(checks) {}

  void begin(const char* operation, const char* needed) {
    checks_.push_back({.operation = operation, .needed = needed});
  }
  void result(bool isRight, double ulps = kNaN) {
    ArithmeticCheck& check = checks_.back();
    ++check.tried;
    check.wrong += isRight ? 0 : 1;
    check.worst = check.tried == 1 ? ulps : std::max(check.worst, ulps);
  }
  uint32_t tried() const { return checks_.back().tried; }
  /// Returns whether the check passed. Its consequence is `otherwise` if it did, else `consequence`.
  bool end(const std::string& found, const char* otherwise, const char* consequence) {
    ArithmeticCheck& check = checks_.back();
    check.found =
        check.passed() ? found : std::to_string(check.wrong) + " of " + std::to_string(check.tried) + " wrong";
    check.consequence = check.passed() ? otherwise : consequence;
    return check.passed();
  }

 private:
  std::vector<ArithmeticCheck>& checks_;
};

constexpr const char* kBoundsHold = "the search's bounds hold";
constexpr const char* kUnusable = "the search's bounds do not hold: the device is not used";
constexpr const char* kSolved = "pairs of triangles are solved in doubles";
constexpr const char* kUnsolved = "doubles are not used: the CPU decides pairs that are too close for floats";

// Checks that a sum or a product is off by less than an ulp, whatever the rounding direction.
bool checkRounded(Findings& findings, const char* operation, const std::vector<FloatTrial>& trials,
                  const std::vector<FloatOutcome>& outcomes, ExactResult (*exactOf)(const FloatTrial&),
                  float FloatOutcome::*member) {
  findings.begin(operation, "less than 1 ulp off");
  Rounding rounding;
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const ExactResult exact = exactOf(trials[i]);
    const float result = outcomes[i].*member;
    const double off = std::abs((result - exact.high) - exact.low), ulp = ulpOf(static_cast<float>(exact.high));
    // The larger ulp counts: just below a power of two, `exact` has half the ulp of a result that reaches that power.
    findings.result(off < std::max(ulp, ulpOf(result)), off / ulp);
    rounding.add(exact, result);
  }
  return findings.end(rounding.words(), kBoundsHold, kUnusable);
}

const char* inWords(size_t kept, size_t flushed) {
  return flushed == 0 ? "kept" : kept == 0 ? "flushed to 0" : "sometimes kept, sometimes flushed to 0";
}

float leading(float x, uint32_t mask) {
  return std::bit_cast<float>(std::bit_cast<uint32_t>(x) & mask);
}

bool checkFloats(Findings& findings, const std::vector<FloatTrial>& trials, const std::vector<FloatOutcome>& outcomes) {
  bool usable = checkRounded(
      findings, "float addition", trials, outcomes, [](const FloatTrial& t) { return exactSum(t.x, t.y); },
      &FloatOutcome::sum);
  usable &= checkRounded(
      findings, "float multiplication", trials, outcomes,
      [](const FloatTrial& t) {
        return ExactResult{double{t.x} * t.y, 0};
      },
      &FloatOutcome::product);

  findings.begin("float division", "at most 2.5 ulp off");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const double exact = double{trials[i].x} / trials[i].y;
    const double ulps = std::abs(outcomes[i].quotient - exact) / ulpOf(static_cast<float>(exact));
    findings.result(ulps <= 2.5, ulps);
  }
  usable &= findings.end("as needed", kBoundsHold, kUnusable);

  findings.begin("float x * y + z, declared precise", "the product is rounded before the sum");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const ExactResult exact = exactSum(outcomes[i].product, trials[i].z);
    const double off = std::abs((outcomes[i].chain - exact.high) - exact.low);
    const double ulp = std::max(ulpOf(static_cast<float>(exact.high)), ulpOf(outcomes[i].chain));
    findings.result(off < ulp, off / ulp);
  }
  usable &= findings.end("not fused", kBoundsHold, kUnusable);

  findings.begin("float sums in two parts, declared precise", "within 2^-40 of the terms");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const FloatTrial& t = trials[i];
    const double product = double{leading(t.x, 0xffffff00u)} * leading(t.z, 0xffff0000u);
    const double exact = t.low + (double{t.y} + product);
    const double terms = 2 * std::abs(t.x) + std::abs(t.low) + std::abs(t.y) + std::abs(product);
    const double off = std::abs(outcomes[i].addedHigh - exact + outcomes[i].addedLow);
    findings.result(off <= 0x1p-40 * terms);
  }
  usable &= findings.end("as needed", kBoundsHold, kUnusable);

  findings.begin("float differences in two parts, declared precise", "within 2^-23 of each part's and the result's");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const FloatTrial &t = trials[i], &first = trials[0];
    const auto isNear = [](double high, double low, double result) {
      const double exact = high + low;
      return std::abs(result - exact) <= 0x1p-23 * (std::abs(high) + std::abs(low) + std::abs(exact));
    };
    findings.result(isNear(double{t.x} - t.y, double{t.low} - t.z, outcomes[i].apart) &&
                    isNear(double{t.x} - first.x, double{t.low} - first.low, outcomes[i].apartFirst));
  }
  usable &= findings.end("as needed", kBoundsHold, kUnusable);

  findings.begin("double to two floats, by bits", "within 2^-46 of itself");
  for (size_t i = 0; i < trials.size(); ++i) {
    const double exact = std::bit_cast<double>(uint64_t{trials[i].bits[1]} << 32 | trials[i].bits[0]);
    const double off = (exact - std::bit_cast<float>(outcomes[i].high)) - outcomes[i].rest;
    findings.result(std::abs(off) <= 0x1p-46 * std::abs(exact) + 0x1p-126);
  }
  usable &= findings.end("as needed", kBoundsHold, kUnusable);

  findings.begin("float box around two corners, declared precise", "contains them");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const double x = trials[i].x, most = x + std::abs(x) * (0.0001 - 0x1p-22);
    const double centre = outcomes[i].centre, halfExtent = outcomes[i].halfExtent;
    findings.result(centre - halfExtent <= x && centre + halfExtent >= most && halfExtent <= 0.0001 * std::abs(x));
  }
  usable &= findings.end("as needed", kBoundsHold, kUnusable);

  findings.begin("float inverse square root", "at most 2 ulp off");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const double exact = 1 / std::sqrt(std::abs(double{trials[i].y}));
    const double ulps = std::abs(outcomes[i].inverseRoot - exact) / ulpOf(static_cast<float>(exact));
    findings.result(ulps <= 2, ulps);
  }
  usable &= findings.end("as needed", kBoundsHold, kUnusable);

  findings.begin("float comparison, least and greatest", "exact");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (!isOrdinary(i)) continue;
    const bool isLess = trials[i].x < trials[i].y;
    findings.result(outcomes[i].order == (isLess ? 3u : 4u));
  }
  usable &= findings.end("exact", kBoundsHold, kUnusable);

  findings.begin("integer to float, below 2^24", "exact");
  for (size_t i = 0; i < trials.size(); ++i) {
    findings.result(outcomes[i].ofInteger == static_cast<float>(trials[i].integer));
  }
  usable &= findings.end("exact", kBoundsHold, kUnusable);

  findings.begin("loading and storing floats", "the same bits, subnormal numbers included");
  for (size_t i = 0; i < trials.size(); ++i) findings.result(sameBits(outcomes[i].copied, trials[i].copied));
  usable &= findings.end("the same bits", "corners reach the CPU unchanged", kUnusable);

  findings.begin("float multiplication of subnormal numbers", "correct, or as if they were 0");
  size_t kept = 0, flushed = 0;
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) != Kind::subnormal) continue;
    const float product = outcomes[i].product;
    const bool isKept = product == trials[i].x * trials[i].y;
    kept += isKept ? 1 : 0;
    flushed += product == 0 ? 1 : 0;
    findings.result(isKept || product == 0);
  }
  usable &= findings.end(inWords(kept, flushed), "the bounds allow for flushing", kUnusable);

  findings.begin("float multiplication that overflows", "");
  size_t infinite = 0, largest = 0;
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) != Kind::overflow) continue;
    const float product = std::abs(outcomes[i].product);
    infinite += std::isinf(product) ? 1 : 0;
    largest += product == std::numeric_limits<float>::max() ? 1 : 0;
    findings.result(true);
  }
  findings.end(infinite == findings.tried()  ? "infinity"
               : largest == findings.tried() ? "the largest float"
                                             : "infinity, the largest float or another number",
               "irrelevant: no sum or product of the search overflows", "");
  return usable;
}

double distanceInUlps(double result, double exact) {
  return std::abs(result - exact) / ulpOf(exact);
}

// Checks that results have the same bits as on the CPU.
bool checkBits(Findings& findings, const char* operation, const std::vector<DoubleTrial>& trials,
               const std::vector<DoubleOutcome>& outcomes, double (*exactOf)(const DoubleTrial&),
               double DoubleOutcome::*member, bool subnormals, const char* otherwise = kSolved,
               const char* consequence = kUnsolved) {
  findings.begin(operation, "the bits of IEEE 754, rounded to nearest");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) == Kind::subnormal && !subnormals) continue;
    const double exact = exactOf(trials[i]), result = outcomes[i].*member;
    findings.result(sameBits(result, exact), distanceInUlps(result, exact));
  }
  return findings.end("the same bits as on the CPU", otherwise, consequence);
}

// `restOf`: of a trial, what x + y, the larger plus the smaller, and x * y lost to rounding.
template <class RestOf>
void checkRests(Findings& findings, const std::vector<DoubleTrial>& trials, const RestOf& restOf) {
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) == Kind::subnormal) continue;
    const double x = trials[i].x, y = trials[i].y, ofSum = exactSum(x, y).low;
    findings.result(restOf(i, 0) == ofSum && restOf(i, 1) == ofSum && restOf(i, 2) == std::fma(x, y, -(x * y)));
  }
}

double placedOf(const DoubleTrial& t) {
  Transform pose;
  std::copy(std::begin(t.row), std::end(t.row), pose.m.begin());
  return transformPoint(pose, t.p)[0];
}

void checkDoubles(Arithmetic& arithmetic, Findings& findings, const std::vector<DoubleTrial>& trials,
                  const std::vector<DoubleOutcome>& outcomes) {
  bool usable = checkBits(
      findings, "double addition", trials, outcomes, [](const DoubleTrial& t) { return t.x + t.y; },
      &DoubleOutcome::sum, false);
  usable &= checkBits(
      findings, "double multiplication", trials, outcomes, [](const DoubleTrial& t) { return t.x * t.y; },
      &DoubleOutcome::product, false);
  usable &= checkBits(findings, "double placement of a vertex, declared precise", trials, outcomes, placedOf,
                      &DoubleOutcome::placed, true);
  usable &= checkBits(
      findings, "float to double, by bits", trials, outcomes, [](const DoubleTrial& t) { return double{t.p[0]}; },
      &DoubleOutcome::ofFloat, true);
  usable &= checkBits(
      findings, "double division, composed of the above", trials, outcomes,
      [](const DoubleTrial& t) { return t.x / t.y; }, &DoubleOutcome::corrected, false,
      "can replace the device's own division");
  usable &= checkBits(
      findings, "loading and storing doubles", trials, outcomes, [](const DoubleTrial& t) { return t.row[0]; },
      &DoubleOutcome::copied, true);

  findings.begin("what double sums and products lose, declared precise", "exact");
  checkRests(findings, trials, [&](size_t i, int k) { return outcomes[i].rests[k]; });
  usable &= findings.end("exact", kSolved, kUnsolved);
  findings.begin("the same, of vectors", "exact");
  for (int axis = 0; axis < 3; ++axis) {
    checkRests(findings, trials, [&](size_t i, int k) { return outcomes[i].vectorRests[3 * k + axis]; });
  }
  usable &= findings.end("exact", kSolved, kUnsolved);

  findings.begin("sums and products of two doubles each, declared precise", "the bits of the CPU");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) == Kind::subnormal) continue;
    const exact::DoubleDouble x{trials[i].x, 0}, y{trials[i].y, 0}, xy = exact::product(x.high, y.high);
    const exact::DoubleDouble chain = (x + xy) * (xy - y);
    findings.result(outcomes[i].chain[0] == chain.high && outcomes[i].chain[1] == chain.low);
  }
  usable &= findings.end("the same bits", kSolved, kUnsolved);

  findings.begin("double split into two floats", "within 2^-46 of itself");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) == Kind::subnormal) continue;
    const double off = (trials[i].x - outcomes[i].high) - outcomes[i].low;
    findings.result(std::abs(off) <= 0x1p-46 * std::abs(trials[i].x));
  }
  usable &= findings.end("as needed", kSolved, kUnsolved);

  findings.begin("double comparison, least and greatest", "exact");
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) == Kind::subnormal) continue;
    findings.result(outcomes[i].order == (trials[i].x < trials[i].y ? 3u : 4u));
  }
  usable &= findings.end("exact", kSolved, kUnsolved);

  findings.begin("double to float", "less than 1 ulp off");
  Rounding rounding;
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) == Kind::subnormal) continue;
    const double off = std::abs(outcomes[i].ofDouble - trials[i].x);
    const double ulp = std::max(ulpOf(static_cast<float>(trials[i].x)), ulpOf(outcomes[i].ofDouble));
    findings.result(off < ulp, off / ulp);
    rounding.add({trials[i].x, 0}, outcomes[i].ofDouble);
  }
  usable &= findings.end(rounding.words(), kSolved, kUnsolved);

  findings.begin("double multiplication of subnormal numbers", "");
  size_t kept = 0, flushed = 0;
  for (size_t i = 0; i < trials.size(); ++i) {
    if (kindOf(i) != Kind::subnormal) continue;
    const double product = outcomes[i].product;
    kept += product == trials[i].x * trials[i].y ? 1 : 0;
    flushed += product == 0 ? 1 : 0;
    findings.result(true);
  }
  findings.end(kept + flushed == findings.tried() ? inWords(kept, flushed) : "neither kept nor flushed to 0",
               "irrelevant: the bounds allow for the loss", "");

  arithmetic.doubles = usable;
  arithmetic.dividesRight = checkBits(
      findings, "double division", trials, outcomes, [](const DoubleTrial& t) { return t.x / t.y; },
      &DoubleOutcome::quotient, false, "used", "not used: divisions are composed of sums and products");
}

}  // namespace

Arithmetic tryArithmetic(const Device::Impl& device, bool hasDoubles, uint32_t falsified) {
  Arithmetic arithmetic;
  Findings findings(arithmetic.checks);
  const std::vector<FloatTrial> floats = floatTrials();
  arithmetic.floats = checkFloats(findings, floats,
                                  outcomesOf(device, k_arithmetic_floats_comp, "float arithmetic",
                                             std::array{falsified}, floats, kSlotFloatTrials, kSlotFloatOutcomes));
  if (!hasDoubles) return arithmetic;
  const std::vector<DoubleTrial> doubles = doubleTrials();
  checkDoubles(arithmetic, findings, doubles,
               outcomesOf(device, k_arithmetic_doubles_comp, "double arithmetic", std::array{0u, falsified}, doubles,
                          kSlotDoubleTrials, kSlotDoubleOutcomes));
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
