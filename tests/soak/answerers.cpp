#include "soak/answerers.h"

#include <algorithm>

#include "embed/execute.h"
#include "fuzz/check_answers.h"
#include "fuzz/check_recorded.h"
#include "fuzz/target.h"
#include "support/scene_model.h"

namespace radar::soak {

namespace {

using fuzz::require;

constexpr uint32_t kMostQueries = 64, kMostSampled = 12, kFewQueries = 3;
constexpr uint32_t kMostSearches = 1u << 15, kMostCandidates = 1u << 20;

Capacity anyCapacity(tools::Random& random) {
  return {.queries = random.oneIn(4) ? 1 + random.below(kMostQueries) : kMostQueries,
          .candidates = random.oneIn(4) ? 1 + random.below(2000) : 1u << 15,
          .rounds = random.oneIn(4) ? 2 + 2 * random.below(8) : 32,
          .unresolvedPairs = random.oneIn(4) ? 1 + random.below(200) : 1u << 12,
          .searches = random.oneIn(4) ? random.below(64) : 1u << 11};
}

}  // namespace

Answerers::Answerers(const Device& device, std::span<const Device> pooled, World& world, tools::Random& random,
                     Tally& tally)
    : device_(&device),
      pooled_(pooled),
      world_(&world),
      random_(&random),
      tally_(&tally),
      options_{.select = !random.oneIn(4), .timestamps = random.oneIn(2), .cpuBatch = 0},
      cpu_(world.scene(), 1 + random.below(2)),
      ownRoom_(anyCapacity(random)),
      sharedRoom_(anyCapacity(random)) {
  sweeper_.emplace(device, world.scene(), options_);
  recorder_.emplace(device, world.scene(), ownRoom_);
  share();
  pool_.emplace(pooled, world.scene(), options_);
}

void Answerers::share() {
  sharedRecorder_.reset();
  sharing_.reset();
  copy_.emplace(*device_, world_->scene());
  sharing_.emplace(*copy_, options_);
  sharedRecorder_.emplace(*copy_, sharedRoom_);
}

Batch Answerers::batchOf(std::vector<Query> queries, Mode mode) {
  Batch batch{.queries = std::move(queries), .mode = mode};
  batch.exact = cpu_.run(batch.queries);
  return batch;
}

Batch Answerers::choose() {
  std::vector<Query> queries = world_->queries(kMostQueries);
  if (!random_->oneIn(4) || !device_->supports(Mode::sampled)) return batchOf(std::move(queries));
  std::vector<Query> drawn;
  for (Query query : queries) {
    query.resolution = 8u << random_->below(4);
    query.clearance = 0;
    query.hits = 1;
    query.ignoreLeaving = query.skipOverlapping = query.closest = query.exit = false;
    const bool isValid = validate(query, world_->scene(), Mode::sampled).empty();
    if (isValid && drawn.size() < kMostSampled) drawn.push_back(query);
  }
  return batchOf(std::move(drawn), Mode::sampled);
}

void Answerers::checkExact(const Batch& batch) {
  const auto few = static_cast<ptrdiff_t>(std::min<size_t>(kFewQueries, batch.queries.size()));
  const Batch first = batchOf({batch.queries.begin(), batch.queries.begin() + few});
  measured(Who::bruteForce, *tally_, [&] {
    fuzz::checkAnswers(world_->scene(), first.queries, first.exact);
    tally_->add(Who::bruteForce, first.queries.size());
  });
  if (!random_->oneIn(4)) return;
  measured(Who::cpu, *tally_, [&] {
    const Scene anew = test::SceneModel::of(world_->scene()).build();
    CpuSweeper fresh(anew, 1);
    std::vector<Query> exact, close;
    for (const Query& query : batch.queries) (query.clearance > 0 ? close : exact).push_back(query);
    checkBatch(batchOf(exact), fresh.run(exact), "", Who::cpu, *tally_);
    // Their brackets depend on the trees over meshes, which are fitted to changes, or built anew.
    checkBrackets(batchOf(close), fresh.run(close).results, *tally_);
  });
}

template <class Remake>
void Answerers::askSweeper(Who who, std::optional<Sweeper>& sweeper, const Batch& batch, const Remake& remake) {
  const FaultPlan plan = chooseFault(*random_, true);
  Answers found;
  const test::Attempt outcome = under(plan, *tally_, [&] { found = sweeper->run(batch.queries, batch.mode); });
  if (!outcome.threw) checkBatch(batch, found, outcome.failed ? plan.reason() : "", who, *tally_);
  if (!outcome.failed) return;
  if (*plan.fault == Fault::lost) remake();
  checkBatch(batch, sweeper->run(batch.queries, batch.mode), "", who, *tally_);
}

template <class Make>
void Answerers::askRecorder(Who who, std::optional<Recorder>& recorder, Capacity& capacity, const Batch& all,
                            const Make& make) {
  std::vector<Query> queries = all.queries;
  std::erase_if(queries, [&](const Query& query) { return !test::isRecordable(query, world_->scene()); });
  if (queries.size() > capacity.queries) queries.resize(capacity.queries);
  const Batch batch = batchOf(std::move(queries));
  for (int i = 0; i < 40; ++i) {
    try {
      const Answers found = record(*recorder, *device_, batch.queries, {}, *random_, *tally_);
      fuzz::checkRecorded(batch.queries, found, batch.exact);
      tally_->add(who, batch.queries.size());
      if (!fuzz::isTooSmall(found)) return;
      ++tally_->limited;
      const Capacity needed = recorder->needed();
      // Then only a Sweeper answers it (radar/recorder.h).
      if (needed.candidates <= capacity.candidates && needed.rounds <= capacity.rounds &&
          needed.unresolvedPairs <= capacity.unresolvedPairs) {
        return;
      }
      if (needed.candidates > kMostCandidates) return;
      capacity = fuzz::enoughFor(*recorder);
      capacity.queries = kMostQueries;
    } catch (const Error& error) {
      require(std::string_view(error.what()).find("Capacity::searches") != std::string_view::npos, error.what());
      recorder->reset();
      if (capacity.searches >= kMostSearches) return;
      capacity.searches = std::max(64u, 4 * capacity.searches);
    }
    make();
  }
  require(false, "what needed() gives is not enough");
}

void Answerers::askPool(const Batch& batch) {
  const FaultPlan plan = chooseFault(*random_, true);
  const Device& failing = pooled_[random_->below(static_cast<uint32_t>(pooled_.size()))];
  const HostDevice& device = failing.handles();
  if (random_->oneIn(8)) cancel(batch);
  PoolAnswers answers;
  const auto ask = [&] { answers = pool_->submit(batch.queries, batch.mode).get(); };
  const auto check = [&](const std::string& allowed) { checkBatch(batch, answers, allowed, Who::pool, *tally_); };
  const test::Attempt outcome = under(plan, *tally_, ask, random_->oneIn(2) ? &device : nullptr);
  if (!outcome.threw) check(outcome.failed ? plan.reason() : "");
  if (!outcome.failed) return;
  const std::vector<PoolDevice> devices = pool_->devices();
  const auto isRetired = [](const PoolDevice& one) { return !one.retired.empty(); };
  if (std::ranges::any_of(devices, isRetired)) {
    pool_.reset();
    pool_.emplace(pooled_, world_->scene(), options_);
  }
  ask();
  check("");
}

void Answerers::cancel(const Batch& batch) {
  std::stop_source stop;
  std::future<PoolAnswers> future = pool_->submit(batch.queries, batch.mode, stop.get_token());
  stop.request_stop();
  const PoolAnswers answers = future.get();
  tally_->add(Fault::cancelled);
  checkBatch(batch, answers, "cancelled", Who::pool, *tally_);
}

void Answerers::round() {
  pool_->edit([&] { world_->edit(); });
  const Batch batch = choose();
  checkExact(batch);
  measured(Who::sweeper, *tally_, [&] {
    askSweeper(Who::sweeper, sweeper_, batch, [&] { sweeper_.emplace(*device_, world_->scene(), options_); });
  });
  measured(Who::sharing, *tally_, [&] { askSweeper(Who::sharing, sharing_, batch, [&] { share(); }); });
  measured(Who::pool, *tally_, [&] { askPool(batch); });
  if (batch.mode == Mode::sampled) return;
  measured(Who::recorder, *tally_, [&] {
    askRecorder(Who::recorder, recorder_, ownRoom_, batch,
                [&] { recorder_.emplace(*device_, world_->scene(), ownRoom_); });
  });
  measured(Who::sharedRecorder, *tally_, [&] {
    askRecorder(Who::sharedRecorder, sharedRecorder_, sharedRoom_, batch,
                [&] { sharedRecorder_.emplace(*copy_, sharedRoom_); });
  });
}

}  // namespace radar::soak
