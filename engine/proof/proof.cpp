// When a device proves itself, and what comes of it.
#include "sweep/proof.h"

#include "contact/compile_kernels.h"
#include "math/float_environment.h"
#include "proof/checks.h"

namespace radar {

namespace {

// A device's answers to scenes of a few seeds, for which it is asked once.
template <auto kCheck>
struct Proof {
  explicit Proof(const Device::Impl& device) {
    for (uint64_t seed = 0; seed < 2; ++seed) {
      for (AnswerCheck& check : kCheck(device, seed)) checks.push_back(std::move(check));
    }
  }
  std::vector<AnswerCheck> checks;
};

}  // namespace

void requirePassed(const Device::Impl& device, std::span<const AnswerCheck> checks) {
  std::vector<std::string> reasons;
  for (const AnswerCheck& check : checks) {
    if (check.passed()) continue;
    reasons.push_back(check.kind + ": " + std::to_string(check.wrong) + " of " + std::to_string(check.asked) +
                      " answers differ from the CPU's, in " + check.stage + "; " + check.firstWrong);
  }
  if (!reasons.empty()) {
    throw Error(
        device.name + " (" + device.driver + ") cannot be used: its answers to known queries differ from the CPU's",
        VK_SUCCESS, reasons);
  }
}

void requireProof(const Device::Impl& device) {
  requirePassed(device, device.shared<Proof<checkSweeper>>().checks);
}

void requireRecorderProof(const Device::Impl& device) {
  if (device.host.queue == VK_NULL_HANDLE) return;
  requireProof(device);
  requirePassed(device, device.shared<Proof<checkRecorder>>().checks);
}

std::vector<AnswerCheck> checkAnswers(const Device& device, uint64_t seed) {
  const FloatEnvironment floats;
  const Device::Impl& impl = device.impl();
  impl.requireQueue("checkAnswers()");
  std::vector<AnswerCheck> checks = checkSweeper(impl, seed);
  checks.push_back(checkClearances(impl, seed));
  if (device.supports(Mode::sampled)) checks.push_back(checkSampled(impl, seed));
  for (AnswerCheck& check : checkRecorder(impl, seed)) checks.push_back(std::move(check));
  return checks;
}

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
