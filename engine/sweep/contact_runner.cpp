#include "sweep/contact_runner.h"

#include <algorithm>
#include <array>
#include <functional>
#include <mutex>
#include <numeric>
#include <utility>

#include "contact/decode.h"
#include "cpu/clearance.h"
#include "gpu/api.h"
#include "query/swept.h"
#include "scene/parallel.h"
#include "sweep/proof.h"

namespace radar {

namespace {

// Queries that take as long to look at, or their answers to decode, as a thread to wake.
constexpr size_t kWorthThread = 2048;
// Pairs that are left to the host: more of one search are dearer to decide than to search again.
constexpr size_t kMostDecided = 256;

// Of one submission: what a texel buffer of their sensors holds.
size_t mostSearchesOf(const Device::Impl& device, const SearchTuning& tuning) {
  return std::min(tunedFor(device, tuning).searches,
                  device.properties.limits.maxTexelBufferElements / gpu::kSensorTexels);
}

// No answer, though no list was full.
bool isMissing(const Result& result) {
  return result.flags == 0 && result.status == Status::invalid;
}

}  // namespace

ContactRunner::ContactRunner(const gpu::Owner& owner, const Scene& scene, const SweeperOptions& options,
                             GpuScene& resident, const SearchTuning& tuning, bool needsProof)
    : owner_(owner),
      device_(owner),
      scene_(scene),
      options_(options),
      resident_(resident),
      tuning_(tuning),
      mostSearches_(mostSearchesOf(owner, tuning)),
      cpu_(Tier::contact, options.cpuThreads) {
  if (needsProof && !isOnCpu()) requireProof(owner);
}

bool ContactRunner::isOnCpu() const {
  // A device that runs there itself is slower than its search, whatever the batch (docs/performance.md).
  return options_.cpuBatch == kNone && device_.runsOnCpu();
}

std::span<SearchNeeds> ContactRunner::needsOf(size_t queries) {
  needs_.resize(queries);
  return needs_;
}

void ContactRunner::begin(Flight& flight) {
  if (flight.needs.empty()) {
    flight.needs = needsOf(flight.queries.size());
    parallelFor(flight.queries.size(), kWorthThread, options_.cpuThreads, [&](unsigned, size_t from, size_t to) {
      for (size_t i = from; i < to; ++i) needs_[i] = SearchNeeds(flight.queries[i], scene_.impl());
    });
  }
  open_.assign(flight.queries.size(), 1);
  flight.open = open_;
  all_.resize(flight.queries.size());
  std::iota(all_.begin(), all_.end(), size_t{0});
  flight.answers.stats.lost = lost_;
  plan(flight, all_);
  answerLeft(flight);
}

void ContactRunner::finish(Flight& flight) {
  collect(flight);
  while (!flight.again.empty()) {
    plan(flight, std::exchange(flight.again, {}));
    collect(flight);
  }
  answerLeft(flight);
  flight.open = {};
}

void ContactRunner::abandon(Flight& flight) noexcept {
  planned_.clear();
  flight.left.clear();
  flight.again.clear();
  for (size_t i = 0; i < flight.open.size(); ++i) {
    if (flight.open[i] != 0) flight.answers.results[i] = Result();
  }
  flight.open = {};
  if (submitted_.empty()) return;
  submitted_.clear();
  try {
    submitter_->wait();
  } catch (const std::exception&) {  // the exception that was first is the one to report
  }
}

void ContactRunner::plan(Flight& flight, std::span<const size_t> which) {
  if (!lost_.empty() || which.size() < flight.cpuBatch) {
    flight.left.insert(flight.left.end(), which.begin(), which.end());
    return;
  }
  const Clock::time_point begun = Clock::now();
  const ObjectTree& tree = scene_.impl().objectTree();
  flight.addCpuTime("select", msSince(begun));
  flight.encoding = Clock::now();
  planned_.reserve(std::min(which.size(), mostSearches_));
  for (const size_t query : which) {
    throwIfStopped(flight.stop);
    if (!planQuery(flight, query, tree)) flight.left.push_back(query);
  }
  submit(flight);
}

bool ContactRunner::planQuery(Flight& flight, size_t query, const ObjectTree& tree) {
  static constexpr std::array kAll{kNone};
  const SearchNeeds& needs = flight.needs[query];
  if (needs.route == Route::cpu || !tree.inRange()) return false;
  std::vector<ObjectId> inReachOfIt;
  std::span<const ObjectId> objects = kAll;
  if (needs.route == Route::searchEach) {
    const Query& asked = flight.queries[query];
    objects = inReachOfIt = inReach(asked, scene_.impl(), tree, roomyBox(asked, scene_.impl()));
  }
  if (objects.size() > mostSearches_) return false;
  if (objects.empty() || tree.nodes().empty()) {
    flight.answers.results[query] = clearAnswer();
    flight.open[query] = 0;
    return true;
  }
  if (planned_.count() + objects.size() > mostSearches_) submit(flight);
  planned_.add(flight.queries, query, needs, objects);
  return true;
}

template <class Step>
bool ContactRunner::attempt(Flight& flight, std::span<const SearchGroup> groups, const Step& step) {
  const auto leave = [&] {
    for (const SearchGroup& group : groups) flight.left.push_back(group.query);
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
      for (const SearchGroup& group : groups) flight.fail(group.query, error);
    }
  }
  return false;
}

void ContactRunner::submit(Flight& flight) {
  if (planned_.groups().empty()) return flight.addCpuTime("plan", msSince(flight.encoding));
  flight.addCpuTime("plan", msSince(flight.encoding));
  // The device goes on while the last submission's answers are decoded.
  last_.swap(submitted_);
  submitted_.clear();
  const std::optional<SearchAnswers> found = wait(flight, last_);
  submitted_.reserve(planned_.groups().size());  // once the device works, nothing may fail before it is known
  const Clock::time_point begun = Clock::now();
  bool isTooLarge = false;
  const bool isSubmitted = attempt(flight, planned_.groups(), [&] {
    if (!submitter_) submitter_.emplace(owner_, resident_, options_.timestamps, tuning_);
    try {
      const Scene::Impl& scene = scene_.impl();
      submitter_->submit(planned_.source({flight.queries, &scene, options_.cpuThreads}), scene);
    } catch (const Error& error) {
      isTooLarge = gpu::isOutOfMemory(error);
      throw;
    }
  });
  if (isSubmitted) submitted_.assign(planned_.groups().begin(), planned_.groups().end());
  flight.addCpuTime("submit", msSince(begun));
  planned_.clear();
  if (found) decode(flight, *found, last_);
  if (isTooLarge) submitter_.reset();  // its lists may have grown too large
  flight.encoding = Clock::now();
}

std::optional<SearchAnswers> ContactRunner::wait(Flight& flight, std::span<const SearchGroup> groups) {
  std::optional<SearchAnswers> found;
  if (groups.empty()) return found;
  attempt(flight, groups, [&] {
    found = submitter_->collect(flight.answers.stats.stages, flight.stop);
    flight.deviceDone = Clock::now();
    flight.answers.stats.submissions += submitter_->submissions();
    flight.answers.stats.pairs += found->trianglePairs;
  });
  return found;
}

void ContactRunner::collect(Flight& flight) {
  last_.swap(submitted_);
  submitted_.clear();
  if (const auto found = wait(flight, last_)) decode(flight, *found, last_);
}

void ContactRunner::decode(Flight& flight, const SearchAnswers& found, std::span<const SearchGroup> groups) {
  const Clock::time_point begun = Clock::now();
  attempt(flight, groups, [&] {
    const Scene::Impl& scene = scene_.impl();
    const Deciding how{*resident_.farthest(), kMostDecided, options_.cpuThreads, flight.stop};
    const auto ask = [&](uint32_t search, ObjectId object) {
      const Query& query = flight.queries[groupOf(groups, search).query];
      return OpenSearch{found.results[search], query, Course(query, scene).past(object),
                        cpu::toleranceOf(query, scene.meshes[query.mesh])};
    };
    flight.answers.stats.cpuPairs += decideAll(found.unresolved, how, std::cref(ask));  // copied, it would be allocated
    std::mutex open;
    std::vector<size_t> again, left;
    parallelFor(groups.size(), kWorthThread, options_.cpuThreads, [&](unsigned, size_t from, size_t to) {
      for (const SearchGroup& group : groups.subspan(from, to - from)) {
        const auto searches = found.results.subspan(group.first, group.count);
        if (std::ranges::any_of(searches, isMissing)) {
          throw Error(Error::Kind::internal, "the contact search lost a certain contact");
        }
        if (answerGroup(flight, group, searches)) continue;
        const bool lacksRoom = found.roomier && std::ranges::any_of(searches, [](const Result& result) {
                                 return result.flags == Flag::candidates;
                               });
        const std::scoped_lock lock(open);
        (lacksRoom ? again : left).push_back(group.query);
      }
    });
    flight.again.insert(flight.again.end(), again.begin(), again.end());
    flight.left.insert(flight.left.end(), left.begin(), left.end());
  });
  flight.addCpuTime("decode", msSince(begun));
}

bool ContactRunner::answerGroup(Flight& flight, const SearchGroup& group, std::span<const Result> searches) {
  Answers& answers = flight.answers;
  Result& answer = answers.results[group.query];
  bool isAnswered = false;
  if (flight.needs[group.query].isPlain) {
    isAnswered = searches[0].flags == 0;
    if (isAnswered) answer = searches[0];
  } else {
    std::vector<Result> none;
    isAnswered = answerFrom(searches, flight.queries[group.query], scene_.impl(), answer,
                            answers.lists.empty() ? none : answers.lists[group.query].hits);
  }
  if (isAnswered) flight.open[group.query] = 0;
  return isAnswered;
}

void ContactRunner::answerLeft(Flight& flight) {
  std::vector<size_t> left = std::exchange(flight.left, {});
  if (left.empty()) return;
  if (!std::ranges::is_sorted(left)) std::ranges::sort(left);
  const Clock::time_point start = Clock::now();
  Answers& answers = flight.answers;
  parallelFor(left.size(), kWorthThread, options_.cpuThreads, [&](unsigned, size_t from, size_t to) {
    for (const size_t i : std::span(left).subspan(from, to - from)) {
      answers.results[i] = Result();
      flight.open[i] = 0;
    }
  });
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
