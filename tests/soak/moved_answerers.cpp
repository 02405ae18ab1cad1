#include "soak/moved_answerers.h"

#include <algorithm>

#include "embed/execute.h"
#include "embed/written_queries.h"
#include "fuzz/check_recorded.h"
#include "fuzz/target.h"
#include "radar/cpu_sweeper.h"

namespace radar::soak {

namespace {

constexpr uint32_t kQueries = 48;
constexpr Capacity kRoom{
    .queries = kQueries, .candidates = 1u << 16, .rounds = 64, .unresolvedPairs = 1u << 13, .searches = 1u << 12};

test::Scales anyScales(tools::Random& random) {
  const std::array<test::Scales, 6> all{{{1, 8, 0},
                                         {1, 12, 300},
                                         {1, 60, 0x1p16},
                                         {1, 20, 0x1p20, 0x1p20},
                                         {0x1p-20, 0x1p-16, 0x1p-10},
                                         {0x1p30, 0x1p34, 0x1p40}}};
  return all[random.below(static_cast<uint32_t>(all.size()))];
}

test::MovedWorld anyWorld(const Device& device, tools::Random& random) {
  const uint32_t moving = 1 + random.below(4), bounded = random.below(3);
  const uint64_t seed = random.below(1u << 30);
  return {1 + random.below(60),
          seed,
          anyScales(random),
          [=](ObjectId id) { return id % 4 < moving; },
          [=](ObjectId id) { return id % 7 < bounded; },
          device};
}

}  // namespace

MovedAnswerers::MovedAnswerers(const Device& device, tools::Random& random, Tally& tally)
    : device_(&device),
      random_(&random),
      tally_(&tally),
      world_(anyWorld(device, random)),
      copy_(device, world_.scene),
      recorder_(device, world_.scene, kRoom),
      sharing_(copy_, kRoom),
      sweeper_(copy_, {.cpuBatch = 0}) {}

std::vector<Query> MovedAnswerers::choose() {
  std::vector<Query> queries = world_.queries(kQueries);
  std::erase_if(queries, [&](const Query& query) { return !validate(query, world_.truth).empty(); });
  for (Query& query : queries) {
    if (query.anyHit) continue;
    query.ignoreLeaving = random_->oneIn(6);
    if (random_->oneIn(6)) query.hits = 2 + random_->below(4);
    if (query.ignoreLeaving || query.hits > 1) continue;
    if (random_->oneIn(8)) query.clearance = random_->magnitude(-6, 0) * world_.scales.size;
  }
  return queries;
}

/// Adds an object, or removes one.
void MovedAnswerers::change() {
  if (world_.moved.size() > 40 || (world_.moved.size() > 1 && random_->oneIn(2))) {
    const ObjectId gone = world_.moved[random_->below(static_cast<uint32_t>(world_.moved.size()))];
    world_.remove(gone);
  }
  Object object{world_.meshes[random_->below(9)], test::floatPose(*random_, world_.scales.size, {}), 3};
  world_.moved.push_back(world_.add(object));
}

template <class Queries>
void MovedAnswerers::ask(Who who, const Queries& recorded, std::span<const Query> queries) {
  CpuSweeper cpu(world_.truth, 1);
  const Answers exact = cpu.run(queries);
  for (Recorder* recorder : {&recorder_, &sharing_}) {
    const Answers found = record(*recorder, *device_, recorded, world_.geometry(), *random_, *tally_);
    fuzz::require(recorder->boundsViolation().empty(), recorder->boundsViolation());
    fuzz::checkRecorded(queries, found, exact);
    tally_->limited += fuzz::isTooSmall(found);
    tally_->add(who, queries.size());
  }
}

void MovedAnswerers::tellAndAsk(const std::vector<Query>& queries) {
  world_.tell();
  const Batch batch{.queries = queries, .exact = CpuSweeper(world_.truth, 1).run(queries)};
  checkBatch(batch, sweeper_.run(queries), "", Who::sweeper, *tally_);
}

void MovedAnswerers::round() {
  if (random_->oneIn(4)) change();
  if (random_->oneIn(3)) world_.deformAgain();
  world_.moveAgain();
  const std::vector<Query> queries = choose();
  measured(Who::moved, *tally_, [&] { ask(Who::moved, queries, queries); });
  const test::Written written(queries, *device_);
  measured(Who::written, *tally_, [&] { ask(Who::written, HostQueries(written), written.same); });
  if (random_->oneIn(8)) measured(Who::sweeper, *tally_, [&] { tellAndAsk(queries); });
}

}  // namespace radar::soak
