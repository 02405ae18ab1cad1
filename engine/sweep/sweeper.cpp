// A query travels: begin -> its tier plans it and submits it ... finish -> the tier decodes it.
#include "sweep/sweeper.h"

#include <numeric>

#include "gpu/check.h"
#include "gpu/limit_error.h"
#include "math/float_environment.h"
#include "scene/scene_copy.h"

namespace radar {

Sweeper::Impl::Impl(const Device::Impl& openDevice, const Scene& ownScene, const SweeperOptions& given,
                    std::shared_ptr<GpuScene> sceneCopy, const SearchRoom& room,
                    std::shared_ptr<const ContactKernels> kernels)
    : device(openDevice),
      scene(ownScene),
      options(given),
      copy(std::move(sceneCopy)),
      contactTier(device, scene, given, *copy, std::move(kernels), room, *this) {
  timestamps = given.timestamps;
}

SampledTier& Sweeper::Impl::sampled() {
  if (!sampledTier) {
    // Now, and not in its first submission: others may share the copy.
    copy->needIndices();
    copy->sync(scene.impl());
    sampledTier.emplace(device, scene, options, *copy, *this);
  }
  return *sampledTier;
}

void Sweeper::Impl::runSampled() {
  try {
    sampled();
  } catch (const Error& error) {
    for (size_t query = 0; query < asked.size(); ++query) fail(query, error);
    return;
  }
  sampledTier->run();
}

void Sweeper::Impl::validateAll(std::span<const Query> queries, Mode mode) const {
  for (size_t i = 0; i < queries.size(); ++i) {
    const std::string wrong = validate(queries[i], scene, mode);
    if (!wrong.empty()) throw Error("query " + std::to_string(i) + ": " + wrong);
  }
}

std::optional<Error> Sweeper::Impl::sync() {
  copy->willOverwrite({});
  if (contactTier.isOnCpu() && !copy->hasIndices()) {  // nothing is drawn, nor searched there
    scene.impl().objectTree();
    return {};
  }
  try {
    copy->sync(scene.impl());
  } catch (const gpu::LimitError&) {
    if (copy->hasIndices()) throw;  // mode sampled draws it; mode contact is answered on the CPU
  } catch (const Error& error) {
    if (!gpu::isOutOfMemory(error)) throw;
    return error;
  }
  return {};
}

void Sweeper::Impl::begin(std::span<const Query> queries, Mode mode) {
  copy->willOverwrite({});
  asked = queries;
  answers = unanswered(queries);
  failure.reset();
  contactTier.begin();
  deviceDone = Clock::now();  // in case nothing goes there
  if (queries.empty()) return;
  try {
    if (mode == Mode::sampled) {
      runSampled();
    } else {
      std::vector<size_t> all(queries.size());
      std::iota(all.begin(), all.end(), size_t{0});
      contactTier.run(all);
    }
  } catch (...) {
    finish();  // nothing stays with the device behind an exception
    throw;
  }
}

void Sweeper::Impl::finish() {
  if (sampledTier) sampledTier->collect();
  contactTier.finish();
}

Sweeper::Sweeper(const Device& device, const Scene& scene, const SweeperOptions& options) {
  const FloatEnvironment floats;
  device.impl().requireQueue("a Sweeper");
  impl_ = std::make_unique<Impl>(device.impl(), scene, options, std::make_shared<GpuScene>(device.impl()));
}
Sweeper::Sweeper(SceneCopy& copy, const SweeperOptions& options) {
  const FloatEnvironment floats;
  const SceneCopy::Impl& shared = *copy.impl_;
  shared.device.requireQueue("a Sweeper");
  impl_ = std::make_unique<Impl>(shared.device, shared.scene, options, shared.copy);
}
Sweeper::~Sweeper() = default;
Sweeper::Sweeper(Sweeper&&) noexcept = default;
Sweeper& Sweeper::operator=(Sweeper&&) noexcept = default;

void Sweeper::sync() {
  const FloatEnvironment floats;
  impl_->sync();
}

Answers Sweeper::run(std::span<const Query> queries, Mode mode) {
  const FloatEnvironment floats;
  if (mode == Mode::sampled) impl_->device.requireSampled("run()");
  impl_->validateAll(queries, mode);
  impl_->begin(queries, mode);
  impl_->finish();
  return std::move(impl_->answers);
}

Scopes Sweeper::scopes(const Query& query) {
  const FloatEnvironment floats;
  impl_->device.requireSampled("scopes()");
  impl_->validateAll({&query, 1}, Mode::sampled);
  impl_->copy->willOverwrite({});
  return impl_->sampled().scopes(query);
}

}  // namespace radar
