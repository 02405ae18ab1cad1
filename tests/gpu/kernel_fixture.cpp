#include "gpu/kernel_fixture.h"

#include <numeric>

namespace radar::test {

void run(const std::function<void(const gpu::Commands&)>& record) {
  gpu::Submission submission(impl(), false);
  const gpu::Commands commands = submission.begin();
  record(commands);
  gpu::writtenToHost(commands);
  submission.submitAndWait();
}

gpu::Array<uint32_t> numbers(const char* name, uint32_t count) {
  gpu::Array<uint32_t> array(impl(), name, gpu::BufferDomain::upload);
  array.reserve(count);
  std::iota(array.mapped(), array.mapped() + count, 0u);
  return array;
}

}  // namespace radar::test
