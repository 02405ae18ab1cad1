#include "sweep/contact_tier.h"

#include <algorithm>
#include <utility>

#include "cpu/clearance.h"
#include "gpu/check.h"
#include "scene/parallel.h"
#include "sweep/known_answers.h"

namespace radar {

namespace {

// Sensors of one submission, at most: what a device has in hand while the next ones are planned.
constexpr size_t kMostSensors = 1u << 14;
// Batches of fewer queries are answered on the CPU. A device that runs there itself is slower than its search, whatever
// the batch (docs/benchmarks.md). On another, a submission takes the time in which a CPU answers some queries: an
// estimate, as no such device has been measured.
constexpr uint32_t kCpuBatchOnCpu = kNone, kCpuBatchElsewhere = 16;
// Pairs that are left to the host: more of one sensor are dearer to decide than to search again.
constexpr size_t kMostDecided = 256;

// Of one submission: what a texel buffer of sensors holds.
size_t mostSensorsOf(const Device::Impl& device) {
  return std::min<size_t>(kMostSensors, device.properties.limits.maxTexelBufferElements / gpu::kSensorTexels);
}

bool isDecidable(std::span<const gpu::UnresolvedPair* const> pairs) {
  return !pairs.empty() && pairs.size() <= kMostDecided;
}

uint32_t cpuBatchOf(const SweeperOptions& options, const Device::Impl& device) {
  if (options.cpuBatch != kNone) return options.cpuBatch;
  return device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU ? kCpuBatchOnCpu : kCpuBatchElsewhere;
}

}  // namespace

ContactTier::ContactTier(const Device::Impl& device, const Scene& scene, const SweeperOptions& options,
                         GpuScene& resident, const SearchRoom& room, bool needsProof, QueryBatch& batch)
    : device_(device),
      scene_(scene),
      options_(options),
      resident_(resident),
      room_(room),
      mostSensors_(mostSensorsOf(device)),
      batch_(batch),
      pending_(batch) {
  if (needsProof && !isOnCpu()) requireProof(device);
}

void ContactTier::answerOnCpu(std::span<const size_t> which) {
  if (which.empty()) return;
  const Clock::time_point start = Clock::now();
  const Scene::Impl& scene = scene_.impl();
  const size_t first = which.front(), count = which.size();
  if (which.back() - first + 1 == count) {  // ascending, and so without gaps
    cpu_.run(batch_.asked.subspan(first, count), scene, Tier::contact, options_.cpuThreads,
             batch_.answers.subspan(first, count),
             batch_.lists.empty() ? std::span<QueryLists>() : std::span(batch_.lists).subspan(first, count));
  } else {
    std::vector<Query> queries;
    queries.reserve(count);
    for (const size_t i : which) queries.push_back(batch_.asked[i]);
    std::vector<Result> results(count);
    std::vector<QueryLists> lists = listsFor(queries);
    cpu_.run(queries, scene, Tier::contact, options_.cpuThreads, results, lists);
    for (size_t k = 0; k < count; ++k) batch_.answers[which[k]] = results[k];
    for (size_t k = 0; k < lists.size(); ++k) batch_.lists[which[k]] = std::move(lists[k]);
  }
  batch_.stats.cpuQueries += count;
  batch_.addCpuTime("cpu", msSince(start));
}

void ContactTier::leaveToCpu(std::vector<size_t> queries) {
  std::erase_if(queries, [&](size_t query) {
    if (!searchesEach(batch_.asked[query], scene_.impl())) return false;
    lists_.giveUp(query);  // other searches of it may still be under way
    return true;
  });
  std::sort(queries.begin(), queries.end());
  answerOnCpu(queries);
}

bool ContactTier::isOnCpu() const {
  return cpuBatchOf(options_, device_) == kNone;
}

void ContactTier::begin() {
  planned_.clear();
  sensors_.clear();
  lists_ = {};
  cramped_.clear();
}

void ContactTier::run(std::span<const size_t> which) {
  if (which.empty()) return;
  if (which.size() < cpuBatchOf(options_, device_)) return answerOnCpu(which);
  const Clock::time_point begun = Clock::now();
  const ObjectTree& tree = scene_.impl().objectTree();
  batch_.addCpuTime("select", msSince(begun));
  std::vector<size_t> onlyCpu;
  encoding_ = Clock::now();
  for (const size_t i : which) {
    if (!plan(i, tree)) onlyCpu.push_back(i);
  }
  submit();
  answerOnCpu(onlyCpu);
}

bool ContactTier::plan(size_t query, const ObjectTree& tree) {
  const Query& asked = batch_.asked[query];
  const Scene::Impl& scene = scene_.impl();
  if (combinesClearance(asked, scene)) return false;
  if (!searchesEach(asked, scene)) {
    const Planned planned = planOne(query, kNone, tree);
    if (planned == Planned::clear) batch_.answers[query] = clearAnswer();
    return planned != Planned::outOfRange;
  }
  if (!tree.inRange()) return false;
  lists_.begin(query);
  for (const ObjectId object : reach_.inReach(asked, scene, tree)) {
    if (planOne(query, object, tree) == Planned::outOfRange) {
      lists_.giveUp(query);
      break;
    }
  }
  return true;
}

Planned ContactTier::planOne(size_t query, ObjectId object, const ObjectTree& tree) {
  const Planned planned =
      addSensor(sensors_, batch_.asked[query], static_cast<uint32_t>(planned_.size()), scene_.impl(), tree, object);
  if (planned == Planned::added) planned_.push_back(query);
  if (planned_.size() == mostSensors_) submit();
  return planned;
}

void ContactTier::submit() {
  batch_.addCpuTime("encode", msSince(encoding_));
  if (planned_.empty()) return;
  collect();
  pending_.submit(std::exchange(planned_, {}), [&](std::span<const size_t> queries) {
    try {
      if (!submitter_) submitter_.emplace(device_, resident_, options_.timestamps, room_);
      submitter_->submit(sensors_, scene_.impl());
      return true;
    } catch (const gpu::LimitError&) {
      leaveToCpu({queries.begin(), queries.end()});
      return false;
    } catch (const Error& error) {
      if (!batch_.survives(error)) throw;
      submitter_.reset();  // its lists may have grown too large
      leaveToCpu({queries.begin(), queries.end()});
      return false;
    }
  });
  sensors_.clear();
  encoding_ = Clock::now();
}

void ContactTier::finish() {
  try {
    collect();
    while (!cramped_.empty()) {
      const std::vector<size_t> again = std::exchange(cramped_, {});
      run(again);
      collect();
    }
  } catch (...) {
    // Nothing stays with the device behind an exception.
    pending_.collect([&](auto) { submitter_->collect(scene_.impl(), batch_.stats.stages); });
    throw;
  }
  finishLists();
}

void ContactTier::finishLists() {
  std::vector<size_t> onlyCpu;
  lists_.finish(
      batch_.asked,
      [&](size_t query, std::vector<Result> hits) {
        if (batch_.reasons.contains(query)) return;
        const Query& asked = batch_.asked[query];
        if (isStep(asked, scene_.impl()) && !asked.motion) {
          for (Result& hit : hits) cpu::toDistances(hit, asked.distance);
        }
        batch_.answers[query] = hits.empty() ? clearAnswer() : hits.front();
        if (asked.hits > 1) batch_.lists[query].hits = std::move(hits);
      },
      [&](size_t query) {
        if (!batch_.reasons.contains(query)) onlyCpu.push_back(query);
      });
  answerOnCpu(onlyCpu);
}

bool ContactTier::keep(size_t query, const Result& found) {
  const Query& asked = batch_.asked[query];
  // The CPU finds the least pair of triangles that are that near at the start.
  if (asked.clearance > 0 && found.status == Status::overlap && found.object == kNone) return false;
  // What is certain on the device may have kept the search from other pairs.
  if (asked.clearance > 0 && found.status == Status::undecided) return false;
  // In a bracket that rounding keeps wide, other pairs may begin than those that the CPU's search comes across.
  const Mesh& sensor = scene_.impl().meshes[asked.mesh];
  const bool isWide = asked.clearance > 0 && !(found.hi - found.lo <= cpu::toleranceOf(asked, sensor));
  if (isWide && found.status == Status::hit && !asked.anyHit) return false;
  // What meets at the start may cross, and then takes no part.
  const bool mayCross = found.status == Status::overlap || (asked.anyHit && found.status == Status::hit);
  if (asked.skipOverlapping && mayCross) return false;
  if (searchesEach(asked, scene_.impl())) {
    lists_.add(query, found);
  } else {
    batch_.answers[query] = found;
  }
  return true;
}

void ContactTier::collect() {
  pending_.collect([&](std::span<const size_t> queries) {
    SearchAnswers found;
    try {
      found = submitter_->collect(scene_.impl(), batch_.stats.stages);
    } catch (const Error& error) {
      if (!batch_.survives(error)) throw;
      return leaveToCpu({queries.begin(), queries.end()});
    }
    batch_.deviceDone = Clock::now();
    batch_.stats.submissions += submitter_->submissions();
    batch_.stats.pairs += found.trianglePairs;
    decode(found, queries);
    batch_.addCpuTime("decode", msSince(batch_.deviceDone));
  });
}

void ContactTier::decode(const SearchAnswers& found, std::span<const size_t> queries) {
  const Scene::Impl& scene = scene_.impl();
  const UnresolvedPairs unresolved(found.unresolved);
  std::vector<uint32_t> open;
  std::vector<size_t> left;
  for (uint32_t i = 0; i < queries.size(); ++i) {
    const Result& result = found.results[i];
    if (result.flags == 0 && result.status != Status::invalid) {
      if (!keep(queries[i], result)) left.push_back(queries[i]);
    } else if (result.flags == 0) {
      throw Error("the contact search lost a certain contact", VK_ERROR_UNKNOWN);
    } else if (result.flags == kFlagUnresolved && isDecidable(unresolved.of(i))) {
      open.push_back(i);
    } else if (found.roomier && result.flags == kFlagCandidates && !searchesEach(batch_.asked[queries[i]], scene)) {
      cramped_.push_back(queries[i]);
    } else {
      left.push_back(queries[i]);
    }
  }
  std::vector<Result> decided(open.size());
  parallelFor(open.size(), 16, options_.cpuThreads, [&](unsigned, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      const uint32_t i = open[k];
      const Query& asked = batch_.asked[queries[i]];
      const auto pairs = unresolved.of(i);
      const Motion motion = motionPast(asked, scene, pairs.front()->object);
      const double tolerance = cpu::toleranceOf(asked, scene.meshes[asked.mesh]);
      decided[k] = decideUnresolved(found.results[i], pairs, asked, motion, tolerance, *resident_.farthest());
    }
  });
  for (size_t k = 0; k < open.size(); ++k) {
    batch_.stats.cpuPairs += unresolved.of(open[k]).size();
    if (!keep(queries[open[k]], decided[k])) left.push_back(queries[open[k]]);
  }
  leaveToCpu(std::move(left));
}

}  // namespace radar
