// Buffers of a host on the device, and searches recorded over them.
#pragma once

#include <cstring>
#include <initializer_list>
#include <span>
#include <vector>

#include "embed/execute.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "radar/recorder.h"
#include "support/same_bits.h"
#include "support/test_device.h"

namespace radar::test {

/// A buffer on the device with the given bytes.
class OnDevice {
 public:
  explicit OnDevice(const std::vector<std::byte>& bytes, const Device& on = test::device())
      : buffer_(on.impl(), "host's", gpu::BufferDomain::device,
                VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT) {
    const Device::Impl& device = on.impl();
    gpu::Upload upload(device);
    buffer_.reserve(bytes.size());
    upload.begin();
    upload.add(bytes.data(), bytes.size(), buffer_);
    gpu::Submission submission(device, false);
    upload.record(submission.begin());
    submission.submitAndWait();
  }
  VkBuffer get() const { return buffer_.get(); }

 private:
  gpu::Buffer buffer_;
};

template <class T>
void append(std::vector<std::byte>& bytes, std::initializer_list<T> values) {
  for (const T value : values) {
    bytes.resize(bytes.size() + sizeof(T));
    std::memcpy(&bytes[bytes.size() - sizeof(T)], &value, sizeof(T));
  }
}

/// A buffer of vertex positions.
inline OnDevice bufferOf(std::span<const float> positions, const Device& on = test::device()) {
  std::vector<std::byte> bytes(positions.size_bytes());
  std::memcpy(bytes.data(), positions.data(), bytes.size());
  return OnDevice(bytes, on);
}

/// The capacity of most recordings in the tests.
inline constexpr Capacity kRoom{.queries = 48, .candidates = 1u << 17, .rounds = 64, .unresolvedPairs = 1u << 17};

inline std::vector<Result> execute(Recorder& recorder, std::span<const Query> queries,
                                   const HostGeometry& geometry = {}) {
  return execute(test::device(), recorder, queries, geometry).results;
}
inline std::vector<Result> execute(Recorder& recorder, const HostQueries& queries, const HostGeometry& geometry = {}) {
  return execute(test::device(), recorder, queries, geometry).results;
}

}  // namespace radar::test
