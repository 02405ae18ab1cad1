// Objects shared per device: one of each type, created once for all callers.
#include <array>
#include <atomic>
#include <stdexcept>
#include <thread>

#include "gpu/kernel_fixture.h"
#include "support/catch.h"

namespace {

using namespace radar;

struct Counted {
  explicit Counted(const Device::Impl&) { ++made; }
  ~Counted() { ++destroyed; }
  static inline std::atomic<int> made = 0, destroyed = 0;
};

struct AsksForAnother {
  explicit AsksForAnother(const Device::Impl& device) : other(&device.shared<Counted>()) {}
  const Counted* other;
};

struct FailsAtFirst {
  explicit FailsAtFirst(const Device::Impl&) {
    if (attempts++ == 0) throw std::runtime_error("the first attempt");
  }
  static inline int attempts = 0;
};

}  // namespace

TEST_CASE("a shared object is created once per device, for all callers and threads, and destroyed with the device") {
  {
    const Device own = Device::open(test::deviceOptions());
    std::array<const Counted*, 8> found{};
    std::vector<std::thread> threads;
    threads.reserve(found.size());
    for (const Counted*& one : found) threads.emplace_back([&] { one = &own.impl().shared<Counted>(); });
    for (std::thread& thread : threads) thread.join();
    CHECK(Counted::made == 1);
    for (const Counted* one : found) CHECK(one == found[0]);
    CHECK(own.impl().shared<AsksForAnother>().other == found[0]);
    const gpu::Passes passes(own.impl(), {test::kScaleOf64});  // the layers report a pipeline that outlives the device
    CHECK(&test::impl().shared<Counted>() != found[0]);
    CHECK(Counted::made == 2);
    CHECK(Counted::destroyed == 0);
  }
  CHECK(Counted::destroyed == 1);
}

TEST_CASE("a shared object whose constructor threw is created on the next request") {
  CHECK_THROWS_WITH(test::impl().shared<FailsAtFirst>(), "the first attempt");
  CHECK(&test::impl().shared<FailsAtFirst>() == &test::impl().shared<FailsAtFirst>());
  CHECK(FailsAtFirst::attempts == 2);
}
