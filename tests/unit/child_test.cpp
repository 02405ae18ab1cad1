#include <csignal>
#include <stdexcept>

#include "child/in_child.h"
#include "support/catch.h"

using namespace radar::tools;
using radar::test::Contains;

TEST_CASE("a child hands over bytes, an exception's words, the signal that ended it, or that it took too long") {
  const std::string bytes("a\0b", 3);
  CHECK(inChild([&] { return std::string(bytes); }, {.seconds = 60}).bytes == bytes);
  const ChildOutcome thrown =
      inChild([]() -> std::string { throw std::runtime_error("no such thing"); }, {.seconds = 60});
  CHECK(thrown.failed == "no such thing");
  CHECK(thrown.threw);
  const auto dies = []() -> std::string {
    std::raise(SIGKILL);
    return {};
  };
  const ChildOutcome died = inChild(dies, {.seconds = 60});
  CHECK_THAT(died.failed, Contains("crashes: Killed"));
  CHECK_FALSE(died.threw);
  const auto never = []() -> std::string {
    for (volatile bool on = true; on;) {
    }
    return {};
  };
  CHECK(inChild(never, {.seconds = 1}).failed == "stopped after 1 s of processor time");
}

// Not under AddressSanitizer, which ends a process that asks for too much.
#if !defined(__SANITIZE_ADDRESS__)
TEST_CASE("a child gets no more memory than its limit") {
  const auto taking = [](size_t bytes) { return [bytes] { return std::string(bytes, 'x').substr(bytes - 1); }; };
  const ChildLimits limits{.seconds = 60, .bytes = 64 << 20};
  CHECK(inChild(taking(16 << 20), limits).bytes == "x");
  CHECK(inChild(taking(256 << 20), limits).failed == "std::bad_alloc");
}
#endif
