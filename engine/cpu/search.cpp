#include "cpu/search.h"

#include <algorithm>
#include <chrono>

#include "math/float_environment.h"
#include "query/hits.h"
#include "query/route.h"
#include "radar/cpu_sweeper.h"
#include "scene/parallel.h"

namespace radar::cpu {

namespace {

using Clock = std::chrono::steady_clock;
constexpr size_t kCacheLine = 64;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void prefetch(const Query& query) {
  const char* const bytes = reinterpret_cast<const char*>(&query);
  for (size_t at = 0; at < sizeof(Query); at += kCacheLine) __builtin_prefetch(bytes + at);
}

}  // namespace

void Search::run(std::span<const Query> queries, const Scene::Impl& scene, std::span<Result> results,
                 std::span<Listed> lists, const std::stop_token& stop) {
  const ObjectTree& tree = scene.objectTree();
  const size_t count = queries.size();
  size_t workers = std::clamp<size_t>(count, 1, threadCount(threads_));
  if (searches_.size() < workers) searches_.resize(workers);
  const std::span<const uint32_t> order = order_.of(queries, scene, tree, threads_);
  const auto answer = [&](unsigned worker, size_t first, size_t last) {
    for (size_t at = first; at < last; ++at) {
      throwIfStopped(stop);
      if (!order.empty() && at + 1 < count) prefetch(queries[order[at + 1]]);
      const size_t i = order.empty() ? at : order[at];
      Listed* const listed = hasLists(queries[i]) ? &lists[i] : nullptr;
      results[i] = searches_[worker].answer(queries[i], scene, tree, listed, stop);
      results[i].tier = tier_;
      if (listed == nullptr) continue;
      for (Result& hit : listed->hits) hit.tier = tier_;
      if (listed->closest) listed->closest->at.tier = tier_;
      if (listed->exit) listed->exit->tier = tier_;
    }
  };
  const Clock::time_point start = Clock::now();
  // The caller works alone until starting threads pays off. The time per query of the last run usually decides at once.
  size_t done = 0;
  double each = secondsPerQuery_;
  while (workers > 1 && done < count && each * static_cast<double>(count - done) < 2 * kWorthThread) {
    answer(0, done, done + 1);
    ++done;
    each = secondsSince(start) / static_cast<double>(done);
  }
  if (done < count && workers > 1) {
    const double worth = each * static_cast<double>(count - done) / kWorthThread;
    if (worth < static_cast<double>(workers)) workers = static_cast<size_t>(worth);
  }
  // Small enough for the threads to end at about the same time, large enough that they rarely share a cache line of
  // results.
  const size_t rest = count - done, chunk = std::clamp<size_t>(rest / (16 * workers), 1, 64);
  parallelFor(rest, chunk, static_cast<unsigned>(workers),
              [&](unsigned worker, size_t first, size_t last) { answer(worker, done + first, done + last); });
  const double used = static_cast<double>(rest == 0 ? 1 : workers);
  if (count > 0) secondsPerQuery_ = used * secondsSince(start) / static_cast<double>(count);
}

uint64_t Search::pairs() const {
  uint64_t sum = 0;
  for (const QuerySearch& search : searches_) sum += search.pairs();
  return sum;
}

}  // namespace radar::cpu

namespace radar {

struct CpuSweeper::Impl {
  const Scene& scene;
  cpu::Search search;
};

CpuSweeper::CpuSweeper(const Scene& scene, unsigned threads)
    : impl_(std::make_unique<Impl>(Impl{scene, cpu::Search(Tier::reference, threads)})) {}
CpuSweeper::~CpuSweeper() = default;
CpuSweeper::CpuSweeper(CpuSweeper&&) noexcept = default;
CpuSweeper& CpuSweeper::operator=(CpuSweeper&&) noexcept = default;

void CpuSweeper::sync() {
  const FloatEnvironment floats;
  impl_->scene.impl().objectTree();
}

Answers CpuSweeper::run(std::span<const Query> queries, const std::stop_token& stop) {
  Answers answers;
  run(queries, answers, stop);
  return answers;
}

void CpuSweeper::run(std::span<const Query> queries, Answers& answers, const std::stop_token& stop) {
  const FloatEnvironment floats;
  requireValid(queries, impl_->scene);
  clearFor(queries, impl_->search.threads(), answers);
  const uint64_t before = impl_->search.pairs();
  try {
    impl_->search.run(queries, impl_->scene.impl(), answers.results, answers.lists, stop);
  } catch (const Cancelled&) {
    cancelRest(answers);
  }
  answers.stats.pairs = answers.stats.cpuPairs = impl_->search.pairs() - before;
  answers.stats.cpuQueries = queries.size() - answers.reasons.size();
}

}  // namespace radar
