#include "faults/host_memory.h"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr int64_t kNever = std::numeric_limits<int64_t>::max();
std::atomic<int64_t> requested{0}, failing{kNever}, liveBlocks{0};
std::atomic<bool> allLater{false};
using radar::test::countsRequests;

bool fails() {
  if (!countsRequests) return false;
  const int64_t number = requested++;
  return number == failing || (allLater && number > failing);
}

// Stands before each block: whether it counted.
struct alignas(std::max_align_t) Header {
  bool counted;
};

void* allocate(std::size_t bytes) {
  if (fails()) return nullptr;
  auto* header = static_cast<Header*>(std::malloc(sizeof(Header) + bytes));
  if (header == nullptr) return nullptr;
  header->counted = countsRequests;
  liveBlocks += countsRequests ? 1 : 0;
  return header + 1;
}

void release(void* block) noexcept {
  if (block == nullptr) return;
  Header* header = static_cast<Header*>(block) - 1;
  liveBlocks -= header->counted ? 1 : 0;
  std::free(header);
}

struct Start {
  void* (*function)(void*);
  void* argument;
  bool counts;
};

void* begin(void* given) {
  const Start start = *static_cast<Start*>(given);
  std::free(given);
  countsRequests = start.counts;
  return start.function(start.argument);
}

}  // namespace

void* operator new(std::size_t bytes) {
  void* block = allocate(bytes);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
void* operator new[](std::size_t bytes) {
  return operator new(bytes);
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes);
}
void operator delete(void* block) noexcept {
  release(block);
}
void operator delete[](void* block) noexcept {
  release(block);
}
void operator delete(void* block, std::size_t) noexcept {
  release(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  release(block);
}

// Stands before the C library's.
extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread,
                                                                     const pthread_attr_t* attributes,
                                                                     void* (*function)(void*),
                                                                     void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto kCreate = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (fails()) return EAGAIN;
  auto* start = static_cast<Start*>(std::malloc(sizeof(Start)));
  *start = {function, argument, countsRequests};
  const int error = kCreate(thread, attributes, begin, start);
  if (error != 0) std::free(start);
  return error;
}

namespace radar::test {

void host_memory::failAt(int64_t n, bool andAllLater) {
  failing = kNever;
  allLater = andAllLater;
  requested = 0;
  failing = n < 0 ? kNever : n;
}

int64_t host_memory::requests() {
  return requested;
}

int64_t host_memory::live() {
  return liveBlocks;
}

}  // namespace radar::test
