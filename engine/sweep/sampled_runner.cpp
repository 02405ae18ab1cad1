#include "sweep/sampled_runner.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>

#include "contact/decode.h"
#include "gpu/api.h"
#include "query/cancelled.h"
#include "sampled/decode.h"
#include "scene/parallel.h"

namespace radar {

namespace {

// Queries whose plans take some 0.2 ms, several times what a thread takes to start.
constexpr size_t kWorthThread = 32;

// Of a render pass. With more, lavapipe's bins outgrow its caches: 30 dense sensors in one pass were 1.5 times slower
// than in a pass each. A GPU has no such bins, and ends a pass before it begins the next: of 256 teapots on an H200, 79
// passes with some 2,500 triangles each took 36 us for R, and 62 us for M.
uint32_t passTrianglesOf(const Device::Impl& device) {
  if (!device.choosesLayers) return 0;
  return device.runsOnCpu() ? 8192 : std::numeric_limits<uint32_t>::max();
}

}  // namespace

SampledRunner::SampledRunner(const gpu::Owner& owner, const Scene& scene, const SweeperOptions& options,
                             GpuScene& resident)
    : device_(owner),
      scene_(scene),
      options_(options),
      passTriangles_(passTrianglesOf(owner)),
      submitter_(owner, resident, options.pictureBytes, options.timestamps) {
  // Staging holds a batch's draws and items at once; a quarter of a GiB at most, less where a device asks for it.
  bufferBytes_ = std::min<uint64_t>(device_.properties.limits.maxStorageBufferRange, 256ull << 20);
  maxItems_ = std::min<uint64_t>(bufferBytes_ / sizeof(gpu::Item), UINT32_MAX / gpu::kItemTriangles - 1);
}

void SampledRunner::Load::add(const ViewPlan& plan) {
  ++views;
  resolution = plan.view.resolution;
  draws += 1 + plan.inReach.size() + plan.others.size();
  items += plan.items;
}

bool SampledRunner::fitsBuffers(const Load& load) const {
  return load.draws * sizeof(gpu::Draw) <= bufferBytes_ && load.items <= maxItems_;
}

bool SampledRunner::fits(const Load& load) const {
  const uint64_t layer = 2ull * load.resolution * load.resolution * sizeof(float);
  return load.views <= device_.maxLayers && load.views * layer <= options_.pictureBytes && fitsBuffers(load);
}

std::string SampledRunner::reasonAgainst(const ViewPlan& plan) const {
  if (!plan.outOfRange.empty()) return plan.outOfRange;
  Load load;
  load.add(plan);
  if (fitsBuffers(load)) return {};  // too large a picture is drawn alone
  const uint64_t bytes = std::max(load.draws * sizeof(gpu::Draw), load.items * sizeof(gpu::Item));
  return "capacity: the objects in reach need a buffer of " + std::to_string(bytes) + " bytes, the device allows " +
         std::to_string(bufferBytes_);
}

ViewPlan SampledRunner::planOf(const Query& query, Drawn drawn) const {
  return planSampled(query, scene_.impl(), device_.properties.limits.subPixelPrecisionBits, drawn);
}

bool SampledRunner::trySubmit(Flight& flight, std::span<Planned> part, bool isLast) {
  const Clock::time_point start = Clock::now();
  std::vector<const ViewPlan*> plans;
  std::vector<size_t> queries;
  for (const Planned& planned : part) {
    plans.push_back(&planned.plan);
    queries.push_back(planned.query);
  }
  drawn_ = packBatch(plans, passTriangles_);
  flight.addCpuTime("plan", msSince(start));
  try {
    submitter_.submit(drawn_, scene_.impl());
  } catch (const Error& error) {
    if (!isLast && gpu::isOutOfMemory(error) && flight.survives(error)) return false;
    for (const size_t query : queries) flight.fail(query, error);
    return true;
  }
  SweepStats& stats = flight.answers.stats;
  ++stats.submissions;
  stats.drawnObjects += drawn_.objects;
  stats.drawnTriangles += drawn_.triangles;
  flight.drawn = std::move(queries);
  return true;
}

void SampledRunner::submit(Flight& flight, std::span<Planned> part) {
  if (part.empty()) return;
  finish(flight);
  throwIfStopped(flight.stop);
  if (trySubmit(flight, part, false)) return;
  if (part.size() == 1) {
    trySubmit(flight, part, true);  // pictures of other queries have been freed
    return;
  }
  submit(flight, part.first(part.size() / 2));
  submit(flight, part.subspan(part.size() / 2));
}

void SampledRunner::finish(Flight& flight) {
  const std::vector<size_t> queries = std::exchange(flight.drawn, {});
  if (queries.empty()) return;
  Answers& answers = flight.answers;
  try {
    const SampledAnswers found = submitter_.collect(drawn_, answers.stats.stages);
    flight.deviceDone = Clock::now();
    std::vector<Result> contacts(found.contacts.begin(), found.contacts.end());
    const Deciding how{.threads = options_.cpuThreads, .stop = flight.stop};
    answers.stats.cpuPairs += decideAll(found.unresolved, how, [&](uint32_t i, ObjectId) {
      const Query& query = flight.queries[queries[i]];
      return OpenSearch{contacts[i], query, Translation(query)};
    });
    for (uint32_t i = 0; i < queries.size(); ++i) {
      answers.results[queries[i]] =
          decodeSampled(found.answers[i], contacts[i], flight.queries[queries[i]], drawn_.views[i].resolution);
    }
    answers.stats.pairs += found.pairs;
    flight.addCpuTime("decode", msSince(flight.deviceDone));
  } catch (const Error& error) {
    for (const size_t query : queries) flight.fail(query, error);
  }
}

void SampledRunner::abandon(Flight& flight) noexcept {
  if (std::exchange(flight.drawn, {}).empty()) return;
  try {
    submitter_.collect(drawn_, flight.answers.stats.stages);
  } catch (const std::exception&) {  // the exception that was first is the one to report
  }
}

// Cuts a slice into submissions that fit.
void SampledRunner::flush(Flight& flight, std::vector<Planned>& slice) {
  std::stable_sort(slice.begin(), slice.end(),
                   [](const Planned& a, const Planned& b) { return a.plan.view.resolution < b.plan.view.resolution; });
  size_t first = 0;
  Load load;
  for (size_t i = 0; i < slice.size(); ++i) {
    Load next = load;
    next.add(slice[i].plan);
    if (i > first && !fits(next)) {
      submit(flight, std::span(slice).subspan(first, i - first));
      first = i;
      next = {};
      next.add(slice[i].plan);
    }
    load = next;
  }
  submit(flight, std::span(slice).subspan(first));
  slice.clear();
}

std::vector<ViewPlan> SampledRunner::planFrom(const Flight& flight, size_t first) const {
  const size_t count = std::min<size_t>(flight.queries.size() - first, device_.maxLayers);
  const unsigned threads = std::min(threadCount(options_.cpuThreads), static_cast<unsigned>(count / kWorthThread + 1));
  std::vector<std::optional<ViewPlan>> plans(count);
  std::atomic<uint64_t> bytes = 0;
  parallelFor(count, 1, threads, [&](unsigned, size_t i, size_t) {
    throwIfStopped(flight.stop);
    if (i > 0 && bytes > bufferBytes_) return;
    plans[i] = planOf(flight.queries[first + i], options_.select ? Drawn::inReach : Drawn::everything);
    Load load;
    load.add(*plans[i]);
    bytes += load.draws * sizeof(gpu::Draw) + load.items * sizeof(gpu::Item);
  });
  std::vector<ViewPlan> out;
  out.reserve(count);
  for (size_t i = 0; i < count && plans[i]; ++i) out.push_back(std::move(*plans[i]));
  return out;
}

void SampledRunner::begin(Flight& flight) {
  // A slice is encoded, then submitted in as few parts as fit; it holds what a submission can at most, so that memory
  // stays bounded however many queries there are.
  std::vector<Planned> slice;
  Load load;
  for (size_t query = 0; query < flight.queries.size();) {
    const Clock::time_point start = Clock::now();
    std::vector<ViewPlan> plans = planFrom(flight, query);
    flight.addCpuTime("select", msSince(start));
    for (ViewPlan& plan : plans) {
      const size_t i = query++;
      if (plan.inReach.empty() && plan.outOfRange.empty()) {
        flight.answers.results[i] = decodeClear();
        continue;
      }
      if (std::string reason = reasonAgainst(plan); !reason.empty()) {
        flight.answers.reasons[i] = std::move(reason);
        continue;
      }
      load.add(plan);
      slice.push_back({i, std::move(plan)});
      if (slice.size() >= device_.maxLayers || !fitsBuffers(load)) {
        flush(flight, slice);
        load = {};
      }
    }
  }
  flush(flight, slice);
}

Scopes SampledRunner::scopes(const Query& query) {
  const ViewPlan plan = planOf(query, options_.select ? Drawn::wholeMask : Drawn::everything);
  if (std::string reason = reasonAgainst(plan); !reason.empty()) {
    throw Error(plan.outOfRange.empty() ? Error::Kind::device : Error::Kind::call, "scopes: " + reason);
  }
  const ViewPlan* plans[] = {&plan};
  drawn_ = packBatch(plans, passTriangles_);
  StoredScopes stored;
  SweepStats stats;
  submitter_.submit(drawn_, scene_.impl(), true);
  const SampledAnswers found = submitter_.collect(drawn_, stats.stages, &stored);

  Scopes out;
  Result contact = found.contacts[0];
  decideAll(found.unresolved, {}, [&](uint32_t, ObjectId) { return OpenSearch{contact, query, Translation(query)}; });
  out.result =
      plan.inReach.empty() ? decodeClear() : decodeSampled(found.answers[0], contact, query, plan.view.resolution);
  out.width = plan.view.width;
  out.height = plan.view.height;
  out.pixel = plan.pixel;
  out.d = plan.d;
  out.length = plan.length;
  out.origin = plan.corner;
  out.right = plan.axes[0];
  out.up = plan.axes[1];
  out.forward = plan.axes[2];
  const float null = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 0; i < stored.range.size(); ++i) {
    const bool hasR = stored.range[i] < 1, hasM = stored.mask[i] < 1;
    const float R = plan.view.rangeScale * stored.range[i];
    const float sensor = plan.view.maskBase - plan.view.maskScale * stored.mask[i];
    out.R.push_back(hasR ? R : null);
    out.M.push_back(hasM ? static_cast<float>(plan.d - sensor) : null);
    out.L.push_back(hasR && hasM ? R - sensor : null);
  }
  return out;
}

}  // namespace radar
