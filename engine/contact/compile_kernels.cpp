#include "contact/compile_kernels.h"

#include <algorithm>

#include "contact/pass.h"
#include "math/float_environment.h"
#include "spirv/radar_shaders.h"

namespace radar {

namespace {

bool runsOn(const Device::Impl& device, const gpu::Shader& shader) {
  return device.doubles || !shader.spirvWithoutDoubles.empty() || !gpu::hasDoubles(shader.spirv);
}

}  // namespace

std::string nameOf(const gpu::Program& program) {
  std::string name = program.shader->name;
  const auto& values = program.constants;
  const auto end = std::find_if(values.rbegin(), values.rend(), [](uint32_t value) { return value != 0; }).base();
  for (auto value = values.begin(); value != end; ++value) name += " " + std::to_string(*value);
  return name;
}

std::vector<gpu::Program> programsOf(const Device::Impl& device, Mode mode) {
  std::vector<gpu::Program> programs = ContactPass::programs(device);
  // The others are never specialized.
  for (const gpu::Shader* shader : shaders::kAll) {
    const bool isListed = std::ranges::any_of(programs, [&](const gpu::Program& own) { return own.shader == shader; });
    const bool isOfMode =
        shader->use == gpu::Use::contact || (shader->use == gpu::Use::sampled && mode == Mode::sampled);
    const bool isUsed =
        isOfMode && (shader->stage == VK_SHADER_STAGE_COMPUTE_BIT || shader == &gpu::depthShader(device));
    if (!isListed && isUsed && runsOn(device, *shader)) programs.push_back(*shader);
  }
  return programs;
}

std::vector<KernelReport> compileKernels(uint32_t index) {
  const FloatEnvironment floats;
  const std::unique_ptr<Device::Impl> device = gpu::openForStatistics(index);
  const bool isSampled = device->reasonsAgainstSampled.empty();
  std::vector<gpu::Program> programs = programsOf(*device, isSampled ? Mode::sampled : Mode::contact);
  for (const gpu::Shader* shader : shaders::kAll) {
    if (shader->use == gpu::Use::arithmetic && runsOn(*device, *shader)) programs.push_back(*shader);
  }
  std::vector<KernelReport> reports;
  for (const gpu::Program& program : programs) {
    reports.push_back(gpu::reportOf(*device, program));
    reports.back().name = nameOf(program);
  }
  return reports;
}

}  // namespace radar
