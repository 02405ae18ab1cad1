#include <algorithm>

#include "contact/pass.h"
#include "math/float_environment.h"
#include "spirv/radar_shaders.h"

namespace radar {

namespace {

// "contact/search 32 256 40 1".
std::string nameOf(const gpu::Program& program) {
  std::string name = program.shader->name;
  const auto& values = program.constants;
  const auto end = std::find_if(values.rbegin(), values.rend(), [](uint32_t value) { return value != 0; }).base();
  for (auto value = values.begin(); value != end; ++value) name += " " + std::to_string(*value);
  return name;
}

}  // namespace

std::vector<KernelReport> compileKernels(uint32_t index) {
  const FloatEnvironment floats;
  const std::unique_ptr<Device::Impl> device = gpu::openForStatistics(index);
  std::vector<gpu::Program> programs = ContactPass::programs(*device);
  // The others are never specialized.
  for (const gpu::Shader* shader : shaders::kAll) {
    const bool isListed = std::ranges::any_of(programs, [&](const gpu::Program& own) { return own.shader == shader; });
    const bool runs = device->doubles || !shader->spirvWithoutDoubles.empty() || !gpu::hasDoubles(shader->spirv);
    const bool isUsed = shader->stage == VK_SHADER_STAGE_COMPUTE_BIT ||
                        (device->reasonsAgainstSampled.empty() && shader == &gpu::depthShader(*device));
    if (!isListed && runs && isUsed) programs.push_back(*shader);
  }
  std::vector<KernelReport> reports;
  for (const gpu::Program& program : programs) {
    reports.push_back(gpu::reportOf(*device, program));
    reports.back().name = nameOf(program);
  }
  return reports;
}

}  // namespace radar
