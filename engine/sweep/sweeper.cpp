// A query travels: run -> encode -> fill -> submit -> decode.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "gpu/device.h"
#include "sweep/bounded_tier.h"
#include "sweep/contact_decode.h"
#include "sweep/decode.h"
#include "sweep/recorder.h"

namespace radar {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// One submission of the contact tier holds at most so many sensors, and about so many clusters.
constexpr size_t kMaxTargets = 2048;
constexpr uint64_t kMaxRefs = 1u << 20;

// One query of a slice on its way to the device.
struct Pending {
  size_t query;
  ViewPlan plan;
};

// What one submission has to hold.
struct Load {
  uint64_t views = 0, draws = 0, items = 0;
  uint32_t resolution = 0;
};

}  // namespace

struct Sweeper::Impl {
  Impl(const Device& openDevice, const Scene& ownScene, const SweeperOptions& given)
      : device(openDevice.impl()),
        scene(ownScene),
        options(given),
        resident(device),
        recorder(device, resident, given.pictureBytes, given.timestamps),
        contactRecorder(device, resident, given.timestamps) {
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    // Staging holds a batch's draws and items at once; a quarter of a GiB at most, less where a device asks for it.
    bufferBytes = std::min<uint64_t>(limits.maxStorageBufferRange, 256ull << 20);
    maxItems = std::min<uint64_t>(bufferBytes / sizeof(gpu::Item), UINT32_MAX / gpu::kItemTriangles - 1);
  }

  bool fits(const Load& load) const;
  static void add(Load& load, const ViewPlan& plan);
  std::string tooLarge(const ViewPlan& plan) const;
  void flush(std::vector<Pending>& slice, std::span<const Query> queries, std::vector<Result>& results);
  void submit(std::span<Pending> part, std::span<const Query> queries, std::vector<Result>& results);
  void runSampled(std::span<const Query> queries, std::span<const size_t> which, std::vector<Result>& results);
  std::vector<size_t> runBounded(std::span<const Query> queries, std::span<const size_t> which,
                                 std::vector<Result>& results);
  void runContact(std::span<const Query> queries, std::span<const size_t> which, std::vector<Result>& results);
  void search(std::span<const size_t> which, std::span<const ContactPlan> plans, std::span<const Query> queries,
              std::vector<Result>& results);
  void giveUp(size_t query, const Error& error, std::vector<Result>& results);
  void addCpuTime(const char* name, double ms);
  void refuseWrong(std::span<const Query> queries) const;

  const Device::Impl& device;
  const Scene& scene;
  SweeperOptions options;
  ResidentScene resident;
  Recorder recorder;
  std::optional<BoundedTier> boundedTier;  ///< made when first needed: pipelines take a while
  ContactRecorder contactRecorder;
  Hierarchy hierarchy;
  Batch batch;
  SweepStats stats;
  std::map<size_t, std::string> reasons;
  uint64_t bufferBytes;
  uint64_t maxItems;  // items name triangles in 32 bits
};

void Sweeper::Impl::add(Load& load, const ViewPlan& plan) {
  ++load.views;
  load.resolution = plan.view.resolution;
  load.draws += 1 + plan.inReach.size() + plan.others.size();
  load.items += plan.items;
}

bool Sweeper::Impl::fits(const Load& load) const {
  const uint64_t layer = 2ull * load.resolution * load.resolution * sizeof(float);
  return load.views <= device.maxLayers && load.views * layer <= options.pictureBytes &&
         load.draws * sizeof(gpu::Draw) <= bufferBytes && load.items <= maxItems;
}

std::string Sweeper::Impl::tooLarge(const ViewPlan& plan) const {
  Load load;
  add(load, plan);
  if (load.draws * sizeof(gpu::Draw) <= bufferBytes && load.items <= maxItems)
    return {};  // too large a picture is drawn alone
  const uint64_t bytes = std::max(load.draws * sizeof(gpu::Draw), load.items * sizeof(gpu::Item));
  return "capacity: the objects in reach need a buffer of " + std::to_string(bytes) + " bytes, the device allows " +
         std::to_string(bufferBytes);
}

void Sweeper::Impl::addCpuTime(const char* name, double ms) {
  if (options.timestamps) gpu::addStageTime(stats.stages, name, ms);
}

void Sweeper::Impl::refuseWrong(std::span<const Query> queries) const {
  for (size_t i = 0; i < queries.size(); ++i) {
    const std::string wrong = whatIsWrong(queries[i], scene);
    if (!wrong.empty()) throw Error("query " + std::to_string(i) + ": " + wrong);
  }
}

// One submission.
void Sweeper::Impl::submit(std::span<Pending> part, std::span<const Query> queries, std::vector<Result>& results) {
  if (part.empty()) return;
  const Clock::time_point start = Clock::now();
  std::vector<const ViewPlan*> plans;
  for (const Pending& pending : part) plans.push_back(&pending.plan);
  fill(batch, plans);
  addCpuTime("encode", msSince(start));
  try {
    const Answers found = recorder.submit(batch, scene.impl(), stats.stages);
    const Clock::time_point decodeStart = Clock::now();
    for (size_t i = 0; i < part.size(); ++i) {
      const size_t query = part[i].query;
      results[query] = decode(found.answers[i], found.openPairs.subspan(i * gpu::kOpenPairs, gpu::kOpenPairs),
                              queries[query], scene.impl(), batch.views[i].resolution, stats.cpuPairs);
      stats.pairs += found.answers[i].pairs;
    }
    addCpuTime("decode", msSince(decodeStart));
  } catch (const Error& error) {
    for (const Pending& pending : part) giveUp(pending.query, error, results);
  }
  ++stats.submissions;
  stats.drawnObjects += batch.objects;
  stats.drawnTriangles += batch.triangles;
}

// Cuts a slice into submissions that fit.
void Sweeper::Impl::flush(std::vector<Pending>& slice, std::span<const Query> queries, std::vector<Result>& results) {
  std::stable_sort(slice.begin(), slice.end(),
                   [](const Pending& a, const Pending& b) { return a.plan.view.resolution < b.plan.view.resolution; });
  size_t first = 0;
  Load load;
  for (size_t i = 0; i < slice.size(); ++i) {
    Load next = load;
    add(next, slice[i].plan);
    if (i > first && !fits(next)) {
      submit(std::span(slice).subspan(first, i - first), queries, results);
      first = i;
      next = {};
      add(next, slice[i].plan);
    }
    load = next;
  }
  submit(std::span(slice).subspan(first), queries, results);
  slice.clear();
}

void Sweeper::Impl::giveUp(size_t query, const Error& error, std::vector<Result>& results) {
  if (error.result == VK_SUCCESS) throw error;
  results[query] = Result();
  reasons[query] = error.what();
}

void Sweeper::Impl::runSampled(std::span<const Query> queries, std::span<const size_t> which,
                               std::vector<Result>& results) {
  // A slice is encoded, then submitted in as few parts as fit; it holds what a submission can at most, so that memory
  // stays bounded however many queries there are.
  std::vector<Pending> slice;
  Load load;
  for (const size_t i : which) {
    const Clock::time_point start = Clock::now();
    ViewPlan plan = encode(queries[i], scene.impl(), hierarchy, device.properties.limits.subPixelPrecisionBits,
                           options.select ? Drawn::inReach : Drawn::everything);
    addCpuTime("select", msSince(start));
    if (plan.inReach.empty()) {
      results[i] = decodeClear();
      continue;
    }
    if (std::string reason = tooLarge(plan); !reason.empty()) {
      reasons[i] = std::move(reason);
      continue;
    }
    add(load, plan);
    slice.push_back({i, std::move(plan)});
    if (slice.size() >= device.maxLayers || load.draws * sizeof(gpu::Draw) > bufferBytes || load.items > maxItems) {
      flush(slice, queries, results);
      load = {};
    }
  }
  flush(slice, queries, results);
}

// Returns what the bracket does not settle.
std::vector<size_t> Sweeper::Impl::runBounded(std::span<const Query> queries, std::span<const size_t> which,
                                              std::vector<Result>& results) {
  if (which.empty()) return {};
  if (!boundedTier) boundedTier.emplace(device, resident, options.pictureBytes, options.timestamps);
  return boundedTier->run(queries, which, scene.impl(), hierarchy, {results, reasons, stats});
}

void Sweeper::Impl::search(std::span<const size_t> which, std::span<const ContactPlan> plans,
                           std::span<const Query> queries, std::vector<Result>& results) {
  if (plans.empty()) return;
  std::vector<const ContactPlan*> pointers;
  for (const ContactPlan& plan : plans) pointers.push_back(&plan);
  double decodeMs = 0;
  try {
    const auto decodeOne = [&](size_t i, const Search& found) {
      const Clock::time_point start = Clock::now();
      try {
        results[which[i]] = decodeContact(found, queries[which[i]], scene.impl(), stats.cpuPairs);
      } catch (const Error& error) {
        giveUp(which[i], error, results);
      }
      stats.pairs += found.state.boxPairs;
      stats.clusterPairs += found.state.pairCount;
      stats.solves += found.state.solved;
      decodeMs += msSince(start);
    };
    for (const size_t i : contactRecorder.search(pointers, scene.impl(), stats.stages, decodeOne)) {
      reasons[which[i]] = "capacity: more clusters or triangles meet than a buffer of the device can list";
    }
  } catch (const Error& error) {
    for (const size_t i : which) giveUp(i, error, results);
  }
  addCpuTime("decode", decodeMs);
  ++stats.submissions;
}

void Sweeper::Impl::runContact(std::span<const Query> queries, std::span<const size_t> which,
                               std::vector<Result>& results) {
  std::vector<size_t> slice;
  std::vector<ContactPlan> plans;
  uint64_t refs = 0;
  const auto flushSlice = [&] {
    search(slice, plans, queries, results);
    slice.clear();
    plans.clear();
    refs = 0;
  };
  for (const size_t i : which) {
    const Clock::time_point start = Clock::now();
    ContactPlan plan = planContact(queries[i], scene.impl(), hierarchy);
    addCpuTime("select", msSince(start));
    if (plan.scene.empty()) {
      results[i] = decodeClear();
      continue;
    }
    refs += plan.sensor.size() + plan.scene.size();
    stats.clusters += plan.sensor.size() + plan.scene.size();
    slice.push_back(i);
    plans.push_back(std::move(plan));
    if (slice.size() == kMaxTargets || refs >= kMaxRefs) flushSlice();
  }
  flushSlice();
}

Sweeper::Sweeper(const Device& device, const Scene& scene, const SweeperOptions& options)
    : impl_(std::make_unique<Impl>(device, scene, options)) {}
Sweeper::~Sweeper() = default;
Sweeper::Sweeper(Sweeper&&) noexcept = default;
Sweeper& Sweeper::operator=(Sweeper&&) noexcept = default;

void Sweeper::sync() {
  impl_->hierarchy.update(impl_->scene.impl());
  impl_->recorder.sync(impl_->scene.impl());
}

std::vector<Result> Sweeper::run(std::span<const Query> queries) {
  Impl& self = *impl_;
  self.refuseWrong(queries);
  self.stats = {};
  self.reasons.clear();
  std::vector<Result> results(queries.size());
  const Clock::time_point start = Clock::now();
  self.hierarchy.update(self.scene.impl());
  self.addCpuTime("select", msSince(start));
  std::vector<size_t> sampled, bounded, contact;
  for (size_t i = 0; i < queries.size(); ++i) {
    const Query& query = queries[i];
    const bool bracket = query.mode == Mode::bounded || (query.mode == Mode::contact && query.tolerance > 0);
    (query.mode == Mode::sampled ? sampled : bracket ? bounded : contact).push_back(i);
  }
  self.runSampled(queries, sampled, results);
  for (const size_t i : self.runBounded(queries, bounded, results)) {
    if (queries[i].mode == Mode::contact) contact.push_back(i);
  }
  self.runContact(queries, contact, results);
  return results;
}

Scopes Sweeper::scopes(const Query& query) {
  Impl& self = *impl_;
  self.refuseWrong({&query, 1});
  self.hierarchy.update(self.scene.impl());
  const ViewPlan plan =
      encode(query, self.scene.impl(), self.hierarchy, self.device.properties.limits.subPixelPrecisionBits,
             self.options.select ? Drawn::wholeMask : Drawn::everything);
  if (std::string reason = self.tooLarge(plan); !reason.empty()) throw Error("scopes: " + reason);
  const ViewPlan* plans[] = {&plan};
  fill(self.batch, plans);
  StoredScopes stored;
  self.stats = {};
  const Answers found = self.recorder.submit(self.batch, self.scene.impl(), self.stats.stages, &stored);

  Scopes out;
  out.result = plan.inReach.empty() ? decodeClear()
                                    : decode(found.answers[0], found.openPairs, query, self.scene.impl(),
                                             plan.view.resolution, self.stats.cpuPairs);
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

const SweepStats& Sweeper::stats() const {
  return impl_->stats;
}

const std::string& Sweeper::reason(size_t i) const {
  static const std::string kNothing;
  const auto found = impl_->reasons.find(i);
  return found == impl_->reasons.end() ? kNothing : found->second;
}

}  // namespace radar
