// The run of seeded random queries by command: the search on the device against the CPU's, a table per family. Exit
// status 1 if anything is wrong.
#include <algorithm>
#include <cstdio>

#include "agreement/real_meshes.h"
#include "command/command.h"
#include "commit/commit.h"
#include "gpu/device.h"

namespace {

using radar::tools::Approach;
using radar::tools::Fault;
using radar::tools::Tally;

void printHeader() {
  std::printf("%-13s %7s %6s %6s %6s |", "family", "queries", "hit", "clear", "overl.");
  for (size_t i = 0; i < radar::tools::kFaults; ++i) std::printf(" %12s", nameOf(static_cast<Fault>(i)));
  std::printf(" | %6s | %11s %9s %8s | %7s %7s\n", "wrong", "pairs", "cpu_pairs", "share", "s", "CPU s");
}

void print(const std::string& family, const Tally& t) {
  const auto number = [](uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf("%-13s %7llu %6llu %6llu %6llu |", family.c_str(), number(t.queries), number(t.hits), number(t.clear),
              number(t.overlaps));
  for (const uint64_t count : t.faults) std::printf(" %12llu", number(count));
  std::printf(" | %6llu | %11llu %9llu %7.3f%% | %7.2f %7.2f\n", number(t.wrong), number(t.pairs), number(t.cpuPairs),
              t.pairs == 0 ? 0.0 : 100.0 * static_cast<double>(t.cpuPairs) / static_cast<double>(t.pairs),
              t.deviceSeconds, t.cpuSeconds);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  radar::tools::Program program("radar_random_queries",
                                "Holds the search on the device against the CPU's on seeded random queries");
  uint64_t queries = 100'000, seed = 1, first = 0;
  uint32_t index = radar::kNone;
  bool withoutDoubles = false, composedDivision = false, ignoreLeaving = false, allHits = false, clearances = false,
       steps = false;
  const radar::tools::MeshFamilies meshes = radar::test::realMeshes();
  const std::vector<std::string> known = radar::tools::runFamilies(meshes);
  std::vector<std::string> families;
  program.option("--queries", &queries, "In all, over the families alike");
  program.option("--seed", &seed, "Another seed, other queries");
  program.option("--first", &first, "Number of each family's first query: to ask one again");
  program.option("--family", &families, "Only these").oneOf(known);
  program.option("--device", &index, "As `cyber-radar devices` numbers them");
  program.option("--without-doubles", &withoutDoubles, "As on a device that has none");
  program.option("--composed-division", &composedDivision, "As on a device whose division of doubles is not right");
  program.option("--ignore-leaving", &ignoreLeaving, "Every query counts only pairs of triangles that block");
  program.option("--all-hits", &allHits, "Every query lists the contacts with all objects");
  program.option("--clearances", &clearances, "Every query has a clearance, of its own size");
  program.option("--steps", &steps, "Objects move, too");
  if (const std::optional<int> ended = program.parse(argc, argv)) return *ended;
  if (families.empty()) families = known;

  const radar::Device device = radar::Device::open({.index = index, .doubles = !withoutDoubles});
  if (composedDivision) device.impl().dividesRight = false;
  std::printf("device %s, driver %s, commit %s, seed %llu, %s doubles%s\n", device.name().c_str(),
              device.driver().c_str(), radar::tools::commit(), static_cast<unsigned long long>(seed),
              device.doubles() ? "with" : "without", composedDivision ? ", division composed" : "");
  printHeader();
  radar::tools::CaseRun run(device, meshes);
  Tally all;
  const uint64_t each = (queries + families.size() - 1) / families.size();
  for (const std::string& family : families) {
    const auto onWrong = [&](uint64_t query, const Approach&, const std::string& words) {
      std::printf("WRONG: %s; --family \"%s\" --seed %llu --first %llu --queries 1\n", words.c_str(), family.c_str(),
                  static_cast<unsigned long long>(seed), static_cast<unsigned long long>(query));
    };
    uint64_t done = 0;
    const auto onProgress = [&](uint64_t more) {
      done += more;
      std::fprintf(stderr, "\r%s %llu of %llu ", family.c_str(), static_cast<unsigned long long>(done),
                   static_cast<unsigned long long>(each));
    };
    const Tally tally = run.run({.family = family,
                                 .seed = seed,
                                 .first = first,
                                 .cases = each,
                                 .ignoreLeaving = ignoreLeaving,
                                 .allHits = allHits,
                                 .clearances = clearances,
                                 .steps = steps},
                                onWrong, onProgress);
    std::fprintf(stderr, "\r%40s\r", "");
    print(family, tally);
    all.add(tally);
  }
  print("all", all);
  return all.wrong == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_random_queries: %s\n", error.what());
  return 2;
}
