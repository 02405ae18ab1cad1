#include <algorithm>

#include "cpu/chain_search.h"
#include "math/float_environment.h"
#include "scene/parallel.h"

namespace radar {

struct ChainSweeper::Impl {
  const Scene& scene;
  Chain chain;
  unsigned threads;
  std::vector<cpu::ChainSearch> searches;  // one per thread
};

ChainSweeper::ChainSweeper(const Scene& scene, Chain chain, unsigned threads)
    : impl_(std::make_unique<Impl>(Impl{scene, std::move(chain), threads, {}})) {
  if (const std::string wrong = validate(impl_->chain, scene); !wrong.empty()) throw Error("chain: " + wrong);
}
ChainSweeper::~ChainSweeper() = default;
ChainSweeper::ChainSweeper(ChainSweeper&&) noexcept = default;
ChainSweeper& ChainSweeper::operator=(ChainSweeper&&) noexcept = default;

const Chain& ChainSweeper::chain() const {
  return impl_->chain;
}

std::vector<ChainResult> ChainSweeper::run(std::span<const ChainQuery> queries, const std::stop_token& stop) {
  const FloatEnvironment floats;
  const Chain& chain = impl_->chain;
  if (const std::string wrong = validate(chain, impl_->scene); !wrong.empty()) throw Error("chain: " + wrong);
  for (size_t i = 0; i < queries.size(); ++i) {
    const std::string wrong = validate(queries[i], chain, impl_->scene);
    if (!wrong.empty()) throw Error("query " + std::to_string(i) + ": " + wrong);
  }
  const Scene::Impl& scene = impl_->scene.impl();
  scene.objectTree();
  const cpu::ChainPlan plan(chain, scene);
  std::vector<ChainResult> results(queries.size());
  const unsigned threads = threadCount(impl_->threads);
  impl_->searches.resize(std::max<size_t>(impl_->searches.size(), threads));
  try {
    parallelFor(queries.size(), 1, threads, [&](unsigned worker, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        throwIfStopped(stop);
        results[i] = impl_->searches[worker].answer(queries[i], chain, plan, scene, stop);
      }
    });
  } catch (const Cancelled&) {
  }
  return results;
}

}  // namespace radar
