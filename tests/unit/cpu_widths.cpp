// The CPU's answers have the same bits with every set of instructions for which its search is compiled.
#include "agreement/random_options.h"
#include "cpu/mesh_search.h"
#include "cpu_wild_scenes.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/seeds.h"
#include "workloads/hard_cases.h"
#include "workloads/turning_families.h"

using namespace radar;

namespace {

Answers answersWith(const std::string& instructions, const Scene& scene, std::span<const Query> queries) {
  cpu::setSearchInstructions(instructions);
  Answers answers = CpuSweeper(scene, 1).run(queries);
  cpu::setSearchInstructions(cpu::searchInstructions().back());
  return answers;
}

void check(const Scene& scene, std::span<const Query> queries) {
  const std::vector<std::string> names = cpu::searchInstructions();
  const Answers expected = answersWith(names[0], scene, queries);
  for (size_t i = 1; i < names.size(); ++i) {
    INFO(names[i]);
    REQUIRE(test::differenceOf(answersWith(names[i], scene, queries), expected) == "");
  }
}

void check(const tools::Workload& workload) {
  tools::ScenePlayer player(workload);
  for (const tools::Batch& batch : tools::batchesOf(workload.queries)) {
    player.show(batch.scene);
    check(player.scene(), batch.queries);
  }
}

}  // namespace

TEST_CASE("answers with all options are the same with every set of instructions") {
  for (const uint64_t seed : test::seeds({0, 1, 2})) {
    for (uint32_t options = 0; options < 2u << (test::kOptionNames.size() - 1); ++options) {
      if ((options & test::kHits) != 0 && (options & test::kDecide) != 0) continue;
      INFO("options " << options << ", seed " << seed);
      soups::Random random(1024 * seed + options);
      Scene scene;
      std::vector<Query> queries = test::drawn(random, options, scene);
      for (Query& query : queries) query.exit = !query.anyHit && !query.ignoreLeaving && query.hits == 1 && seed % 3 == 0;
      check(scene, queries);
    }
  }
}

TEST_CASE("answers to hard cases are the same with every set of instructions") {
  // 1014: a pair's bracket once depended on which pairs had been considered before.
  for (const uint64_t seed : test::seeds({5, 1014})) {
    for (const auto* families : {&tools::hardFamilies(), &tools::turningFamilies()}) {
      for (const tools::HardFamily& family : *families) {
        for (const tools::Company company : {tools::Company::isolated, tools::Company::mixed}) {
          INFO(family.name << ", seed " << seed);
          check(tools::hardScene(family, seed, 0, 32, company));
        }
      }
    }
  }
}

TEST_CASE("answers at the limits of doubles are the same with every set of instructions") {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    wild::Random random(9000 + seed);
    wild::Made made;
    wild::make(random, 1 + seed % 3, made);
    check(made.scene, made.queries);
  }
}
