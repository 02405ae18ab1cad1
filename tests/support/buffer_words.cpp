#include "support/buffer_words.h"

#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "gpu/submission.h"
#include "spirv/copy_words_comp.h"
#include "support/bindings.h"
#include "support/test_device.h"

namespace radar::test {

std::vector<uint32_t> wordsOf(VkBuffer buffer, size_t count) {
  if (count == 0) return {};
  const Device::Impl& device = test::device().impl();
  Bindings bindings(device, 2, 4);
  const gpu::Pipeline pipeline = gpu::computePipeline(device, bindings.layout(), k_copy_words_comp, "copy words");
  gpu::Buffer out(device, "words", gpu::BufferDomain::readback, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  out.reserve(4 * count);
  bindings.setBuffer(0, buffer);
  bindings.setBuffer(1, out.get());
  gpu::Submission submission(device, false);
  const gpu::Commands commands = submission.begin();
  bindings.bind(commands);
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdDispatch(commands, static_cast<uint32_t>((count + 63) / 64), 1, 1);
  gpu::writtenToHost(commands);
  submission.submitAndWait();
  std::vector<uint32_t> words(count);
  std::memcpy(words.data(), out.mapped(), 4 * count);
  return words;
}

}  // namespace radar::test
