#include "sweep/bounded_tier.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sweep/decode.h"

namespace radar {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// One submission holds at most so many sensors.
constexpr uint64_t kMaxViews = 2048;

// Whether the bracket is all that was asked for; to decide, that it lies on one side of D.
bool settled(const Result& result, const Query& query) {
  if (result.status == Status::clear || result.status == Status::overlap) return true;
  if (query.decide) return result.status == Status::hit;
  return result.hi - result.lo <= query.tolerance;  // never where hi is not known
}

Result unknown(uint32_t resolution) {
  Result result;
  result.status = Status::undecided;
  result.tier = Tier::bounded;
  result.resolution = resolution;
  result.lo = 0;
  return result;
}

// One look's answer; `nominated` is what its pairs give.
Result bracketOf(const BoundedPlan& plan, const gpu::Answer& answer, const Query& query, Result nominated) {
  // Pixels to world units: the product rounds, and 1 / pixel did when the scene was placed.
  const double lo = double{answer.lo} * plan.pixel * (1 - 0x1p-48);
  nominated.tier = Tier::bounded;
  if (answer.lo < 0 || lo > query.distance) {
    nominated.status = Status::clear;
    nominated.lo = std::nan("");
    nominated.detected = Detected::notLooked;
  } else if (nominated.status == Status::undecided) {
    nominated.lo = lo;
    nominated.detected = Detected::notLooked;
  } else {
    nominated.lo = nominated.status == Status::overlap ? 0 : lo;
    nominated.detected = Detected::yes;
  }
  return nominated;
}

// What both looks at one query know together.
void combine(Result& known, const Result& finer) {
  if (known.status == Status::invalid || finer.status == Status::clear || finer.status == Status::overlap) {
    known = finer;
    return;
  }
  const double lo = std::max(known.lo, finer.lo);
  if (std::isnan(known.hi) || finer.hi < known.hi) known = finer;
  known.lo = lo;
  known.resolution = finer.resolution;
}

}  // namespace

BoundedTier::BoundedTier(const Device::Impl& device, ResidentScene& resident, uint64_t pictureBytes, bool timestamps)
    : device_(&device),
      pictureBytes_(pictureBytes),
      bufferBytes_(std::min<uint64_t>(device.properties.limits.maxStorageBufferRange, 256ull << 20)),
      timestamps_(timestamps),
      recorder_(device, resident, timestamps) {}

void BoundedTier::Load::add(const BoundedPlan& plan) {
  ++views;
  pixels += plan.pixels();
  draws += plan.draws.size();
  items += plan.items.size();
  bands += plan.sceneBands.size() + plan.sensorBands.size();
}

bool BoundedTier::fits(const Load& load, bool alone) const {
  const uint64_t scopes = BoundedRecorder::scopeBytes(load.pixels);
  return load.views <= kMaxViews && scopes <= (alone ? bufferBytes_ : std::min(pictureBytes_, bufferBytes_)) &&
         load.draws * sizeof(gpu::Draw) <= bufferBytes_ && load.bands * sizeof(gpu::Band) <= bufferBytes_ &&
         load.items < UINT32_MAX / gpu::kItemTriangles;
}

void BoundedTier::submit(std::span<const Query> queries, std::vector<Pending>& slice, const Scene::Impl& scene,
                         const Out& out) {
  if (slice.empty()) return;
  std::vector<const BoundedPlan*> plans;
  plans.reserve(slice.size());
  for (const Pending& pending : slice) plans.push_back(&pending.plan);
  try {
    const Answers found = recorder_.submit(plans, scene, out.stats.stages);
    const Clock::time_point start = Clock::now();
    for (size_t i = 0; i < slice.size(); ++i) {
      const Query& query = queries[slice[i].query];
      const gpu::Answer& answer = found.answers[i];
      Result nominated = decode(answer, found.openPairs.subspan(i * gpu::kOpenPairs, gpu::kOpenPairs), query, scene,
                                slice[i].plan.view.resolution, out.stats.cpuPairs);
      combine(out.results[slice[i].query], bracketOf(slice[i].plan, answer, query, nominated));
      out.stats.pairs += answer.pairs;
      out.stats.drawnObjects += slice[i].plan.draws.size() - 1;
      for (const gpu::Item& item : slice[i].plan.items) {
        out.stats.drawnTriangles += item.endTriangle - item.firstTriangle;
      }
    }
    if (timestamps_) gpu::addStageTime(out.stats.stages, "decode", msSince(start));
  } catch (const Error& error) {
    for (const Pending& pending : slice) out.giveUp(pending.query, error);
  }
  ++out.stats.submissions;
  slice.clear();
}

OuterScopes BoundedTier::look(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy,
                              SweepStats& stats) {
  const BoundedPlan plan =
      planBounded(query, scene, hierarchy, query.resolution != 0 ? query.resolution : kCoarsest, device_->outerByPixel);
  OuterScopes out;
  out.result = decodeClear();
  if (plan.sceneBands.empty()) return out;
  if (!plan.measurable) throw Error("outer scopes: float cannot tell the scene's pixels apart");
  Load load;
  load.add(plan);
  if (!fits(load, true)) throw Error("outer scopes: what is in reach needs a larger buffer than the device allows");
  const BoundedPlan* plans[] = {&plan};
  std::vector<StoredOuterScopes> stored;
  const Answers found = recorder_.submit(plans, scene, stats.stages, &stored);
  ++stats.submissions;
  const Result nominated =
      decode(found.answers[0], found.openPairs, query, scene, plan.view.resolution, stats.cpuPairs);
  out.result = bracketOf(plan, found.answers[0], query, nominated);
  out.width = plan.view.width;
  out.height = plan.view.height;
  out.pixel = plan.pixel;
  out.origin = plan.corner;
  out.right = plan.axes[0];
  out.up = plan.axes[1];
  out.forward = plan.axes[2];
  const StoredOuterScopes& s = stored[0];
  for (size_t i = 0; i < s.sceneNearest.size(); ++i) {
    const double free = double{s.sceneNearest[i]} - s.sensorFarthest[i];  // NaN where either is
    out.bound.push_back(static_cast<float>(plan.pixel * (free < 0 ? 0 : free)));
  }
  for (const auto& [from, to] :
       {std::pair{&s.sensorNearest, &out.sensorNearest}, std::pair{&s.sensorFarthest, &out.sensorFarthest},
        std::pair{&s.sceneNearest, &out.sceneNearest}, std::pair{&s.sceneFarthest, &out.sceneFarthest}}) {
    for (const float depth : *from) to->push_back(static_cast<float>(plan.pixel * depth));
  }
  return out;
}

std::vector<size_t> BoundedTier::run(std::span<const Query> queries, std::span<const size_t> which,
                                     const Scene::Impl& scene, const Hierarchy& hierarchy, const Out& out) {
  std::vector<size_t> open(which.begin(), which.end()), done;
  for (uint32_t step = kCoarsest; !open.empty() && step <= kFinest; step *= 2) {
    std::vector<Pending> slice;
    Load load;
    const auto flush = [&] {
      submit(queries, slice, scene, out);
      load = {};
    };
    for (const size_t i : open) {
      const Clock::time_point start = Clock::now();
      const uint32_t resolution = queries[i].resolution != 0 ? queries[i].resolution : step;
      BoundedPlan plan = planBounded(queries[i], scene, hierarchy, resolution, device_->outerByPixel);
      if (timestamps_) gpu::addStageTime(out.stats.stages, "select", msSince(start));
      if (plan.sceneBands.empty()) {
        out.results[i] = decodeClear();
        continue;
      }
      if (!plan.measurable) {
        combine(out.results[i], unknown(resolution));
        continue;
      }
      Load alone;
      alone.add(plan);
      if (!fits(alone, true)) {
        if (out.results[i].status == Status::invalid) {
          out.reasons[i] = "capacity: what is in reach needs a larger buffer than the device allows";
        }
        continue;
      }
      Load next = load;
      next.add(plan);
      if (!fits(next, false)) {
        flush();
        next = alone;
      }
      load = next;
      slice.push_back({i, std::move(plan)});
    }
    flush();
    std::vector<size_t> again;
    for (const size_t i : open) {
      if (out.results[i].status == Status::invalid || settled(out.results[i], queries[i])) continue;
      const bool last = queries[i].mode != Mode::bounded || queries[i].resolution != 0 || 2 * step > kFinest;
      (last ? done : again).push_back(i);
    }
    open = std::move(again);
  }
  std::sort(done.begin(), done.end());
  return done;
}

}  // namespace radar
