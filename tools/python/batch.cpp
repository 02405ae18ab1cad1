#include "python/batch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "answer/chunk_size.h"
#include "python/errands.h"
#include "radar/displacement.h"
#include "workloads/answer_fields.h"
#include "workloads/query_fields.h"

namespace radar::python {

namespace {

using tools::AnswerMode;

// Queries of a chunk, at most: as many as a cache holds, or as occupy a device that takes less than this for each.
constexpr uint64_t kMostInCache = 1 << 14, kMostAtOnce = 1 << 17;
constexpr double kAtOnce = 0.5e-6;  // seconds
using Clock = std::chrono::steady_clock;

/// Calls `work` with parts of [0, count), on all cores if there is enough to do.
template <class Work>
void inParts(size_t count, const Work& work) {
  constexpr size_t kLeast = 2048;  // queries that take longer to convert than a thread to start
  // The number of cores takes longer to ask for than a query.
  const size_t most = count / kLeast > 1 ? std::max(1u, std::thread::hardware_concurrency()) : 1;
  const size_t parts = std::clamp<size_t>(count / kLeast, 1, most);
  std::vector<std::jthread> others;
  for (size_t i = 1; i < parts; ++i) {
    others.emplace_back([&, i] { work(i * count / parts, (i + 1) * count / parts); });
  }
  work(0, count / parts);
}

Mode modeOf(AnswerMode mode) {
  return mode == AnswerMode::sampled ? Mode::sampled : Mode::contact;
}

/// Goes through the queries in row-major order.
class Reader {
 public:
  /// Begins with query `first`. `objectsMove`: some of the scene.
  Reader(const BasedScene& scene, const BatchInput& input, size_t first, bool objectsMove)
      : scene_(scene), input_(input), objectsMove_(objectsMove), index_(input.shape.size()) {
    for (size_t d = index_.size(); d-- > 0; first /= input.shape[d]) {
      index_[d] = static_cast<ptrdiff_t>(first % input.shape[d]);
    }
  }

  /// Writes the next query over another of the batch, or over the input's options.
  void next(Query& query);

 private:
  template <class T>
  void read(const PerQuery& from, T* to, size_t count) const {
    const char* at = from.data;
    for (size_t d = 0; d < index_.size(); ++d) at += index_[d] * from.strides[d];
    std::copy_n(at, count * sizeof(T), reinterpret_cast<char*>(to));
  }
  void readOptions(Query& query) const;
  void advance() {
    for (size_t d = index_.size(); d-- > 0;) {
      if (++index_[d] < static_cast<ptrdiff_t>(input_.shape[d])) return;
      index_[d] = 0;
    }
  }

  const BasedScene& scene_;
  const BatchInput& input_;
  bool objectsMove_;
  std::vector<ptrdiff_t> index_;
  std::vector<int64_t> excluded_;
};

void Reader::readOptions(Query& query) const {
  const auto readOptional = [&](const PerQuery& from, std::optional<double>& to) {
    if (!from.data) return;
    double value = 0;
    read(from, &value, 1);
    to = std::isnan(value) ? std::optional<double>() : value;
  };
  if (input_.leaving.data) read(input_.leaving, &query.ignoreLeaving, 1);
  readOptional(input_.slacks, query.slack);
  readOptional(input_.tolerances, query.tolerance);
  double clearance = input_.options.clearance;
  if (input_.clearances.data) read(input_.clearances, &clearance, 1);
  query.clearance = tools::withRadius(clearance, scene_.radius(query.mesh));
  if (!input_.hits.data) return;
  read(input_.hits, &query.hits, 1);
  if (query.hits == 0) query.hits = kAllHits;
}

void Reader::next(Query& query) {
  read(input_.meshes, &query.mesh, 1);
  read(input_.poses, query.worldFromMesh.m.data(), 12);
  query.worldFromMesh = scene_.placed(query.mesh, query.worldFromMesh);
  read(input_.masks, &query.mask, 1);
  std::array<double, 3> way;
  read(input_.displacements, way.data(), 3);
  readOptions(query);
  if (input_.axes.data) {
    Turn& turn = query.turn.emplace();
    read(input_.axes, turn.axis.data(), 3);
    read(input_.angles, &turn.angle, 1);
    read(input_.centres, turn.centre.data(), 3);
    query.motion = way;
  } else if (input_.distances.data) {
    query.direction = way;
    read(input_.distances, &query.distance, 1);
  } else {
    setDisplacement(query, way, modeOf(input_.mode), objectsMove_);
  }
  excluded_.resize(input_.excludedCount);
  read(input_.excluded, excluded_.data(), excluded_.size());
  query.exclude.clear();
  for (const int64_t object : excluded_) {
    if (object >= 0) query.exclude.push_back(static_cast<ObjectId>(object));
  }
  advance();
}

/// A query's broken contract in the words of the arguments; empty if it is kept.
std::string wrongWith(const Query& query, const Scene& scene, AnswerMode mode) {
  std::string wrong = validate(query, scene, modeOf(mode));
  for (const auto& [engine, argument] : {std::pair{"sensor: ", "poses: "}, std::pair{"direction: ", "displacements: "},
                                         std::pair{"motion: ", "displacements: "},
                                         std::pair{"distance: ", "distances: "}, std::pair{"turn: ", "turns: "}}) {
    if (wrong.rfind(engine, 0) == 0) wrong = argument + wrong.substr(std::strlen(engine));
  }
  return tools::inOptions(wrong);
}

/// Answers the queries; those that break their contracts become invalid, with a reason.
void answer(CastingScene& scene, const std::vector<Query>& queries, Answers& all, AnswerMode mode,
            const std::stop_token& stop) {
  try {
    return scene.answerer().run(queries, all, mode, stop);
  } catch (const Error&) {
    all = {};
    for (size_t i = 0; i < queries.size(); ++i) {
      if (std::string wrong = wrongWith(queries[i], scene.scene(), mode); !wrong.empty()) {
        all.reasons[i] = std::move(wrong);
      }
    }
    if (all.reasons.empty()) throw;
  }
  std::vector<Query> valid;
  std::vector<size_t> numbers;
  for (size_t i = 0; i < queries.size(); ++i) {
    if (all.reasons.contains(i)) continue;
    numbers.push_back(i);
    valid.push_back(queries[i]);
  }
  Answers some = scene.answerer().run(valid, mode, stop);
  all.results.resize(queries.size());
  if (!some.lists.empty()) all.lists.resize(queries.size());
  for (size_t i = 0; i < numbers.size(); ++i) all.results[numbers[i]] = some.results[i];
  for (size_t i = 0; i < some.lists.size(); ++i) all.lists[numbers[i]] = std::move(some.lists[i]);
  for (const auto& [i, reason] : some.reasons) all.reasons[numbers[i]] = reason;
}

void append(BatchLists& to, const Listed& listed, const Query& query) {
  const tools::AnswerLayout& layout = tools::castsLayout(false);
  const auto appendRecord = [&](std::string& records, const Result& result) {
    records.resize(records.size() + layout.size);
    layout.write({query, result, AnswerMode::contact}, &records[records.size() - layout.size]);
  };
  for (const Result& hit : listed.hits) appendRecord(to.hits, hit);
  if (query.closest) {
    // An invalid query has no lists.
    const Closest closest = listed.closest.value_or(Closest{NAN, NAN, Result()});
    to.distanceLo.push_back(closest.lo);
    to.distanceHi.push_back(closest.hi);
    appendRecord(to.closest, closest.at);
  }
  if (query.exit) appendRecord(to.exits, listed.exit.value_or(Result()));
  to.hitOffsets.push_back(static_cast<int64_t>(to.hits.size() / layout.size));
  to.overlapping.insert(to.overlapping.end(), listed.overlapping.begin(), listed.overlapping.end());
  to.overlappingOffsets.push_back(static_cast<int64_t>(to.overlapping.size()));
}

}  // namespace

size_t BatchInput::count() const {
  size_t count = 1;
  for (const size_t length : shape) count *= length;
  return count;
}

BatchLists cast(CastingScene& scene, const BatchInput& input, char* records, const std::function<void()>& look,
                const std::function<void(size_t)>& afterChunk) {
  BatchLists lists;
  const bool listing = hasLists(input.options);
  const bool objectsMove = scene.moves();
  const tools::AnswerLayout& layout = tools::castsLayout(input.mode == AnswerMode::sampled);
  const size_t count = input.count();
  std::vector<Query> queries;
  Answers answers;
  // Between two chunks progress is reported.
  tools::ChunkSize chunk{.seconds = 0.2, .next = 64, .least = 1, .most = kMostInCache};
  for (size_t first = 0; first < count;) {
    const Clock::time_point start = Clock::now();
    const size_t end = std::min(first + chunk.next, count);
    queries.resize(end - first, input.options);
    inParts(end - first, [&](size_t from, size_t to) {
      Reader reader(scene.based(), input, first + from, objectsMove);
      for (size_t i = from; i < to; ++i) reader.next(queries[i]);
    });
    runUnless(look, [&](const std::stop_token& stop) { answer(scene, queries, answers, input.mode, stop); });
    inParts(end - first, [&](size_t from, size_t to) {
      for (size_t i = from; i < to; ++i) {
        layout.write({queries[i], answers.results[i], input.mode}, records + layout.size * (first + i));
      }
    });
    for (const auto& [i, reason] : answers.reasons) lists.reasons[reason].push_back(static_cast<int64_t>(first + i));
    if (listing) answers.lists.resize(queries.size());  // there are none if no query is valid
    for (size_t i = 0; i < answers.lists.size(); ++i) append(lists, answers.lists[i], queries[i]);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    chunk.most = seconds < kAtOnce * double(end - first) ? kMostAtOnce : kMostInCache;
    chunk.answered(end - first, seconds);
    first = end;
    afterChunk(first);
  }
  return lists;
}

}  // namespace radar::python
