#include "radar/cpu_sweeper.h"

#include "cpu/search.h"
#include "math/float_environment.h"
#include "query/hits.h"

namespace radar {

struct CpuSweeper::Impl {
  const Scene& scene;
  unsigned threads;
  cpu::Search search;
};

CpuSweeper::CpuSweeper(const Scene& scene, unsigned threads)
    : impl_(std::make_unique<Impl>(Impl{scene, threads, {}})) {}
CpuSweeper::~CpuSweeper() = default;
CpuSweeper::CpuSweeper(CpuSweeper&&) noexcept = default;
CpuSweeper& CpuSweeper::operator=(CpuSweeper&&) noexcept = default;

void CpuSweeper::sync() {
  const FloatEnvironment floats;
  impl_->scene.impl().objectTree();
}

Answers CpuSweeper::run(std::span<const Query> queries) {
  const FloatEnvironment floats;
  for (size_t i = 0; i < queries.size(); ++i) {
    if (const std::string wrong = validate(queries[i], impl_->scene); !wrong.empty()) {
      throw Error("run: query " + std::to_string(i) + ": " + wrong);
    }
  }
  Answers answers = unanswered(queries);
  const uint64_t before = impl_->search.pairs();
  impl_->search.run(queries, impl_->scene.impl(), Tier::reference, impl_->threads, answers.results, answers.lists);
  answers.stats.pairs = answers.stats.cpuPairs = impl_->search.pairs() - before;
  answers.stats.cpuQueries = queries.size();
  return answers;
}

}  // namespace radar
