#include "contact/compile_kernels.h"
#include "embed/known_recordings.h"
#include "math/float_environment.h"
#include "sweep/known_answers.h"

namespace radar {

void prepare(const Device& device, Mode mode, const OnProgress& onProgress) {
  const FloatEnvironment floats;
  const Device::Impl& impl = device.impl();
  if (mode == Mode::sampled) impl.requireSampled("prepare()");
  const std::vector<gpu::Program> programs = programsOf(impl, mode);
  const bool proves = impl.host.queue != VK_NULL_HANDLE;
  const auto all = static_cast<uint32_t>(programs.size() + (proves ? 2 : 0));
  uint32_t done = 0;
  const auto step = [&](const std::string& next) {
    if (onProgress) onProgress(done, all, next);
    ++done;
  };
  for (const gpu::Program& program : programs) {
    step(nameOf(program));
    gpu::compile(impl, program);
  }
  if (proves) {
    step("known queries");
    requireProof(impl);
    step("known recordings");
    requireRecorderProof(impl);
  }
  step("");
}

}  // namespace radar
