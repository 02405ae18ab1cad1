#include "gpu/doubles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "gpu/barrier.h"
#include "gpu/kernel.h"
#include "gpu/submission.h"
#include "shaders/interop.h"
#include "spirv/doubles_comp.h"

namespace radar::gpu {

namespace {

// Of all signs and of magnitudes 2^-60 to 2^60, with every bit of the significand in use.
std::vector<Sum> sumsToTry() {
  std::mt19937_64 random(1);
  const auto number = [&] {
    const double significand = 1 + std::ldexp(static_cast<double>(random() >> 12), -52);
    return std::ldexp(random() % 2 == 0 ? significand : -significand, static_cast<int>(random() % 121) - 60);
  };
  std::vector<Sum> sums(kSums);
  for (size_t i = 0; i < sums.size(); ++i) {
    Sum& s = sums[i];
    s.x = number();
    // Where a sum cancels, what was rounded before shows, and what a fused multiply-add did not round.
    s.y = i % 2 == 0 ? number() : -s.x * 1.0000001;
    for (double& factor : s.row) factor = number();
    for (float& coordinate : s.p) coordinate = static_cast<float>(number());
    if (i % 2 == 1) s.row[3] = -(s.row[0] * s.p[0]);
    if (i % 4 == 1) s.row[1] = s.row[2] = 0;
  }
  return sums;
}

SumResult expected(const Sum& s) {
  Pose pose;
  std::copy(std::begin(s.row), std::end(s.row), pose.m.begin());
  return {s.x + s.y, s.x * s.y, s.x / s.y, place(pose, s.p)[0], static_cast<float>(s.x)};
}

using Bits = std::array<uint64_t, sizeof(SumResult) / sizeof(uint64_t)>;

}  // namespace

bool doublesAreRight(const Device::Impl& device) {
  const std::vector<Sum> sums = sumsToTry();
  const Kernel kernel(device, k_doubles_comp, "doubles");
  Upload upload(device);
  Array<Sum> given(device, "sums", Residence::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  Array<SumResult> computed(device, "sum results", Residence::device, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  Buffer readback(device, "sum readback", Residence::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  const VkBufferCopy copy{0, 0, kSums * sizeof(SumResult)};
  given.reserve(kSums);
  computed.reserve(kSums);
  readback.reserve(copy.size);
  KernelArguments arguments(kernel);
  arguments.set({{kSlotSums, given}, {kSlotSumResults, computed}});
  upload.begin(Upload::aligned(bytesOf(sums)));
  upload.add(sums.data(), bytesOf(sums), given);

  Submission submission(device, false);
  const Commands commands = submission.begin();
  submission.stage("doubles");
  upload.record(commands);
  uploadToRead(commands);
  arguments.dispatch(commands, 1);
  computeWriteToCopy(commands);
  commands->CmdCopyBuffer(commands, computed.get(), readback.get(), 1, &copy);
  copyToHost(commands);
  submission.submitAndWait();
  for (size_t i = 0; i < sums.size(); ++i) {
    Bits bits;
    std::memcpy(bits.data(), readback.mapped() + i * sizeof(SumResult), sizeof(bits));
    if (bits != std::bit_cast<Bits>(expected(sums[i]))) return false;
  }
  return true;
}

}  // namespace radar::gpu
