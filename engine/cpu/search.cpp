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
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

void Search::run(std::span<const Query> queries, const Scene::Impl& scene, std::span<Result> results,
                 std::span<Listed> lists, const std::stop_token& stop) {
  const ObjectTree& tree = scene.objectTree();
  const size_t count = queries.size();
  size_t workers = std::clamp<size_t>(count, 1, threadCount(threads_));
  if (searches_.size() < workers) searches_.resize(workers);
  const std::span<const uint32_t> order = order_.of(queries, scene, tree, threads_);
  const Batch batch{queries, order, results, lists, tier_, scene, tree, stop};
  const Clock::time_point start = Clock::now();
  // The caller works alone until starting threads pays off. The time per query of the last run usually decides at once.
  size_t done = 0;
  double each = secondsPerQuery_;
  while (workers > 1 && done < count && each * static_cast<double>(count - done) < 2 * kWorthThread) {
    searches_.front().answer(batch, done, done + 1);
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
  parallelFor(rest, chunk, static_cast<unsigned>(workers), [&](unsigned worker, size_t first, size_t last) {
    searches_[worker].answer(batch, done + first, done + last);
  });
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
