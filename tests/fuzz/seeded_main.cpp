// A target as a program without libFuzzer: runs the seeds, then a fixed number of random mutations of them, or the
// given files. Exit status 1 if an input fails or a validation layer has a message.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "command/command.h"
#include "fuzz/target.h"
#include "workloads/random.h"

namespace {

using radar::tools::Random;

const radar::fuzz::Target& kTarget = radar::fuzz::target();

/// A seed changed in a few places.
std::string mutated(const std::vector<std::string>& seeds, uint64_t number) {
  Random random(number);
  const auto any = [&](const auto& list) { return list[random.below(static_cast<uint32_t>(list.size()))]; };
  std::string bytes = any(seeds);
  for (uint32_t count = 1 + random.below(6); count > 0; --count) {
    const size_t at = random.below(static_cast<uint32_t>(bytes.size() + 1));
    switch (random.below(6)) {
      case 0:
        bytes.erase(at, random.below(40));
        break;
      case 1:
        bytes.insert(at, bytes.substr(random.below(static_cast<uint32_t>(bytes.size() + 1)), random.below(40)));
        break;
      case 2:
        if (!kTarget.words.empty()) bytes.insert(at, any(kTarget.words));
        break;
      case 3: {
        const std::string other = any(seeds);
        bytes = bytes.substr(0, at) + other.substr(std::min(at, other.size()));
        break;
      }
      default:
        if (at < bytes.size()) bytes[at] = static_cast<char>(random.below(256));
    }
  }
  return bytes;
}

/// Returns whether it passed. `name` says how to run it again.
bool passes(const std::string& input, const std::string& name) {
  try {
    kTarget.run(input);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "FAILED: %s: %s\n", name.c_str(), error.what());
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) try {
  radar::tools::Program program("fuzz", "Runs a fuzz target on seeds, on random mutations of them, or on files");
  uint64_t runs = 1000, first = 0;
  bool names = false;
  std::vector<std::string> files;
  program.option("--runs", &runs, "Mutations");
  program.option("--first", &first, "Number of the first one: to run one again");
  program.option("--names", &names, "Prints the number of each mutation before it runs");
  program.option("FILE", &files, "Runs these instead");
  if (const std::optional<int> ended = program.parse(argc, argv)) return *ended;

  size_t failed = 0;
  for (const std::string& file : files) {
    std::ifstream stream(file, std::ios::binary);
    failed += !passes({std::istreambuf_iterator<char>(stream), {}}, file);
  }
  if (!files.empty()) return failed == 0 ? 0 : 1;
  const std::vector<std::string> seeds = kTarget.seeds();
  for (size_t i = 0; i < seeds.size(); ++i) failed += !passes(seeds[i], "seed " + std::to_string(i));
  for (uint64_t number = first; number < first + runs; ++number) {
    if (names) std::fprintf(stderr, "%llu\n", static_cast<unsigned long long>(number));
    failed += !passes(mutated(seeds, number), "--first " + std::to_string(number) + " --runs 1");
  }
  std::printf("%zu seeds and %llu mutations, %zu failed\n", seeds.size(), static_cast<unsigned long long>(runs),
              failed);
  return failed == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
