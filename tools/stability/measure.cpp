#include "stability/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bench/statistics.h"
#include "radar/cpu_sweeper.h"
#include "stability/promises.h"
#include "workloads/workload.h"

namespace radar::tools {

namespace {

using Clock = std::chrono::steady_clock;

/// What a row's medians are taken of.
struct Filling {
  StabilityRow row;
  std::vector<double> widths, microseconds;
};

void countTier(StabilityRow& row, const Result& result) {
  if (result.status == Status::undecided || result.status == Status::invalid) {
    ++row.undecided;
  } else if (result.tier == Tier::select) {
    ++row.bySelect;
  } else if (result.tier == Tier::contact) {
    ++row.byContact;
  } else {
    ++row.byPictures;
  }
}

Verdict judge(Method method, const Scene& scene, const Query& query, const Result& result, const Result& exact) {
  Verdict verdict;
  switch (method) {
    case Method::paper:
      verdict.falseHit = meets(result) && !meets(exact);
      verdict.missed = meets(exact) && !meets(result);
      break;
    case Method::sampled:
      verdict = judgeSampled(query, result, exact);
      break;
    case Method::contact:
      verdict = judgeContact(scene, query, result, exact);
      break;
  }
  return verdict;
}

/// One scene whose contents are exchanged, what answers it, and the rows of the family that is asked.
class Measuring {
 public:
  Measuring(const Device& device, const StabilitySettings& settings, StabilityReport& report,
            const std::function<void(const std::string&)>& onWrong)
      : sweeper_(device, scene_, {.cpuBatch = 0}),
        exact_(scene_),
        settings_(settings),
        report_(report),
        onWrong_(onWrong) {}

  void run(const StabilityFamily& family, uint64_t cases, const std::function<void(uint64_t)>& onProgress);

 private:
  void askScene(uint64_t first, uint32_t count);
  void ask(const std::vector<Query>& cases, const std::vector<Result>& exact, Method method, uint32_t resolution,
           uint64_t first);
  void count(Method method, const Query& query, const Result& result, const Result& exact, uint64_t number);
  void remember(const StabilityRow& row, Failure failure, uint64_t number, double amount);
  Filling& filling(Method method, uint32_t resolution);

  Scene scene_;
  Sweeper sweeper_;
  CpuSweeper exact_;
  const StabilitySettings& settings_;
  StabilityReport& report_;
  const std::function<void(const std::string&)>& onWrong_;
  const StabilityFamily* family_ = nullptr;
  std::vector<Filling> fillings_;
};

Filling& Measuring::filling(Method method, uint32_t resolution) {
  const auto found = std::find_if(fillings_.begin(), fillings_.end(), [&](const Filling& known) {
    return known.row.method == method && known.row.resolution == resolution;
  });
  if (found != fillings_.end()) return *found;
  StabilityRow row;
  row.family = family_->name;
  row.method = method;
  row.resolution = resolution;
  fillings_.push_back({row, {}, {}});
  return fillings_.back();
}

void Measuring::remember(const StabilityRow& row, Failure failure, uint64_t number, double amount) {
  if (row.resolution != kTellingResolution || amount <= 0) return;
  const auto found = std::find_if(report_.telling.begin(), report_.telling.end(), [&](const TellingCase& known) {
    return known.family == row.family && known.method == row.method && known.failure == failure;
  });
  if (found == report_.telling.end()) {
    report_.telling.push_back({row.family, row.method, failure, number, amount});
  } else if (amount > found->amount) {
    found->number = number;
    found->amount = amount;
  }
}

void Measuring::count(Method method, const Query& query, const Result& result, const Result& exact, uint64_t number) {
  Filling& filled = filling(method, query.resolution);
  StabilityRow& row = filled.row;
  const Verdict verdict = judge(method, scene_, query, result, exact);
  const bool unseen = method == Method::sampled && meets(exact) && result.status == Status::undecided;
  ++row.cases;
  row.contacts += meets(exact);
  row.missed += verdict.missed || unseen;
  row.falseHits += verdict.falseHit;
  row.brackets += verdict.bracket;
  row.otherwise += !verdict.right() && !verdict.missed && !verdict.falseHit && !verdict.bracket;
  if (method != Method::paper) countTier(row, result);
  const double negative = result.paperMinL < 0 ? -result.paperMinL : 0;  // tells of surfaces that have passed
  if (verdict.missed || unseen) remember(row, Failure::missed, number, 1 + negative);
  if (verdict.falseHit) remember(row, Failure::falseHit, number, 1 + negative);
  if (meets(result) && meets(exact)) {
    const double size = std::max(sensorSize(scene_, query), exact.t);
    row.late = std::max(row.late, (result.t - exact.t) / size);
    row.early = std::max(row.early, (exact.t - result.t) / size);
    remember(row, Failure::late, number, (result.t - exact.t) / size);
    remember(row, Failure::early, number, (exact.t - result.t) / size);
    if (method != Method::paper) filled.widths.push_back((result.hi - result.lo) / size);
  }
  if (method == Method::paper || verdict.right()) return;
  onWrong_(std::string(nameOf(method)) + " " + std::to_string(query.resolution) + ": " + verdict.words() +
           "; --family \"" + row.family + "\" --seed " + std::to_string(settings_.seed) + " --first " +
           std::to_string(number) + " --cases 1");
}

void Measuring::ask(const std::vector<Query>& cases, const std::vector<Result>& exact, Method method,
                    uint32_t resolution, uint64_t first) {
  const std::vector<Query> queries = asked(cases, method, resolution);
  const Clock::time_point start = Clock::now();
  const std::vector<Result> results = sweeper_.run(queries);
  const double microseconds = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  for (size_t i = 0; i < queries.size(); ++i) {
    count(method, queries[i], results[i], exact[i], first + i);
    if (method != Method::sampled) continue;
    count(Method::paper, queries[i], paperAnswer(queries[i], results[i]), exact[i], first + i);
  }
  filling(method, resolution).microseconds.push_back(microseconds / static_cast<double>(queries.size()));
}

void Measuring::askScene(uint64_t first, uint32_t number) {
  std::vector<StabilityCase> cases;
  for (uint32_t i = 0; i < number; ++i) cases.push_back(stabilityCase(*family_, first + i, settings_.seed));
  const Workload workload = workloadOf(cases);
  replaceBy(workload, 0, scene_);
  sweeper_.sync();
  std::vector<Query> queries;
  for (const QuerySpec& spec : workload.queries) queries.push_back(toQuery(spec, Mode::contact));
  const std::vector<Result> exact = exact_.run(queries);
  const uint64_t scene = first / kCasesPerScene;
  for (const uint32_t resolution : settings_.resolutions) {
    if (scene % strideOf(resolution) != 0) continue;
    ask(queries, exact, Method::sampled, resolution, first);
  }
  ask(queries, exact, Method::contact, 0, first);
}

void Measuring::run(const StabilityFamily& family, uint64_t cases, const std::function<void(uint64_t)>& onProgress) {
  family_ = &family;
  fillings_.clear();
  const uint64_t end = settings_.first + cases;
  for (uint64_t next = settings_.first; next < end;) {
    const auto number = static_cast<uint32_t>(std::min(end - next, kCasesPerScene - next % kCasesPerScene));
    askScene(next, number);
    next += number;
    onProgress(number);
  }
  std::stable_sort(fillings_.begin(), fillings_.end(), [](const Filling& a, const Filling& b) {
    return std::pair(a.row.method, a.row.resolution) < std::pair(b.row.method, b.row.resolution);
  });
  for (Filling& filled : fillings_) {
    filled.row.width = median(std::move(filled.widths));
    filled.row.microseconds = median(std::move(filled.microseconds));
    report_.rows.push_back(filled.row);
  }
}

}  // namespace

bool StabilityRow::right() const {
  if (method == Method::paper) return true;
  const bool seen = method == Method::sampled || missed == 0;
  return seen && falseHits == 0 && brackets == 0 && otherwise == 0 && (method != Method::contact || undecided == 0);
}

bool StabilityReport::right() const {
  return std::all_of(rows.begin(), rows.end(), [](const StabilityRow& row) { return row.right(); });
}

uint32_t strideOf(uint32_t resolution) {
  return std::max(1u, (resolution / 128) * (resolution / 128));
}

StabilityReport measureStability(const Device& device, const StabilitySettings& settings,
                                 const std::function<void(const std::string&)>& onWrong,
                                 const std::function<void(uint64_t)>& onProgress) {
  StabilityReport report;
  Measuring measuring(device, settings, report, onWrong);
  const std::vector<std::string>& names = settings.families;
  std::vector<const StabilityFamily*> families;
  for (const StabilityFamily& family : stabilityFamilies()) {
    if (names.empty() || std::find(names.begin(), names.end(), family.name) != names.end()) families.push_back(&family);
  }
  if (families.empty()) throw Error("no family is called " + names.front());
  const uint64_t each = (settings.cases + families.size() - 1) / families.size();
  for (const StabilityFamily* family : families) measuring.run(*family, each, onProgress);
  return report;
}

}  // namespace radar::tools
