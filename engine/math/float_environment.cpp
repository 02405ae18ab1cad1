#include "math/float_environment.h"

#if RADAR_FLOATS_BY_SSE
#include <xmmintrin.h>
#endif

namespace radar {

// Not inline, so that compilers move no arithmetic across.

#if RADAR_FLOATS_BY_SSE

namespace {

// Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, 10.2.3: traps masked, the rest 0; the lowest
// six bits record exceptions.
constexpr unsigned int kDefault = 0x1f80, kControl = ~0x3fu;

}  // namespace

FloatEnvironment::FloatEnvironment() : caller_(_mm_getcsr()) {
  if ((caller_ & kControl) != kDefault) _mm_setcsr(kDefault);
}
FloatEnvironment::~FloatEnvironment() {
  if ((caller_ & kControl) != kDefault) _mm_setcsr(caller_);
}

#else

FloatEnvironment::FloatEnvironment() {
  std::fegetenv(&caller_);
  std::fesetenv(FE_DFL_ENV);
}
FloatEnvironment::~FloatEnvironment() {
  std::fesetenv(&caller_);
}

#endif

}  // namespace radar
