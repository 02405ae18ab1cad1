// A batch travels: begin() -> its mode's runner plans and submits it ... finish() -> the runner decodes it.
#include "sweep/sweeper.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "gpu/api.h"
#include "math/float_environment.h"
#include "query/cancelled.h"
#include "query/route.h"
#include "scene/parallel.h"
#include "scene/scene_copy.h"

namespace radar {

namespace {

// What the last Sweeper of a device has learnt of it.
class KnownTimes {
 public:
  explicit KnownTimes(const Device::Impl&) {}
  BatchTimes get(unsigned threads) const {
    const std::scoped_lock lock(mutex_);
    return times_.with(threads);
  }
  void keep(const BatchTimes& times) const {
    const std::scoped_lock lock(mutex_);
    times_ = times;
  }

 private:
  mutable std::mutex mutex_;
  mutable BatchTimes times_{1};
};

// That of most queries, by a few of them; none if the device answers none of these.
std::optional<BatchKind> kindOf(std::span<const Query> queries, const Scene::Impl& scene) {
  constexpr size_t kLookedAt = 32;
  std::array<size_t, 3> counts{};
  const size_t step = (queries.size() + kLookedAt - 1) / kLookedAt;
  for (size_t i = 0; i < queries.size(); i += step) {
    const Route route = routeOf(queries[i], scene, true);
    if (route == Route::cpu) continue;
    const BatchKind kind = route == Route::searchEach ? BatchKind::each
                           : queries[i].clearance > 0 ? BatchKind::clearance
                                                      : BatchKind::plain;
    ++counts[static_cast<size_t>(kind)];
  }
  const auto most = std::ranges::max_element(counts);
  if (*most == 0) return {};
  return static_cast<BatchKind>(most - counts.begin());
}

}  // namespace

Sweeper::Impl::Impl(const Device::Impl& openDevice, const Scene& ownScene, const SweeperOptions& given,
                    std::shared_ptr<GpuScene> sceneCopy, const SearchTuning& tuning, bool needsProof)
    : owner(gpu::Owner::counted(openDevice)),
      device(openDevice),
      scene(ownScene),
      options(given),
      copy(std::move(sceneCopy)),
      contactRunner(owner, scene, given, *copy, tuning, needsProof) {
  if (given.cpuBatch != kNone || device.runsOnCpu()) return;
  router = std::make_shared<BatchRouter>(device.shared<KnownTimes>().get(threadCount(given.cpuThreads)));
}

Sweeper::Impl::~Impl() {
  if (router && router->hasLearnt()) device.shared<KnownTimes>().keep(router->times());
}

SampledRunner& Sweeper::Impl::sampled() {
  if (!sampledRunner) {
    // Now, and not in its first submission: others may share the copy.
    copy->needIndices();
    copy->sync(scene.impl());
    sampledRunner.emplace(owner, scene, options, *copy);
  }
  return *sampledRunner;
}

std::optional<Error> Sweeper::Impl::sync() {
  if (contactRunner.isOnCpu() && !copy->hasIndices()) {  // nothing is drawn, nor searched there
    scene.impl().objectTree();
    return {};
  }
  try {
    copy->sync(scene.impl());
  } catch (const gpu::LimitError&) {
    if (copy->hasIndices()) throw;  // mode sampled draws it; mode contact is answered on the CPU
  } catch (const Error& error) {
    if (!gpu::isOutOfMemory(error) && !gpu::isLost(error)) throw;
    return error;
  }
  return {};
}

template <class Step>
void Sweeper::Impl::attempt(Flight& flight, const Step& step) {
  try {
    step();
  } catch (const Cancelled&) {
    abandon(flight);
    cancelRest(flight.answers);
  } catch (...) {
    abandon(flight);
    throw;
  }
}

void Sweeper::Impl::begin(Flight& flight, Mode mode) {
  if (flight.queries.empty()) return;
  attempt(flight, [&] {
    if (mode == Mode::contact) {
      route(flight);
      return contactRunner.begin(flight);
    }
    try {
      sampled();
    } catch (const Error& error) {
      for (size_t query = 0; query < flight.queries.size(); ++query) flight.fail(query, error);
      return;
    }
    sampledRunner->begin(flight);
  });
}

void Sweeper::Impl::finish(Flight& flight) {
  attempt(flight, [&] {
    if (sampledRunner) sampledRunner->finish(flight);
    contactRunner.finish(flight);
    learn(flight);
  });
}

void Sweeper::Impl::route(Flight& flight) {
  flight.cpuBatch = options.cpuBatch;
  if (!router) return;
  flight.cpuBatch = 0;
  const std::optional<BatchKind> kind = kindOf(flight.queries, scene.impl());
  if (!kind) return;
  flight.choice = router->choose(*kind, flight.queries.size());
  if (flight.choice->side == Side::cpu) flight.cpuBatch = kNone;
  flight.begun = Clock::now();
}

void Sweeper::Impl::learn(const Flight& flight) {
  const SweepStats& stats = flight.answers.stats;
  if (!flight.choice || !flight.isAlone || flight.stop.stop_requested() || !stats.lost.empty()) return;
  // Of a batch that had nothing to search, the device took no time.
  if (flight.choice->side == Side::device && stats.submissions == 0 && !flight.failure) return;
  router->took(*flight.choice, msSince(flight.begun) / 1e3);
}

void Sweeper::Impl::abandon(Flight& flight) noexcept {
  if (sampledRunner) sampledRunner->abandon(flight);
  contactRunner.abandon(flight);
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

uint64_t Sweeper::memoryUse() const {
  return impl_->owner.bytes() + memoryAlone(impl_->copy);
}

void Sweeper::sync() {
  const FloatEnvironment floats;
  impl_->sync();
}

Answers Sweeper::run(std::span<const Query> queries, Mode mode, const std::stop_token& stop) {
  Answers answers;
  run(queries, answers, mode, stop);
  return answers;
}

void Sweeper::run(std::span<const Query> queries, Answers& answers, Mode mode, const std::stop_token& stop) {
  const FloatEnvironment floats;
  const Clock::time_point begun = Clock::now();
  if (mode == Mode::sampled) impl_->device.requireSampled("run()");
  const SweeperOptions& options = impl_->options;
  const bool isContact = mode == Mode::contact;
  const std::span<SearchNeeds> needs =
      isContact ? impl_->contactRunner.needsOf(queries.size()) : std::span<SearchNeeds>();
  requireValid(queries, impl_->scene, mode, false, options.cpuThreads, needs);
  Flight flight = isContact ? Flight(queries, needs, options.timestamps, stop, std::move(answers))
                            : Flight(queries, options.timestamps, stop, std::move(answers));
  flight.addCpuTime("check", msSince(begun));
  impl_->begin(flight, mode);
  impl_->finish(flight);
  answers = std::move(flight.answers);
}

Scopes Sweeper::scopes(const Query& query) {
  const FloatEnvironment floats;
  impl_->device.requireSampled("scopes()");
  requireValid({&query, 1}, impl_->scene, Mode::sampled);
  return impl_->sampled().scopes(query);
}

}  // namespace radar
