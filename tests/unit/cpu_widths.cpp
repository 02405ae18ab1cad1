// The CPU's answers have the same bits with every number of lanes that this processor has.
#include "agreement/random_options.h"
#include "cpu/mesh_search.h"
#include "cpu_wild_scenes.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "workloads/hard_cases.h"
#include "workloads/turning_families.h"

using namespace radar;

namespace {

Answers answersWith(int lanes, const Scene& scene, std::span<const Query> queries) {
  cpu::setSearchWidth(lanes);
  Answers answers = CpuSweeper(scene, 1).run(queries);
  cpu::setSearchWidth(cpu::searchWidths().back());
  return answers;
}

void check(const Scene& scene, std::span<const Query> queries) {
  const std::vector<int> widths = cpu::searchWidths();
  const Answers expected = answersWith(widths[0], scene, queries);
  for (size_t i = 1; i < widths.size(); ++i) {
    INFO(widths[i] << " lanes");
    REQUIRE(test::differenceOf(answersWith(widths[i], scene, queries), expected) == "");
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

TEST_CASE("a search has at least four lanes, and the number that it is told") {
  REQUIRE(cpu::searchWidths().front() == 4);
  REQUIRE(std::ranges::is_sorted(cpu::searchWidths()));
}

TEST_CASE("answers with all options are the same with every number of lanes") {
  for (uint32_t options = 0; options < 2u << (test::kOptionNames.size() - 1); ++options) {
    if ((options & test::kHits) != 0 && (options & test::kDecide) != 0) continue;
    for (uint64_t seed = 0; seed < 3; ++seed) {
      INFO("options " << options << ", seed " << seed);
      soups::Random random(1024 * seed + options);
      Scene scene;
      std::vector<Query> queries = test::drawn(random, options, scene);
      for (Query& query : queries) query.exit = !query.anyHit && !query.ignoreLeaving && query.hits == 1 && seed == 0;
      check(scene, queries);
    }
  }
}

TEST_CASE("answers to hard cases are the same with every number of lanes") {
  for (const auto* families : {&tools::hardFamilies(), &tools::turningFamilies()}) {
    for (const tools::HardFamily& family : *families) {
      for (const tools::Company company : {tools::Company::isolated, tools::Company::mixed}) {
        INFO(family.name);
        check(tools::hardScene(family, 5, 0, 32, company));
      }
    }
  }
}

TEST_CASE("answers at the limits of doubles are the same with every number of lanes") {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    wild::Random random(9000 + seed);
    wild::Made made;
    wild::make(random, 1 + seed % 3, made);
    check(made.scene, made.queries);
  }
}
