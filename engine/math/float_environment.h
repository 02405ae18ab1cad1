// The floating-point environment of a thread: rounding, subnormal numbers, traps.
#pragma once

#if defined(__SSE2__) || defined(_M_X64)
#define RADAR_FLOATS_BY_SSE 1
#else
#include <cfenv>
#define RADAR_FLOATS_BY_SSE 0
#endif

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "The engine's bounds need IEEE arithmetic: compile it without -ffast-math and -ffinite-math-only."
#endif

namespace radar {

/// While this lives, its thread, and threads that it starts, round to nearest, keep subnormal numbers and do not trap:
/// all bounds rely on it. Then the environment is as it was. A caller may have any; so each public function that
/// computes with floats begins with one of these. Costs a few nanoseconds.
class FloatEnvironment {
 public:
  FloatEnvironment();
  ~FloatEnvironment();
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
#if RADAR_FLOATS_BY_SSE
  unsigned int caller_;
#else
  std::fenv_t caller_;
#endif
};

}  // namespace radar
