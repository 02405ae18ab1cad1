#include "sweep/contact_runner.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "contact/decode.h"
#include "cpu/clearance.h"
#include "gpu/api.h"
#include "query/route.h"
#include "query/swept.h"
#include "scene/parallel.h"
#include "sweep/proof.h"

namespace radar {

namespace {

// Searches of one submission, at most: what a device has in hand while the next ones are planned.
constexpr size_t kMostSearches = 1u << 14;
// Batches of fewer queries are answered on the CPU. A device that runs there itself is slower than its search, whatever
// the batch (docs/performance.md). On another, a submission takes the time in which a CPU answers some queries: an
// estimate, as no such device has been measured.
constexpr uint32_t kCpuBatchOnCpu = kNone, kCpuBatchElsewhere = 16;
// Pairs that are left to the host: more of one search are dearer to decide than to search again.
constexpr size_t kMostDecided = 256;

// Of one submission: what a texel buffer of their sensors holds.
size_t mostSearchesOf(const Device::Impl& device) {
  return std::min<size_t>(kMostSearches, device.properties.limits.maxTexelBufferElements / gpu::kSensorTexels);
}

uint32_t cpuBatchOf(const SweeperOptions& options, const Device::Impl& device) {
  if (options.cpuBatch != kNone) return options.cpuBatch;
  return device.runsOnCpu() ? kCpuBatchOnCpu : kCpuBatchElsewhere;
}

}  // namespace

ContactRunner::ContactRunner(const gpu::Owner& owner, const Scene& scene, const SweeperOptions& options,
                             GpuScene& resident, const SearchRoom& room, bool needsProof)
    : owner_(owner),
      device_(owner),
      scene_(scene),
      options_(options),
      resident_(resident),
      room_(room),
      mostSearches_(mostSearchesOf(owner)),
      cpu_(Tier::contact, options.cpuThreads) {
  if (needsProof && !isOnCpu()) requireProof(owner);
}

bool ContactRunner::isOnCpu() const {
  return cpuBatchOf(options_, device_) == kNone;
}

void ContactRunner::begin(Flight& flight) {
  std::vector<size_t> all(flight.queries.size());
  std::iota(all.begin(), all.end(), size_t{0});
  flight.answers.stats.lost = lost_;
  plan(flight, all);
  answerLeft(flight);
}

void ContactRunner::finish(Flight& flight) {
  collect(flight);
  while (!flight.again.empty()) {
    plan(flight, std::exchange(flight.again, {}));
    collect(flight);
  }
  answerLeft(flight);
}

void ContactRunner::abandon(Flight& flight) noexcept {
  flight.planned = {};
  flight.left.clear();
  flight.again.clear();
  if (std::exchange(flight.submitted, {}).empty()) return;
  try {
    submitter_->wait();
  } catch (const std::exception&) {  // the exception that was first is the one to report
  }
}

void ContactRunner::plan(Flight& flight, std::span<const size_t> which) {
  if (!lost_.empty() || which.size() < cpuBatchOf(options_, device_)) {
    flight.left.insert(flight.left.end(), which.begin(), which.end());
    return;
  }
  const Clock::time_point begun = Clock::now();
  const ObjectTree& tree = scene_.impl().objectTree();
  flight.addCpuTime("select", msSince(begun));
  flight.encoding = Clock::now();
  for (const size_t query : which) {
    throwIfStopped(flight.stop);
    if (!planQuery(flight, query, tree)) flight.left.push_back(query);
  }
  submit(flight);
}

bool ContactRunner::planQuery(Flight& flight, size_t query, const ObjectTree& tree) {
  const Query& asked = flight.queries[query];
  const Scene::Impl& scene = scene_.impl();
  const Route route = routeOf(asked, scene, true);
  if (route == Route::cpu || !tree.inRange()) return false;
  std::vector<ObjectId> objects{kNone};
  if (route == Route::searchEach) objects = inReach(asked, scene, tree, roomyBox(asked, scene));
  if (objects.size() > mostSearches_) return false;
  if (flight.planned.count() + objects.size() > mostSearches_) submit(flight);
  SearchPlan& searches = flight.planned;
  const uint32_t first = searches.count();
  for (const ObjectId object : objects) {
    if (searches.add(asked, searches.count(), scene, tree, object) != Planned::outOfRange) continue;
    searches.truncate(first);
    return false;
  }
  if (!searches.group(query, first)) flight.answers.results[query] = clearAnswer();
  return true;
}

template <class Step>
bool ContactRunner::attempt(Flight& flight, std::span<const SearchPlan::Group> groups, const Step& step) {
  const auto leave = [&] {
    for (const SearchPlan::Group& group : groups) flight.left.push_back(group.query);
  };
  try {
    step();
    return true;
  } catch (const gpu::LimitError&) {
    leave();
  } catch (const Error& error) {
    if (flight.survives(error)) {
      if (gpu::isLost(error)) flight.answers.stats.lost = lost_ = error.what();
      leave();
    } else {
      for (const SearchPlan::Group& group : groups) flight.fail(group.query, error);
    }
  }
  return false;
}

void ContactRunner::submit(Flight& flight) {
  flight.addCpuTime("encode", msSince(flight.encoding));
  SearchPlan planned = std::exchange(flight.planned, {});
  if (planned.groups.empty()) return;
  collect(flight);
  const bool isSubmitted = attempt(flight, planned.groups, [&] {
    if (!submitter_) submitter_.emplace(owner_, resident_, options_.timestamps, room_);
    try {
      submitter_->submit(planned, scene_.impl());
    } catch (const Error& error) {
      if (gpu::isOutOfMemory(error)) submitter_.reset();  // its lists may have grown too large
      throw;
    }
  });
  if (isSubmitted) flight.submitted = std::move(planned.groups);
  flight.encoding = Clock::now();
}

void ContactRunner::collect(Flight& flight) {
  const std::vector<SearchPlan::Group> groups = std::exchange(flight.submitted, {});
  if (groups.empty()) return;
  attempt(flight, groups, [&] {
    const SearchAnswers found = submitter_->collect(flight.answers.stats.stages, flight.stop);
    flight.deviceDone = Clock::now();
    flight.answers.stats.submissions += submitter_->submissions();
    flight.answers.stats.pairs += found.trianglePairs;
    decode(flight, found, groups);
    flight.addCpuTime("decode", msSince(flight.deviceDone));
  });
}

void ContactRunner::decode(Flight& flight, const SearchAnswers& found, std::span<const SearchPlan::Group> groups) {
  const Scene::Impl& scene = scene_.impl();
  std::vector<Result> results(found.results.begin(), found.results.end());
  for (const Result& result : results) {
    if (result.flags != 0 || result.status != Status::invalid) continue;
    throw Error(Error::Kind::internal, "the contact search lost a certain contact");
  }
  const Deciding how{*resident_.farthest(), kMostDecided, options_.cpuThreads, flight.stop};
  flight.answers.stats.cpuPairs += decideAll(found.unresolved, how, [&](uint32_t search, ObjectId object) {
    const Query& query = flight.queries[groupOf(groups, search).query];
    return OpenSearch{results[search], query, Course(query, scene).past(object),
                      cpu::toleranceOf(query, scene.meshes[query.mesh])};
  });
  for (const SearchPlan::Group& group : groups) {
    const Query& query = flight.queries[group.query];
    const auto searches = std::span(results).subspan(group.first, group.count);
    const bool lacksRoom = found.roomier && std::any_of(searches.begin(), searches.end(), [](const Result& result) {
                             return result.flags == Flag::candidates;
                           });
    if (auto answer = certainAnswer(query, scene, searches)) {
      flight.answers.results[group.query] = answer->first;
      if (query.hits > 1) flight.answers.lists[group.query].hits = std::move(answer->hits);
    } else {
      (lacksRoom ? flight.again : flight.left).push_back(group.query);
    }
  }
}

void ContactRunner::answerLeft(Flight& flight) {
  std::vector<size_t> left = std::exchange(flight.left, {});
  if (left.empty()) return;
  std::sort(left.begin(), left.end());
  const Clock::time_point start = Clock::now();
  Answers& answers = flight.answers;
  const size_t first = left.front(), count = left.size();
  const uint64_t before = cpu_.pairs();
  if (left.back() - first + 1 == count) {  // without gaps
    cpu_.run(flight.queries.subspan(first, count), scene_.impl(), std::span(answers.results).subspan(first, count),
             answers.lists.empty() ? std::span<Listed>() : std::span(answers.lists).subspan(first, count), flight.stop);
  } else {
    std::vector<Query> queries;
    queries.reserve(count);
    for (const size_t i : left) queries.push_back(flight.queries[i]);
    Answers found = unanswered(queries);
    cpu_.run(queries, scene_.impl(), found.results, found.lists, flight.stop);
    for (size_t k = 0; k < count; ++k) answers.results[left[k]] = found.results[k];
    for (size_t k = 0; k < found.lists.size(); ++k) answers.lists[left[k]] = std::move(found.lists[k]);
  }
  const uint64_t pairs = cpu_.pairs() - before;
  answers.stats.pairs += pairs;
  answers.stats.cpuPairs += pairs;
  answers.stats.cpuQueries += count;
  flight.addCpuTime("cpu", msSince(start));
}

}  // namespace radar
