// A query travels: begin -> encode -> fill -> submit ... finish -> land -> decode. One submission at a time is with the
// device; it lands before the next is staged.
#include "sweep/sweeper.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include "sweep/contact_decode.h"
#include "sweep/decode.h"

namespace radar {

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// One submission of the contact tier holds at most so many sensors, and about so many clusters.
constexpr size_t kMaxTargets = 2048;
constexpr uint64_t kMaxRefs = 1u << 20;

}  // namespace

Sweeper::Impl::Impl(const Device& openDevice, const Scene& ownScene, const SweeperOptions& given,
                    std::shared_ptr<SceneCopy> sceneCopy, const ContactRoom& room)
    : device(openDevice.impl()),
      scene(ownScene),
      options(given),
      copy(std::move(sceneCopy)),
      recorder(device, copy->resident, given.pictureBytes, given.timestamps),
      contactRecorder(device, copy->resident, given.timestamps, room) {
  const VkPhysicalDeviceLimits& limits = device.properties.limits;
  // Staging holds a batch's draws and items at once; a quarter of a GiB at most, less where a device asks for it.
  bufferBytes = std::min<uint64_t>(limits.maxStorageBufferRange, 256ull << 20);
  maxItems = std::min<uint64_t>(bufferBytes / sizeof(gpu::Item), UINT32_MAX / gpu::kItemTriangles - 1);
}

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

void Sweeper::Impl::submit(std::span<Pending> part) {
  if (part.empty()) return;
  land();
  const Clock::time_point start = Clock::now();
  std::vector<const ViewPlan*> plans;
  flying.clear();
  for (const Pending& pending : part) {
    plans.push_back(&pending.plan);
    flying.push_back(pending.query);
  }
  fill(batch, plans);
  addCpuTime("encode", msSince(start));
  ++stats.submissions;
  stats.drawnObjects += batch.objects;
  stats.drawnTriangles += batch.triangles;
  try {
    recorder.submit(batch, scene.impl());
    flight = Flight::sampled;
  } catch (const Error& error) {
    for (const size_t query : flying) giveUp(query, error);
  }
}

void Sweeper::Impl::landSampled() {
  const Answers found = recorder.collect(batch, scene.impl(), stats.stages);
  deviceDone = Clock::now();
  for (size_t i = 0; i < flying.size(); ++i) {
    const size_t query = flying[i];
    answers[query] = decode(found.answers[i], found.openPairs.subspan(i * gpu::kOpenPairs, gpu::kOpenPairs),
                            asked[query], scene.impl(), batch.views[i].resolution, stats.cpuPairs);
    stats.pairs += found.answers[i].pairs;
  }
  addCpuTime("decode", msSince(deviceDone));
}

// Cuts a slice into submissions that fit.
void Sweeper::Impl::flush(std::vector<Pending>& slice) {
  std::stable_sort(slice.begin(), slice.end(),
                   [](const Pending& a, const Pending& b) { return a.plan.view.resolution < b.plan.view.resolution; });
  size_t first = 0;
  Load load;
  for (size_t i = 0; i < slice.size(); ++i) {
    Load next = load;
    add(next, slice[i].plan);
    if (i > first && !fits(next)) {
      submit(std::span(slice).subspan(first, i - first));
      first = i;
      next = {};
      add(next, slice[i].plan);
    }
    load = next;
  }
  submit(std::span(slice).subspan(first));
  slice.clear();
}

void Sweeper::Impl::giveUp(size_t query, const Error& error) {
  if (error.result == VK_SUCCESS) throw error;
  if (!failure) failure = error;
  answers[query] = Result();
  reasons[query] = error.what();
}

void Sweeper::Impl::runSampled(std::span<const size_t> which) {
  // A slice is encoded, then submitted in as few parts as fit; it holds what a submission can at most, so that memory
  // stays bounded however many queries there are.
  std::vector<Pending> slice;
  Load load;
  for (const size_t i : which) {
    const Clock::time_point start = Clock::now();
    ViewPlan plan = encode(asked[i], scene.impl(), copy->hierarchy, device.properties.limits.subPixelPrecisionBits,
                           options.select ? Drawn::inReach : Drawn::everything);
    addCpuTime("select", msSince(start));
    if (plan.inReach.empty()) {
      answers[i] = decodeClear();
      continue;
    }
    if (std::string reason = tooLarge(plan); !reason.empty()) {
      reasons[i] = std::move(reason);
      continue;
    }
    add(load, plan);
    slice.push_back({i, std::move(plan)});
    if (slice.size() >= device.maxLayers || load.draws * sizeof(gpu::Draw) > bufferBytes || load.items > maxItems) {
      flush(slice);
      load = {};
    }
  }
  flush(slice);
}

BoundedTier& Sweeper::Impl::bounded() {
  if (!boundedTier) boundedTier.emplace(device, copy->resident, options.pictureBytes, options.timestamps);
  return *boundedTier;
}

// Returns what the bracket does not settle.
std::vector<size_t> Sweeper::Impl::runBounded(std::span<const size_t> which) {
  if (which.empty()) return {};
  land();
  const auto fail = [&](size_t query, const Error& error) { giveUp(query, error); };
  return bounded().run(asked, which, scene.impl(), copy->hierarchy, {answers, reasons, stats, fail});
}

void Sweeper::Impl::search(std::vector<size_t>& which, std::vector<ContactPlan>& plans) {
  if (plans.empty()) return;
  land();
  flying.swap(which);
  contactPlans.swap(plans);
  contactPointers.clear();
  for (const ContactPlan& plan : contactPlans) contactPointers.push_back(&plan);
  ++stats.submissions;
  try {
    contactRecorder.submit(contactPointers, scene.impl());
    flight = Flight::contact;
  } catch (const Error& error) {
    for (const size_t query : flying) giveUp(query, error);
  }
}

void Sweeper::Impl::landContact() {
  Clock::duration decoding{};
  const auto decodeOne = [&](size_t i, const Found& found) {
    const Clock::time_point start = Clock::now();
    const size_t query = flying[i];
    try {
      answers[query] = decodeContact(found, asked[query], stats.cpuPairs);
    } catch (const Error& error) {
      giveUp(query, error);
    }
    stats.pairs += found.state.boxPairs;
    stats.clusterPairs += found.state.pairCount;
    stats.solves += found.state.solved;
    decoding += Clock::now() - start;
  };
  for (const size_t i : contactRecorder.collect(contactPointers, scene.impl(), stats.stages, decodeOne)) {
    reasons[flying[i]] = "capacity: more clusters or triangles meet than a buffer of the device can list";
  }
  deviceDone = Clock::now() - decoding;
  addCpuTime("decode", std::chrono::duration<double, std::milli>(decoding).count());
}

void Sweeper::Impl::land() {
  const Flight landing = std::exchange(flight, Flight::none);
  if (landing == Flight::none) return;
  try {
    if (landing == Flight::sampled) landSampled();
    if (landing == Flight::contact) landContact();
  } catch (const Error& error) {
    for (const size_t query : flying) giveUp(query, error);
  }
}

void Sweeper::Impl::runContact(std::span<const size_t> which) {
  std::vector<size_t> slice;
  std::vector<ContactPlan> plans;
  uint64_t refs = 0;
  const auto flushSlice = [&] {
    search(slice, plans);
    slice.clear();
    plans.clear();
    refs = 0;
  };
  for (const size_t i : which) {
    const Clock::time_point start = Clock::now();
    ContactPlan plan = planContact(asked[i], scene.impl(), copy->hierarchy);
    addCpuTime("select", msSince(start));
    if (plan.scene.empty()) {
      answers[i] = decodeClear();
      continue;
    }
    // What a bounded look has met for certain; the numbers told come from the pair, whatever bounded the search.
    if (answers[i].hi < asked[i].distance) plan.hi = upward(answers[i].hi);
    refs += plan.sensor.size() + plan.scene.size();
    stats.clusters += plan.sensor.size() + plan.scene.size();
    slice.push_back(i);
    plans.push_back(std::move(plan));
    if (slice.size() == kMaxTargets || refs >= kMaxRefs) flushSlice();
  }
  flushSlice();
}

void Sweeper::Impl::sync() {
  copy->hierarchy.update(scene.impl());
  recorder.sync(scene.impl());
}

void Sweeper::Impl::begin(std::span<const Query> queries, std::span<Result> results) {
  assert(flight == Flight::none && queries.size() == results.size());
  asked = queries;
  answers = results;
  stats = {};
  reasons.clear();
  failure.reset();
  const Clock::time_point start = Clock::now();
  copy->hierarchy.update(scene.impl());
  addCpuTime("select", msSince(start));
  std::vector<size_t> sampled, bounded, contact;
  for (size_t i = 0; i < queries.size(); ++i) {
    answers[i] = Result();
    const Query& query = queries[i];
    const bool bracket = query.mode == Mode::bounded || (query.mode == Mode::contact && query.tolerance > 0);
    (query.mode == Mode::sampled ? sampled : bracket ? bounded : contact).push_back(i);
  }
  try {
    runSampled(sampled);
    for (const size_t i : runBounded(bounded)) {
      if (queries[i].mode == Mode::contact) contact.push_back(i);
    }
    runContact(contact);
  } catch (...) {
    land();  // nothing stays with the device behind an exception
    throw;
  }
  deviceDone = Clock::now();  // in case nothing went there
}

void Sweeper::Impl::finish() {
  land();
}

Sweeper::Sweeper(const Device& device, const Scene& scene, const SweeperOptions& options) {
  device.impl().requireQueue("a Sweeper");
  impl_ = std::make_unique<Impl>(device, scene, options, std::make_shared<SceneCopy>(device.impl()));
}
Sweeper::~Sweeper() = default;
Sweeper::Sweeper(Sweeper&&) noexcept = default;
Sweeper& Sweeper::operator=(Sweeper&&) noexcept = default;

void Sweeper::sync() {
  impl_->sync();
}

std::vector<Result> Sweeper::run(std::span<const Query> queries) {
  impl_->refuseWrong(queries);
  std::vector<Result> results(queries.size());
  impl_->begin(queries, results);
  impl_->finish();
  return results;
}

Scopes Sweeper::scopes(const Query& query) {
  Impl& self = *impl_;
  self.refuseWrong({&query, 1});
  self.copy->hierarchy.update(self.scene.impl());
  const ViewPlan plan =
      encode(query, self.scene.impl(), self.copy->hierarchy, self.device.properties.limits.subPixelPrecisionBits,
             self.options.select ? Drawn::wholeMask : Drawn::everything);
  if (std::string reason = self.tooLarge(plan); !reason.empty()) throw Error("scopes: " + reason);
  const ViewPlan* plans[] = {&plan};
  fill(self.batch, plans);
  StoredScopes stored;
  self.stats = {};
  self.recorder.submit(self.batch, self.scene.impl(), true);
  const Answers found = self.recorder.collect(self.batch, self.scene.impl(), self.stats.stages, &stored);

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

OuterScopes Sweeper::outerScopes(const Query& query) {
  Impl& self = *impl_;
  self.refuseWrong({&query, 1});
  self.copy->hierarchy.update(self.scene.impl());
  self.stats = {};
  return self.bounded().look(query, self.scene.impl(), self.copy->hierarchy, self.stats);
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
