#include "sampled/batch.h"

#include <algorithm>
#include <bit>
#include <tuple>

namespace radar {

namespace {

// Target number of triangles per render pass. With more, lavapipe's bins outgrow its caches: 30 dense sensors in one
// pass were 1.5 times slower than in a pass each.
constexpr uint64_t kPassTriangles = 8192;
// Maximum number of layers per render pass.
constexpr uint32_t kMaxPassLayers = 64;

uint32_t layersPerPass(std::span<const ViewPlan* const> plans) {
  uint64_t triangles = 0;
  for (const ViewPlan* plan : plans) triangles += plan->triangles;
  const uint64_t fit =
      std::clamp<uint64_t>(kPassTriangles * plans.size() / std::max<uint64_t>(triangles, 1), 1, kMaxPassLayers);
  return std::bit_floor(static_cast<uint32_t>(std::min<uint64_t>(fit, plans.size())));
}

gpu::Draw drawOf(const Placed& placed, uint32_t view, uint32_t layer) {
  gpu::Draw draw{};
  std::copy(placed.clipFromMesh.begin(), placed.clipFromMesh.end(), draw.clipFromMesh);
  std::copy(placed.origin.begin(), placed.origin.end(), draw.origin);
  draw.snap = placed.snap;
  draw.slack = placed.slack;
  draw.view = view;
  draw.layer = layer;
  draw.mesh = placed.mesh;
  draw.object = placed.object;
  return draw;
}

struct Pending {
  const ViewPlan* plan;
  const Placed* placed;
  uint32_t view, layer;
  bool identified;

  std::span<const Run> runs() const { return std::span(plan->runs).subspan(placed->firstRun, placed->runs); }
};

// A draw whose triangles are identified, and the runs that it draws.
struct Identified {
  uint32_t draw;
  std::span<const Run> runs;
};

// An order that makes equal draws adjacent: those of the same mesh and first run.
bool drawnBefore(const Pending& a, const Pending& b) {
  const Run x = a.runs()[0], y = b.runs()[0];
  return std::tuple(a.placed->mesh, x.first, x.count) < std::tuple(b.placed->mesh, y.first, y.count);
}

// Appends the draws of one pass. Draws of the same single run become one instanced call. Appends the draws whose
// triangles are identified to `identified`, in the order of `pending`.
DepthPass addPass(SampledBatch& batch, std::vector<Pending>& pending, std::vector<Identified>& identified,
                  const DepthPass& shape) {
  DepthPass pass = shape;
  pass.firstCall = static_cast<uint32_t>(batch.calls.size());
  std::erase_if(pending, [](const Pending& p) { return p.placed->runs == 0; });
  std::vector<uint32_t> order(pending.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return drawnBefore(pending[a], pending[b]); });
  std::vector<uint32_t> at(pending.size());
  const Pending* last = nullptr;
  for (uint32_t i : order) {
    const Pending& p = pending[i];
    const auto draw = static_cast<uint32_t>(batch.draws.size());
    at[i] = draw;
    const bool alike = last != nullptr && last->placed->runs == 1 && p.placed->runs == 1 && !drawnBefore(*last, p);
    if (alike) {
      ++batch.calls.back().count;
    } else {
      for (const Run& run : p.runs()) batch.calls.push_back({p.placed->mesh, run, draw, 1});
    }
    batch.draws.push_back(drawOf(*p.placed, p.view, p.layer));
    last = &p;
  }
  for (uint32_t i = 0; i < pending.size(); ++i) {
    if (pending[i].identified) identified.push_back({at[i], pending[i].runs()});
  }
  pass.calls = static_cast<uint32_t>(batch.calls.size()) - pass.firstCall;
  pending.clear();
  return pass;
}

void addItems(SampledBatch& batch, const Identified& identified) {
  for (const Run& run : identified.runs) {
    const uint32_t end = run.first + run.count;
    for (uint32_t first = run.first; first < end; first += gpu::kItemTriangles) {
      batch.items.push_back({identified.draw, first, std::min(first + gpu::kItemTriangles, end)});
    }
  }
}

// Packs plans of one resolution, which become the views from `firstView` on.
void fillClass(SampledBatch& batch, std::span<const ViewPlan* const> plans, uint32_t firstView) {
  const uint32_t perPass = layersPerPass(plans);
  const uint32_t resolution = plans[0]->view.resolution;
  const uint32_t firstLayer = batch.layers;
  std::vector<Pending> pending;
  std::vector<Identified> identified;  // by view, R then M, each by object
  for (uint32_t begin = 0; begin < plans.size(); begin += perPass) {
    const uint32_t end = std::min<uint32_t>(begin + perPass, static_cast<uint32_t>(plans.size()));
    const DepthPass shape{firstLayer + begin, end - begin, resolution, 0, 0};
    for (uint32_t i = begin; i < end; ++i) {
      const ViewPlan* plan = plans[i];
      for (const Placed& p : plan->inReach) pending.push_back({plan, &p, firstView + i, i - begin, true});
      for (const Placed& p : plan->others) pending.push_back({plan, &p, firstView + i, i - begin, false});
      batch.objects += plan->inReach.size() + plan->others.size();
    }
    batch.rangePasses.push_back(addPass(batch, pending, identified, shape));
    for (uint32_t i = begin; i < end; ++i) {
      pending.push_back({plans[i], &plans[i]->mask, firstView + i, i - begin, true});
    }
    batch.maskPasses.push_back(addPass(batch, pending, identified, shape));
    for (uint32_t i = begin; i < end; ++i) {
      gpu::View view = plans[i]->view;
      view.layer = firstLayer + i;
      batch.views.push_back(view);
      batch.triangles += plans[i]->triangles;
    }
    batch.layers = firstLayer + end;
  }
  for (const Identified& each : identified) addItems(batch, each);
}

}  // namespace

void SampledBatch::clear() {
  views.clear();
  draws.clear();
  items.clear();
  calls.clear();
  rangePasses.clear();
  maskPasses.clear();
  layers = resolution = 0;
  triangles = objects = 0;
}

void packBatch(SampledBatch& batch, std::span<const ViewPlan* const> plans) {
  batch.clear();
  for (size_t begin = 0; begin < plans.size();) {
    size_t end = begin;
    while (end < plans.size() && plans[end]->view.resolution == plans[begin]->view.resolution) ++end;
    fillClass(batch, plans.subspan(begin, end - begin), static_cast<uint32_t>(begin));
    begin = end;
  }
  if (!plans.empty()) batch.resolution = plans.back()->view.resolution;
}

}  // namespace radar
