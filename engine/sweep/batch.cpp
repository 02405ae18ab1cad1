#include "sweep/batch.h"

#include <algorithm>
#include <bit>

namespace radar {

namespace {

// Triangles that one render pass should draw: more, and lavapipe's bins outgrow its caches (30 dense sensors in one
// pass were 1.5 times slower than a pass each).
constexpr uint64_t kPassTriangles = 8192;
// Most layers that one render pass draws into.
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
  draw.snap = placed.snap;
  draw.slack = placed.slack;
  draw.view = view;
  draw.layer = layer;
  draw.mesh = placed.mesh;
  draw.object = placed.object;
  return draw;
}

struct Pending {
  const Placed* placed;
  uint32_t view, layer;
  bool identified;
};

// Appends the draws of one pass, sorted by mesh so that each mesh is one instanced call; notes where each identified
// one went, in the order given.
DepthPass addPass(Batch& batch, std::vector<Pending>& pending, std::vector<uint32_t>& placedAt,
                  const DepthPass& shape) {
  DepthPass pass = shape;
  pass.firstCall = static_cast<uint32_t>(batch.calls.size());
  std::vector<uint32_t> order(pending.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return pending[a].placed->mesh < pending[b].placed->mesh; });
  std::vector<uint32_t> at(pending.size());
  for (uint32_t i : order) {
    const Pending& p = pending[i];
    const auto draw = static_cast<uint32_t>(batch.draws.size());
    at[i] = draw;
    const bool fresh = batch.calls.size() == pass.firstCall || batch.calls.back().mesh != p.placed->mesh;
    if (fresh) batch.calls.push_back({p.placed->mesh, draw, 0});
    ++batch.calls.back().count;
    batch.draws.push_back(drawOf(*p.placed, p.view, p.layer));
  }
  for (uint32_t i = 0; i < pending.size(); ++i) {
    if (pending[i].identified) placedAt.push_back(at[i]);
  }
  pass.calls = static_cast<uint32_t>(batch.calls.size()) - pass.firstCall;
  pending.clear();
  return pass;
}

void addItems(Batch& batch, uint32_t draw, uint32_t triangles) {
  for (uint32_t first = 0; first < triangles; first += gpu::kItemTriangles) {
    batch.items.push_back({draw, first, std::min(first + gpu::kItemTriangles, triangles)});
  }
}

// Plans of one resolution, from view `firstView`.
void fillClass(Batch& batch, std::span<const ViewPlan* const> plans, uint32_t firstView, const Scene::Impl& scene) {
  const uint32_t perPass = layersPerPass(plans);
  const uint32_t resolution = plans[0]->view.resolution;
  const uint32_t firstLayer = batch.layers;
  std::vector<Pending> pending;
  std::vector<uint32_t> placedAt;  // draws to identify: by view, R then M, each by object
  for (uint32_t begin = 0; begin < plans.size(); begin += perPass) {
    const uint32_t end = std::min<uint32_t>(begin + perPass, static_cast<uint32_t>(plans.size()));
    const DepthPass shape{firstLayer + begin, end - begin, resolution, 0, 0};
    for (uint32_t i = begin; i < end; ++i) {
      for (const Placed& p : plans[i]->inReach) pending.push_back({&p, firstView + i, i - begin, true});
      for (const Placed& p : plans[i]->others) pending.push_back({&p, firstView + i, i - begin, false});
      batch.objects += plans[i]->inReach.size() + plans[i]->others.size();
    }
    batch.rangePasses.push_back(addPass(batch, pending, placedAt, shape));
    for (uint32_t i = begin; i < end; ++i) pending.push_back({&plans[i]->mask, firstView + i, i - begin, true});
    batch.maskPasses.push_back(addPass(batch, pending, placedAt, shape));
    for (uint32_t i = begin; i < end; ++i) {
      gpu::View view = plans[i]->view;
      view.layer = firstLayer + i;
      batch.views.push_back(view);
      batch.triangles += plans[i]->triangles;
    }
    batch.layers = firstLayer + end;
  }
  for (uint32_t draw : placedAt) addItems(batch, draw, scene.meshes[batch.draws[draw].mesh].triangleCount());
}

}  // namespace

void Batch::clear() {
  views.clear();
  draws.clear();
  items.clear();
  calls.clear();
  rangePasses.clear();
  maskPasses.clear();
  layers = resolution = 0;
  triangles = objects = 0;
}

void fill(Batch& batch, std::span<const ViewPlan* const> plans, const Scene::Impl& scene) {
  batch.clear();
  for (size_t begin = 0; begin < plans.size();) {
    size_t end = begin;
    while (end < plans.size() && plans[end]->view.resolution == plans[begin]->view.resolution) ++end;
    fillClass(batch, plans.subspan(begin, end - begin), static_cast<uint32_t>(begin), scene);
    begin = end;
  }
  if (!plans.empty()) batch.resolution = plans.back()->view.resolution;
}

}  // namespace radar
