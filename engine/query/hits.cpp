#include "query/hits.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "query/cancelled.h"
#include "scene/parallel.h"

namespace radar {

namespace {

// Results that take as long to clear as a thread to wake.
constexpr size_t kWorthThread = 4096;

// A decision; then answers that are missing, which may hide an earlier contact; then t or, if that is open, lo.
std::tuple<int, double> keyOf(const Result& result) {
  if (result.status == Status::invalid) return {1, 0};
  if (result.status == Status::undecided) return {2, result.lo};
  const bool isDecision = result.status == Status::hit && result.object == kNone;
  return isDecision ? std::tuple(0, 0.0) : std::tuple(2, result.t);
}

// Brackets that meet leave the order open, unless both times are exact: at the start or at D.
bool isOrdered(const Result& p, const Result& q) {
  return p.hi < q.lo || (p.lo == p.hi && q.lo == q.hi);
}

}  // namespace

void makeRoom(size_t count, bool lists, Answers& answers) {
  answers.results.resize(count);
  answers.lists.resize(lists ? count : 0);
  for (Listed& listed : answers.lists) {
    listed.hits.clear();
    listed.overlapping.clear();
    listed.closest.reset();
    listed.exit.reset();
  }
  answers.reasons.clear();
  answers.stats = {};
}

void clearFor(std::span<const Query> queries, unsigned threads, Answers& answers) {
  const size_t before = std::min(answers.results.size(), queries.size());
  makeRoom(queries.size(), std::ranges::any_of(queries, hasLists), answers);
  parallelFor(before, kWorthThread, threads, [&](unsigned, size_t first, size_t last) {
    std::fill(answers.results.begin() + ptrdiff_t(first), answers.results.begin() + ptrdiff_t(last), Result());
  });
}

Answers unanswered(std::span<const Query> queries) {
  Answers answers;
  clearFor(queries, 1, answers);
  return answers;
}

void cancelRest(Answers& answers) {
  for (size_t i = 0; i < answers.results.size(); ++i) {
    if (answers.results[i].status != Status::invalid || answers.reasons.contains(i)) continue;
    answers.reasons[i] = "cancelled";
    if (!answers.lists.empty()) answers.lists[i] = {};
  }
}

Merged merged(std::span<const Result> searches, uint32_t most) {
  std::vector<size_t> order(searches.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t p, size_t q) { return keyOf(searches[p]) < keyOf(searches[q]); });
  Merged out{.first = searches[order.front()], .hits = {}};
  for (const Result& search : searches) {
    if (out.first.status == Status::invalid && search.status == Status::invalid) out.first.flags |= search.flags;
    if (out.first.status == Status::undecided && search.detected == Detected::yes) out.first.detected = Detected::yes;
  }
  const size_t count = std::min<size_t>(order.size(), most);
  for (size_t i = 0; i < count; ++i) {
    const Result& search = searches[order[i]];
    if (search.status == Status::clear) continue;
    out.hits.push_back(search);
    const bool isOpen = search.status == Status::invalid || search.status == Status::undecided;
    const bool isLast = i + 1 == order.size() || searches[order[i + 1]].status == Status::clear;
    if (isOpen || !(isLast || isOrdered(search, searches[order[i + 1]]))) out.isCertain = false;
  }
  // A decision needs no order.
  if (std::get<0>(keyOf(out.first)) == 0) out.isCertain = true;
  return out;
}

}  // namespace radar
