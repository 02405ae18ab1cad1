#include "sampled/batch.h"

#include <algorithm>
#include <bit>
#include <tuple>

namespace radar {

namespace {

// Maximum number of layers per render pass.
constexpr uint32_t kMaxPassLayers = 64;

uint32_t layersPerPass(std::span<const ViewPlan* const> plans, uint32_t passTriangles) {
  uint64_t triangles = 0;
  for (const ViewPlan* plan : plans) triangles += plan->triangles;
  const uint64_t fit =
      std::clamp<uint64_t>(passTriangles * plans.size() / std::max<uint64_t>(triangles, 1), 1, kMaxPassLayers);
  return std::bit_floor(static_cast<uint32_t>(std::min<uint64_t>(fit, plans.size())));
}

// A mesh to draw in one pass.
struct Pending {
  const Placed* placed;
  std::span<const Run> runs;
  uint32_t view, layer;
  bool identified;  // whether its triangles are
  uint32_t draw = 0;
};

// An order that makes equal draws adjacent: those of the same mesh and first run.
bool drawnBefore(const Pending* a, const Pending* b) {
  const auto key = [](const Pending& p) { return std::tuple(p.placed->draw.mesh, p.runs[0].first, p.runs[0].count); };
  return key(*a) < key(*b);
}

void addItems(SampledBatch& batch, const Pending& pending) {
  for (const Run& run : pending.runs) {
    const uint32_t end = run.first + run.count;
    for (uint32_t first = run.first; first < end; first += gpu::kItemTriangles) {
      batch.items.push_back({pending.draw, first, std::min(first + gpu::kItemTriangles, end)});
    }
  }
}

// Appends the draws of one pass, and their items in the order of `pending`. Draws of the same single run become one
// instanced call.
DepthPass addPass(SampledBatch& batch, std::vector<Pending>& pending, DepthPass pass) {
  pass.firstCall = static_cast<uint32_t>(batch.calls.size());
  std::vector<Pending*> order;
  for (Pending& p : pending) {
    if (!p.runs.empty()) order.push_back(&p);
  }
  std::stable_sort(order.begin(), order.end(), drawnBefore);
  const Pending* last = nullptr;
  for (Pending* p : order) {
    p->draw = static_cast<uint32_t>(batch.draws.size());
    const bool alike = last != nullptr && last->runs.size() == 1 && p->runs.size() == 1 && !drawnBefore(last, p);
    if (alike) {
      ++batch.calls.back().count;
    } else {
      for (const Run& run : p->runs) batch.calls.push_back({p->placed->draw.mesh, run, p->draw, 1});
    }
    batch.draws.push_back(p->placed->draw);
    batch.draws.back().view = p->view;
    batch.draws.back().layer = p->layer;
    last = p;
  }
  for (const Pending& p : pending) {
    if (p.identified) addItems(batch, p);
  }
  pass.calls = static_cast<uint32_t>(batch.calls.size()) - pass.firstCall;
  pending.clear();
  return pass;
}

// Packs plans of one resolution, which become the views from `firstView` on.
void fillClass(SampledBatch& batch, std::span<const ViewPlan* const> plans, uint32_t firstView,
               uint32_t passTriangles) {
  const uint32_t perPass = layersPerPass(plans, passTriangles);
  const uint32_t firstLayer = batch.layers;
  std::vector<Pending> pending;
  for (uint32_t begin = 0; begin < plans.size(); begin += perPass) {
    const uint32_t end = std::min<uint32_t>(begin + perPass, static_cast<uint32_t>(plans.size()));
    const DepthPass shape{firstLayer + begin, end - begin, plans[0]->view.resolution, 0, 0};
    const auto add = [&](const Placed& placed, uint32_t i, bool identified) {
      const auto runs = std::span(plans[i]->runs).subspan(placed.firstRun, placed.runs);
      pending.push_back({&placed, runs, firstView + i, i - begin, identified});
    };
    for (uint32_t i = begin; i < end; ++i) {
      for (const Placed& placed : plans[i]->inReach) add(placed, i, true);
      for (const Placed& placed : plans[i]->others) add(placed, i, false);
    }
    batch.objects += pending.size();
    batch.rangePasses.push_back(addPass(batch, pending, shape));
    for (uint32_t i = begin; i < end; ++i) add(plans[i]->mask, i, true);
    batch.maskPasses.push_back(addPass(batch, pending, shape));
    for (uint32_t i = begin; i < end; ++i) {
      batch.views.push_back(plans[i]->view);
      batch.views.back().layer = firstLayer + i;
      batch.sweeps.push_back(plans[i]->sweep);
      batch.sweeps.back().result = firstView + i;
      batch.triangles += plans[i]->triangles;
    }
    batch.layers = firstLayer + end;
  }
}

}  // namespace

SampledBatch packBatch(std::span<const ViewPlan* const> plans, uint32_t passTriangles) {
  SampledBatch batch;
  for (size_t begin = 0; begin < plans.size();) {
    size_t end = begin;
    while (end < plans.size() && plans[end]->view.resolution == plans[begin]->view.resolution) ++end;
    fillClass(batch, plans.subspan(begin, end - begin), static_cast<uint32_t>(begin), passTriangles);
    begin = end;
  }
  if (!plans.empty()) batch.resolution = plans.back()->view.resolution;
  return batch;
}

}  // namespace radar
