// Runs Catch2, and fails the running test on any message of the validation layers.
#if __has_include(<catch2/catch_all.hpp>)
#include <cstdio>

#include <catch2/catch_all.hpp>
#else
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#endif

#include "support/test_device.h"

namespace {

#if CATCH_VERSION_MAJOR < 3
using Listener = Catch::TestEventListenerBase;
std::string nameOf(const Catch::TestCaseStats& stats) {
  return stats.testInfo.name;
}
#else
using Listener = Catch::EventListenerBase;
std::string nameOf(const Catch::TestCaseStats& stats) {
  return stats.testInfo->name;
}
#endif

struct ValidationListener : Listener {
  using Listener::Listener;
  void testCaseEnded(const Catch::TestCaseStats& stats) override { report(nameOf(stats)); }
  static void report(const std::string& when) {
    for (const std::string& message : radar::test::takeValidationMessages()) {
      std::fprintf(stderr, "validation message in \"%s\":\n%s\n", when.c_str(), message.c_str());
      failed = true;
    }
  }
  static inline bool failed = false;
};

}  // namespace

CATCH_REGISTER_LISTENER(ValidationListener)

int main(int argc, char** argv) {
  const int result = Catch::Session().run(argc, argv);
  radar::test::endRun();  // not where Catch2 says that a run ended: that may be in a signal's handler
  ValidationListener::report("the end of the run");
  return ValidationListener::failed ? 1 : result;
}
