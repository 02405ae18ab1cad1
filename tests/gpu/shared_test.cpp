// What is shared per device: one of a type, made once, whoever asks.
#include <catch2/catch.hpp>

#include <array>
#include <atomic>
#include <stdexcept>
#include <thread>

#include "gpu/kernel_fixture.h"

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

TEST_CASE("a device gives everybody the same kernels") {
  CHECK(&test::kernels() == &test::kernels());
  CHECK(&test::kernels() == &test::impl().shared<test::Kernels>());
}

TEST_CASE("what is shared is made once, for each device, and destroyed with it") {
  {
    const Device own = Device::open({.onValidation = test::onValidation});
    std::array<const Counted*, 8> found{};
    std::vector<std::thread> threads;
    for (const Counted*& one : found) threads.emplace_back([&] { one = &own.impl().shared<Counted>(); });
    for (std::thread& thread : threads) thread.join();
    CHECK(Counted::made == 1);
    for (const Counted* one : found) CHECK(one == found[0]);
    CHECK(own.impl().shared<AsksForAnother>().other == found[0]);
    own.impl().shared<test::Kernels>();  // which the layers miss if they outlive the device
    CHECK(&test::impl().shared<Counted>() != found[0]);
    CHECK(Counted::made == 2);
    CHECK(Counted::destroyed == 0);
  }
  CHECK(Counted::destroyed == 1);
}

TEST_CASE("what could not be made is made when it is asked for again") {
  CHECK_THROWS_WITH(test::impl().shared<FailsAtFirst>(), "the first attempt");
  CHECK(&test::impl().shared<FailsAtFirst>() == &test::impl().shared<FailsAtFirst>());
  CHECK(FailsAtFirst::attempts == 2);
}
