// A query travels: begin -> its tier plans it and submits it ... finish -> the tier decodes it.
#include "sweep/sweeper.h"

#include <cassert>

#include "gpu/check.h"
#include "math/float_environment.h"
#include "scene/scene_copy.h"

namespace radar {

Sweeper::Impl::Impl(const Device::Impl& openDevice, const Scene& ownScene, const SweeperOptions& given,
                    std::shared_ptr<GpuScene> sceneCopy, const SearchRoom& room, bool needsProof)
    : device(openDevice),
      scene(ownScene),
      options(given),
      copy(std::move(sceneCopy)),
      contactTier(device, scene, given, *copy, room, needsProof, *this) {
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

void Sweeper::Impl::runSampled(std::span<const size_t> which) {
  if (which.empty()) return;
  try {
    sampled();
  } catch (const Error& error) {
    for (const size_t query : which) fail(query, error);
    return;
  }
  sampledTier->run(which);
}

void Sweeper::Impl::validateAll(std::span<const Query> queries) const {
  for (size_t i = 0; i < queries.size(); ++i) {
    const std::string wrong = validate(queries[i], scene);
    if (!wrong.empty()) throw Error("query " + std::to_string(i) + ": " + wrong);
    if (queries[i].mode == Mode::sampled) device.requireSampled("query " + std::to_string(i));
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

void Sweeper::Impl::begin(std::span<const Query> queries, std::span<Result> results) {
  assert(queries.size() == results.size());
  copy->willOverwrite({});
  asked = queries;
  answers = results;
  lists = listsFor(queries);
  stats = {};
  reasons.clear();
  failure.reset();
  contactTier.begin();
  std::vector<size_t> ofSampled, ofContact;
  for (size_t i = 0; i < queries.size(); ++i) {
    answers[i] = Result();
    (queries[i].mode == Mode::sampled ? ofSampled : ofContact).push_back(i);
  }
  deviceDone = Clock::now();  // in case nothing goes there
  try {
    runSampled(ofSampled);
    if (sampledTier && !ofContact.empty()) sampledTier->collect();
    contactTier.run(ofContact);
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

std::vector<Result> Sweeper::run(std::span<const Query> queries) {
  const FloatEnvironment floats;
  impl_->validateAll(queries);
  std::vector<Result> results(queries.size());
  impl_->begin(queries, results);
  impl_->finish();
  impl_->joinedLists = joined(impl_->lists);
  return results;
}

Scopes Sweeper::scopes(const Query& query) {
  const FloatEnvironment floats;
  impl_->validateAll({&query, 1});
  impl_->device.requireSampled("scopes()");
  impl_->stats = {};
  impl_->copy->willOverwrite({});
  return impl_->sampled().scopes(query);
}

const Lists& Sweeper::lists() const {
  return impl_->joinedLists;
}

const SweepStats& Sweeper::stats() const {
  return impl_->stats;
}

const std::string& Sweeper::reason(size_t i) const {
  static const std::string kNothing;
  const auto found = impl_->reasons.find(i);
  return found == impl_->reasons.end() ? kNothing : found->second;
}

}  // namespace radar
