// Every pair of options by command: answers to random queries that have both, those of the device and those of the CPU,
// against brute force over all pairs of triangles, and against simpler queries. Exit status 1 if anything is wrong.
#include <cstdio>
#include <sstream>

#include "agreement/random_options.h"
#include "command/command.h"
#include "commit/commit.h"
#include "radar/cpu_sweeper.h"
#include "support/answer.h"
#include "support/same_bits.h"
#include "unit/nearness_truth.h"

namespace {

using namespace radar;
using test::kOptionNames;
using test::Option;

struct Count {
  uint64_t queries = 0, hit = 0, clear = 0, overlap = 0, undecided = 0, refused = 0, atEnd = 0, leftOut = 0, wrong = 0;

  static constexpr std::array kNames{"queries", "hit",    "clear",    "overlap", "undecided",
                                     "refused", "at end", "left out", "wrong"};
  static constexpr uint64_t Count::*kNumbers[]{&Count::queries, &Count::hit,       &Count::clear,
                                               &Count::overlap, &Count::undecided, &Count::refused,
                                               &Count::atEnd,   &Count::leftOut,   &Count::wrong};
  void add(const Count& other) {
    for (uint64_t Count::*number : kNumbers) this->*number += other.*number;
  }
};

bool isDecision(const Result& result) {
  return result.status == Status::hit && result.object == kNone;
}

/// By the exact oracle.
std::string faultOfPlain(const Scene& scene, const Query& query, const Result& result, const Listed& listed,
                         Count& count) {
  const oracle::Truth truth = oracle::truthOf(scene, query);
  Query whole = query;
  whole.ignoreLeaving = false;
  const bool leaves = query.ignoreLeaving && oracle::truthOf(scene, whole).contacts.size() != truth.contacts.size();
  count.leftOut += leaves || !truth.overlapping.empty();
  if (!query.anyHit) return oracle::faultOf(truth, query, result, listed.hits, listed.overlapping);
  if (listed.overlapping != truth.overlapping) return "wrong list of overlapping objects";
  if (truth.contacts.empty()) return result.status == Status::clear ? "" : "a decision that is not clear";
  const double end = query.motion ? 1 : query.distance;
  return isDecision(result) && result.lo == 0 && result.t == end && result.hi == end ? "" : "a decision that is no hit";
}

/// The scene without the objects that an answer leaves out, and their numbers.
struct Fresh {
  Scene scene;
  std::vector<ObjectId> ids;

  Fresh(const Scene& whole, const auto& counts) {
    for (MeshId id = 0; id < whole.meshLimit(); ++id) scene.addMesh(whole.mesh(id).positions, whole.mesh(id).indices);
    for (ObjectId id = 0; id < whole.objectLimit(); ++id) {
      if (!counts(id)) continue;
      Object object = whole.object(id);
      object.mask = ~0u;
      scene.addObject(object);
      ids.push_back(id);
    }
  }
  Result renamed(Result result) const {
    if (result.object != kNone) result.object = ids[result.object];
    return result;
  }
};

/// By simpler queries, whose answers have the same bits: through a scene of only what takes part; past each object
/// alone, if several are listed; for the first contact, if only a decision is asked for.
std::string faultBesideSimpler(const Scene& scene, const Query& query, const Result& result, const Listed& listed) {
  Query simple = query;
  simple.exclude.clear();
  simple.mask = ~0u;
  simple.skipOverlapping = simple.anyHit = false;
  simple.hits = 1;
  if (query.clearance == 0) simple.tolerance.reset();
  if (!query.ignoreLeaving && !query.skipOverlapping) simple.slack.reset();
  const auto counts = [&](ObjectId id) {
    return oracle::takesPart(scene, query, id) && !std::ranges::count(listed.overlapping, id);
  };
  const Fresh fresh(scene, counts);
  // A step's query with a direction takes a step only where something moves.
  if (!query.motion && oracle::isStep(scene, query) != oracle::isStep(fresh.scene, simple)) return "";
  const Result alike = fresh.renamed(test::answer(fresh.scene, simple));
  if (query.anyHit) {
    const bool isHit = alike.status == Status::hit || alike.status == Status::overlap;
    return isHit == (result.status == Status::hit) ? "" : "another decision than where it is simpler";
  }
  if (!test::sameButTier(result, alike)) return "simpler: " + test::differenceOf({&result, 1}, {&alike, 1});
  for (const Result& hit : listed.hits) {
    const Fresh alone(scene, [&](ObjectId id) { return id == hit.object; });
    if (oracle::isStep(scene, query) != oracle::isStep(alone.scene, simple)) continue;
    const Result first = alone.renamed(test::answer(alone.scene, simple));
    if (!test::sameButTier(hit, first)) {
      return "alone: " + test::differenceOf({&hit, 1}, {&first, 1});
    }
  }
  return "";
}

std::string faultOf(const Scene& scene, const Query& query, const Answers& answers, size_t i, Count& count) {
  const Result& result = answers.results[i];
  const Listed& listed = test::listedBy(answers, i);
  std::string fault;
  bool isOpen = false;
  if (query.clearance > 0) {
    const oracle::NearTruth truth(scene, query);
    isOpen = truth.isOpen();
    count.leftOut += truth.passing() > 0 || !listed.overlapping.empty();
    fault = truth.faultOf(result, listed.hits, listed.overlapping);
  } else {
    fault = faultOfPlain(scene, query, result, listed, count);
  }
  return fault.empty() && !isOpen ? faultBesideSimpler(scene, query, result, listed) : fault;
}

/// The queries that hit, with contact at the very end or just beyond it.
std::vector<Query> endingAt(soups::Random& random, const std::vector<Query>& queries, const Answers& answers,
                            const Scene& scene) {
  std::vector<Query> out;
  for (size_t i = 0; i < queries.size(); ++i) {
    const Result& result = answers.results[i];
    if (result.status != Status::hit || queries[i].anyHit) continue;
    Query query = queries[i];
    const double ends[]{result.hi, result.hi, result.t, std::nextafter(result.hi, 0), std::nextafter(result.lo, 0)};
    const double end = ends[random.below(5)];
    if (query.motion) {
      for (double& c : *query.motion) c *= end;
    } else if (oracle::isStep(scene, query)) {
      continue;
    } else {
      query.distance = end;
    }
    out.push_back(query);
  }
  return out;
}

class Run {
 public:
  Run(const Device* device, uint64_t seed) : seed_(seed), cpu_(scene_, 1) {
    if (device != nullptr) sweeper_.emplace(*device, scene_, SweeperOptions{.cpuBatch = 0});
  }

  Count ask(uint32_t options, const std::string& name, uint64_t first, uint64_t queries) {
    Count count;
    for (uint64_t number = first; count.queries < queries; ++number) {
      soups::Random random(seed_ * 1'000'003 + number * 1024 + options);
      std::vector<Query> drawn = test::drawn(random, options, scene_);
      std::erase_if(drawn, [&](const Query& query) {
        const bool isRefused = !validate(query, scene_).empty();
        count.refused += isRefused;
        count.queries += isRefused;
        const bool isWrong = isRefused != (query.hits > 1 && query.anyHit);
        count.wrong += isWrong;
        if (isWrong)
          std::printf("WRONG: %s: %s, scene %llu\n", name.c_str(), validate(query, scene_).c_str(), ull(number));
        return isRefused;
      });
      const std::string where = name + "; --first " + std::to_string(number) + " --queries 1";
      const Answers answers = judge(drawn, where, count);
      const std::vector<Query> ending = endingAt(random, drawn, answers, scene_);
      count.atEnd += ending.size();
      judge(ending, where + ", at the end", count);
    }
    return count;
  }

 private:
  static unsigned long long ull(uint64_t value) { return value; }

  Answers judge(const std::vector<Query>& queries, const std::string& where, Count& count) {
    if (queries.empty()) return {};
    const Answers answers = cpu_.run(queries);
    const auto wrong = [&](const std::string& words, size_t i) {
      ++count.wrong;
      std::printf("WRONG: query %zu: %s; --pair %s --seed %llu\n", i, words.c_str(), where.c_str(), ull(seed_));
    };
    if (sweeper_) {
      const Answers found = sweeper_->run(queries);
      const std::string difference = test::differenceOf(found, answers, test::sameButTier);
      if (!difference.empty()) wrong("the device's " + difference, 0);
    }
    for (size_t i = 0; i < queries.size(); ++i) {
      const Status status = answers.results[i].status;
      ++count.queries;
      count.hit += status == Status::hit;
      count.clear += status == Status::clear;
      count.overlap += status == Status::overlap;
      count.undecided += status == Status::undecided;
      const std::string fault = faultOf(scene_, queries[i], answers, i, count);
      if (!fault.empty()) wrong(fault, i);
    }
    return answers;
  }

  uint64_t seed_;
  Scene scene_;
  CpuSweeper cpu_;
  std::optional<Sweeper> sweeper_;
};

void printRow(const std::string& name, const Count& count) {
  std::printf("%-32s", name.c_str());
  for (uint64_t Count::*number : Count::kNumbers) std::printf(" %9llu", static_cast<unsigned long long>(count.*number));
  std::printf("\n");
  std::fflush(stdout);
}

/// All pairs, or those that have all the given names.
std::vector<uint32_t> pairsWith(const std::vector<std::string>& names) {
  std::vector<uint32_t> out;
  uint32_t asked = 0;
  for (size_t i = 0; i < kOptionNames.size(); ++i) {
    if (std::ranges::count(names, kOptionNames[i])) asked |= 1u << i;
  }
  for (size_t i = 0; i < kOptionNames.size(); ++i) {
    for (size_t k = i + 1; k < kOptionNames.size(); ++k) {
      const uint32_t pair = 1u << i | 1u << k;
      if ((pair & asked) == asked) out.push_back(pair);
    }
  }
  if (names.size() > 2) out = {asked};
  return out;
}

std::string nameOf(uint32_t options) {
  std::string name;
  for (size_t i = 0; i < kOptionNames.size(); ++i) {
    if ((options >> i & 1) != 0) name += (name.empty() ? "" : ",") + std::string(kOptionNames[i]);
  }
  return name;
}

}  // namespace

int main(int argc, char** argv) try {
  radar::tools::Program program(
      "radar_random_options",
      "Holds the answers to random queries with every two options against brute force and simpler queries");
  uint64_t queries = 1'000, seed = 1, first = 0;
  bool onCpu = false, withoutDoubles = false;
  std::vector<std::string> names;
  program.option("--queries", &queries, "Of each pair, at least");
  program.option("--seed", &seed, "Another seed, other queries");
  program.option("--first", &first, "Number of each pair's first scene: to ask one again");
  program.option("--pair", &names, "Only pairs with these options; three and more: all together")
      .list()
      .oneOf(std::vector<std::string>(kOptionNames.begin(), kOptionNames.end()));
  program.option("--cpu", &onCpu, "Without a device");
  program.option("--without-doubles", &withoutDoubles, "As on a device that has none");
  if (const std::optional<int> ended = program.parse(argc, argv)) return *ended;

  std::optional<Device> device;
  if (!onCpu) device.emplace(Device::open({.doubles = !withoutDoubles}));
  std::printf("%s, commit %s, seed %llu\n%-32s", onCpu ? "CPU" : device->name().c_str(), tools::commit(),
              static_cast<unsigned long long>(seed), "pair");
  for (const char* name : Count::kNames) std::printf(" %9s", name);
  std::printf("\n");
  Run run(device ? &*device : nullptr, seed);
  Count all;
  for (const uint32_t pair : pairsWith(names)) {
    const Count count = run.ask(pair, nameOf(pair), first, queries);
    printRow(nameOf(pair), count);
    all.add(count);
  }
  printRow("all", all);
  return all.wrong == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_random_options: %s\n", error.what());
  return 2;
}
