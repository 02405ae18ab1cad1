// The run of hard cases against brute force by command: answers of the CPU, or of a device, and their lists against the
// definition in exact integers, a table per family. Exit status 1 if anything is wrong.
#include <cstdio>

#include "command/command.h"
#include "commit/commit.h"
#include "radar/cpu_sweeper.h"
#include "support/answer.h"
#include "unit/brute_force.h"
#include "workloads/hard_cases.h"

namespace {

using namespace radar;
using namespace radar::tools;

struct Count {
  uint64_t queries = 0, hits = 0, clear = 0, overlaps = 0, contacts = 0, overlapping = 0, pairs = 0, wrong = 0;

  void add(const Count& other) {
    for (uint64_t Count::*number : {&Count::queries, &Count::hits, &Count::clear, &Count::overlaps, &Count::contacts,
                                    &Count::overlapping, &Count::pairs, &Count::wrong}) {
      this->*number += other.*number;
    }
  }
};

void print(const std::string& family, const Count& count) {
  const auto number = [](uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf("%-12s %8llu %8llu %8llu %8llu %9llu %8llu %12llu %6llu\n", family.c_str(), number(count.queries),
              number(count.hits), number(count.clear), number(count.overlaps), number(count.contacts),
              number(count.overlapping), number(count.pairs), number(count.wrong));
  std::fflush(stdout);
}

/// One scene, whose meshes and objects are exchanged.
class Asker {
 public:
  explicit Asker(const Device* device) : cpu_(scene_, 1) {
    if (device != nullptr) sweeper_.emplace(*device, scene_, SweeperOptions{.cpuBatch = 0});
  }

  /// Asks for the first contact, and for those with all objects. Returns what is wrong, in words.
  std::string ask(const HardCase& hard, Count& count) {
    const Workload workload = sceneOf({hard}, Company::isolated);
    replaceBy(workload, 0, scene_);
    Query query = workload.queries[0];
    const oracle::Truth truth = oracle::truthOf(scene_, query);
    const Status status = truth.contacts.empty()            ? Status::clear
                          : truth.contacts[0].s.sign() == 0 ? Status::overlap
                                                            : Status::hit;
    ++count.queries;
    count.hits += status == Status::hit;
    count.clear += status == Status::clear;
    count.overlaps += status == Status::overlap;
    count.contacts += truth.contacts.size();
    count.overlapping += truth.overlapping.size();
    for (const PlacedMesh& object : hard.objects) {
      count.pairs += uint64_t{hard.sensor.mesh.triangleCount()} * object.mesh.triangleCount();
    }
    for (const uint32_t hits : {1u, kAllHits}) {
      query.hits = hits;
      const Answers found = sweeper_ ? sweeper_->run({&query, 1}) : cpu_.run({&query, 1});
      const Listed& listed = test::listedBy(found, 0);
      std::string fault = oracle::faultOf(truth, query, found.results[0], listed.hits, listed.overlapping);
      if (!fault.empty()) return fault;
    }
    return "";
  }

 private:
  Scene scene_;
  CpuSweeper cpu_;
  std::optional<Sweeper> sweeper_;
};

}  // namespace

int main(int argc, char** argv) try {
  radar::tools::Program program("radar_brute_force",
                                "Holds exact answers to hard cases against brute force in exact integers");
  uint64_t queries = 10'000, seed = 1, first = 0;
  bool onDevice = false;
  std::vector<std::string> known, families;
  for (const HardFamily& family : hardFamilies()) {
    known.push_back(family.name);
    if (family.ignoresLeaving) families.push_back(family.name);
  }
  program.option("--queries", &queries, "In all, over the families alike");
  program.option("--seed", &seed, "Another seed, other queries");
  program.option("--first", &first, "Number of each family's first query: to ask one again");
  program.option("--family", &families, "Only these; without the option, those of bodies at rest").oneOf(known);
  program.option("--on-device", &onDevice, "The answers are those of the device, not of the CPU");
  if (const std::optional<int> ended = program.parse(argc, argv)) return *ended;

  std::optional<Device> device;
  if (onDevice) device.emplace(Device::open());
  Asker asker(onDevice ? &*device : nullptr);
  std::printf("%s, commit %s, seed %llu\n", onDevice ? device->name().c_str() : "CPU", commit(),
              static_cast<unsigned long long>(seed));
  std::printf("%-12s %8s %8s %8s %8s %9s %8s %12s %6s\n", "family", "queries", "hit", "clear", "overl.", "contacts",
              "skipped", "pairs", "wrong");
  Count all;
  const uint64_t each = (queries + families.size() - 1) / families.size();
  for (const std::string& name : families) {
    const HardFamily& family = hardFamily(name);
    Count count;
    for (uint64_t number = first; number < first + each; ++number) {
      const std::string fault = asker.ask(hardCase(family, seed, number), count);
      if (fault.empty()) continue;
      ++count.wrong;
      std::printf("WRONG: %s; --family \"%s\" --seed %llu --first %llu --queries 1\n", fault.c_str(), name.c_str(),
                  static_cast<unsigned long long>(seed), static_cast<unsigned long long>(number));
    }
    print(name, count);
    all.add(count);
  }
  print("all", all);
  return all.wrong == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_brute_force: %s\n", error.what());
  return 2;
}
