// Runs Catch2, and fails the running test on any message of the validation layers.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "support/test_device.h"

namespace {

struct ValidationListener : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;
  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    for (const std::string& message : radar::test::takeValidationMessages()) {
      std::fprintf(stderr, "validation message in \"%s\":\n%s\n", stats.testInfo.name.c_str(), message.c_str());
      failed = true;
    }
  }
  static inline bool failed = false;
};

}  // namespace

CATCH_REGISTER_LISTENER(ValidationListener)

int main(int argc, char** argv) {
  const int result = Catch::Session().run(argc, argv);
  return ValidationListener::failed ? 1 : result;
}
