// With the environment variable RADAR_TEST_SUBNORMALS=off, threads that Vulkan drivers start flush subnormal numbers to
// 0, both operands and results. So do then lavapipe's shaders, as those of many GPUs; the engine's own threads do not.
#include <dlfcn.h>
#include <pthread.h>
#include <threads.h>

#include <cstdlib>
#include <string_view>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace {

template <class Result>
struct Start {
  Result (*function)(void*);
  void* argument;
};

template <class Result>
Result begin(void* given) {
  const Start<Result> start = *static_cast<Start<Result>*>(given);
  delete static_cast<Start<Result>*>(given);
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // FTZ and DAZ
#endif
  return start.function(start.argument);
}

// Whether a thread flushes that code at this address starts.
bool flushes(void* caller) {
  const char* setting = std::getenv("RADAR_TEST_SUBNORMALS");
  Dl_info found;
  return setting != nullptr && std::string_view(setting) == "off" && dladdr(caller, &found) != 0 &&
         std::string_view(found.dli_fname).find("libvulkan_") != std::string_view::npos;
}

}  // namespace

// These stand before the C library's.
extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread,
                                                                     const pthread_attr_t* attributes,
                                                                     void* (*function)(void*),
                                                                     void* argument) noexcept {
  using Function = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto kCreate = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_create"));
  if (!flushes(__builtin_return_address(0))) return kCreate(thread, attributes, function, argument);
  return kCreate(thread, attributes, begin<void*>, new Start<void*>{function, argument});
}

extern "C" __attribute__((visibility("default"))) int thrd_create(thrd_t* thread, int (*function)(void*),
                                                                  void* argument) {
  using Function = int (*)(thrd_t*, int (*)(void*), void*);
  static const auto kCreate = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "thrd_create"));
  if (!flushes(__builtin_return_address(0))) return kCreate(thread, function, argument);
  return kCreate(thread, begin<int>, new Start<int>{function, argument});
}
