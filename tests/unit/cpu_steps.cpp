// Compares the CPU's answers to steps, in which objects move, too, with brute force in each object's own frame, in
// exact arithmetic.
#include "cpu_agreement.h"

using namespace radar;
using soups::Random;
using Motion3 = std::array<double, 3>;

namespace {

struct Step {
  Scene scene;
  std::vector<Query> queries;
};

Motion3 anyMotion(Random& random, double scale) {
  if (random.chance(0.2)) return {};
  Motion3 motion = random.inBall();
  const bool whole = random.chance(0.5);
  for (double& c : motion) c = whole ? scale * random.integer(-3, 3) : scale * 4 * c;
  return motion;
}

Step anyStep(Random& random, double scale, double far) {
  Step step;
  const Motion3 centre{far * random.uniform(-1, 1), far, 0};
  const bool onLattice = random.chance(0.4);
  const auto mesh = [&] {
    return soups::add(step.scene, onLattice
                                      ? soups::lattice(random, random.integer(1, 8), 2)
                                      : soups::soup(random, random.integer(1, 10), random.uniform(0.1, 0.7), 0.2));
  };
  const auto pose = [&](double spread) {
    Motion3 at = random.inBall();
    for (size_t k = 0; k < 3; ++k) {
      at[k] = centre[k] + scale * (onLattice ? random.integer(-3, 3) : spread * at[k]);
    }
    if (!onLattice) return random.pose(scale * random.uniform(0.3, 2), at);
    return Transform{{scale, 0, 0, at[0], 0, scale, 0, at[1], 0, 0, scale, at[2]}};
  };
  for (int i = random.integer(1, 6); i-- > 0;) {
    step.scene.addObject({mesh(), pose(4), random.chance(0.2) ? 1u : ~0u, anyMotion(random, scale)});
  }
  const MeshId sensor = mesh();
  for (int i = 0; i < 6; ++i) {
    Query query{.mesh = sensor, .worldFromMesh = pose(random.chance(0.3) ? 0.5 : 4)};
    query.motion = anyMotion(random, scale);
    if (random.chance(0.2)) query.exclude = {0};
    if (random.chance(0.2)) query.mask = 2;
    step.queries.push_back(query);
  }
  return step;
}

// Six queries in each scene.
void checkScenes(uint64_t scenes) {
  size_t hits = 0, overlaps = 0, clear = 0;
  for (uint64_t seed = 0; seed < scenes; ++seed) {
    Random random(seed);
    const double scale = seed % 4 == 0 ? std::exp(random.uniform(-100, 100)) : 1;
    const Step step = anyStep(random, scale, seed % 5 == 0 ? 1e4 * scale : 0);
    const std::vector<Result> results = CpuSweeper(step.scene, 2).run(step.queries).results;
    for (size_t i = 0; i < results.size(); ++i) {
      INFO("seed " << seed << " query " << i);
      soups::checkTruth(step.scene, step.queries[i], results[i]);
      REQUIRE((results[i].status == Status::clear || results[i].fraction == results[i].t));
      hits += results[i].status == Status::hit;
      overlaps += results[i].status == Status::overlap;
      clear += results[i].status == Status::clear;
    }
  }
  REQUIRE(hits > scenes / 2);
  REQUIRE(overlaps > scenes / 4);
  REQUIRE(clear > scenes / 2);
}

}  // namespace

TEST_CASE("where everything moves, answers equal brute force in each object's own frame") {
  checkScenes(400);
}

TEST_CASE("where everything moves, 100,000 answers equal brute force in each object's own frame", "[.long]") {
  checkScenes(16'667);
}

TEST_CASE("a step seen from a moving frame has the same fractions, features and objects") {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    Step step = anyStep(random, 1, 0);
    // Multiples of 2^-20, whose sums are exact.
    const auto rounded = [](Motion3 motion) {
      for (double& c : motion) c = std::round(0x1p20 * c) * 0x1p-20;
      return motion;
    };
    const auto plus = [](const Motion3& p, const Motion3& q) { return Motion3{p[0] + q[0], p[1] + q[1], p[2] + q[2]}; };
    for (ObjectId id = 0; id < step.scene.objectLimit(); ++id) {
      step.scene.setMotion(id, rounded(step.scene.object(id).motion));
    }
    for (Query& query : step.queries) query.motion = rounded(*query.motion);
    CpuSweeper sweeper(step.scene, 1);
    const std::vector<Result> still = sweeper.run(step.queries).results;
    const Motion3 frame = rounded(random.inBall());
    for (ObjectId id = 0; id < step.scene.objectLimit(); ++id) {
      step.scene.setMotion(id, plus(step.scene.object(id).motion, frame));
    }
    for (Query& query : step.queries) query.motion = plus(*query.motion, frame);
    const std::vector<Result> moving = sweeper.run(step.queries).results;
    for (size_t i = 0; i < still.size(); ++i) {
      INFO("seed " << seed << " query " << i);
      CHECK(moving[i].status == still[i].status);
      CHECK(moving[i].t == still[i].t);
      CHECK((moving[i].lo == still[i].lo && moving[i].hi == still[i].hi));
      CHECK(
          (moving[i].object == still[i].object && moving[i].triA == still[i].triA && moving[i].triB == still[i].triB));
      CHECK((moving[i].featureA == still[i].featureA && moving[i].featureB == still[i].featureB));
      if (moving[i].status != Status::hit) continue;
      for (size_t k = 0; k < 3; ++k) {
        CHECK(moving[i].point[k] == Approx(still[i].point[k] + still[i].t * frame[k]).margin(1e-12));
        CHECK((moving[i].normal[k] == still[i].normal[k] || std::isnan(still[i].normal[k])));
      }
    }
  }
}

TEST_CASE("a sweep where objects move takes a step in which the sensor moves by D") {
  Scene scene;
  const MeshId box = soups::add(scene, soups::box(1, 1, 1));
  const ObjectId wall = scene.addObject({.mesh = box, .worldFromMesh = soups::at(0, 0, 10), .motion = {0, 0, -4}});
  CpuSweeper sweeper(scene, 1);
  const Query query{.mesh = box, .direction = {0, 0, 2}, .distance = 12};
  // They approach each other by 16 in the step, over a gap of 8.
  const Result result = test::answer(sweeper, query);
  REQUIRE(result.status == Status::hit);
  CHECK(result.fraction == 0.5);
  CHECK(result.t == 6);
  CHECK((result.lo <= 6 && result.hi >= 6 && result.hi <= 12 && result.hi - result.lo < 1e-13));
  CHECK(result.point[2] == 7);
  // Even one that rests.
  const Query resting{.mesh = box, .worldFromMesh = soups::at(0, 0, 7), .direction = {1, 0, 0}};
  const Result met = test::answer(sweeper, resting);
  REQUIRE(met.status == Status::hit);
  CHECK((met.fraction == 0.25 && met.t == 0 && met.lo == 0 && met.hi == 0));
  Query decided = query;
  decided.anyHit = true;
  CHECK(test::answer(sweeper, decided).hi == 12);
  scene.setMotion(wall, {0, 0, 12});
  CHECK(test::answer(sweeper, query).status == Status::clear);
  CHECK(test::answer(sweeper, query).t == INFINITY);
  scene.setMotion(wall, {});
  CHECK(test::answer(sweeper, query).t == 8);
}

TEST_CASE("the bracket of a sweep whose D is the least number above 0 contains the contact where objects move") {
  // Half of the least number is no number: the bracket was 0 to 0, before the contact.
  Scene scene;
  const MeshId box = soups::add(scene, soups::box(1, 1, 1));
  scene.addObject({.mesh = box, .worldFromMesh = soups::at(0, 0, 10), .motion = {0, 0, -16}});
  const double least = std::numeric_limits<double>::denorm_min();
  for (const double distance : {least, 3 * least}) {
    const Query query{.mesh = box, .direction = {0, 0, 2}, .distance = distance};
    const Result result = test::answer(scene, query);
    CHECK(result.fraction == 0.5);
    soups::checkTruth(scene, query, result);
  }
}

TEST_CASE("objects that leave, cross, come near or are among the nearest are judged by the relative motion") {
  Scene scene;
  const MeshId box = soups::add(scene, soups::box(1, 1, 1));
  const ObjectId below = scene.addObject({.mesh = box, .motion = {0, 0, 3}});
  const ObjectId beside = scene.addObject({.mesh = box, .worldFromMesh = soups::at(6, 0, 2), .motion = {-3, 0, 3}});
  CpuSweeper sweeper(scene, 1);
  // Rests on the lower box.
  Query query{.mesh = box, .worldFromMesh = soups::at(0, 0, 2), .motion = Motion3{0, 0, 4}, .ignoreLeaving = true};
  CHECK(test::answer(sweeper, query).status == Status::clear);
  query.motion = Motion3{0, 0, 2};  // the lower box is faster
  CHECK(test::answer(sweeper, query).object == below);
  query.motion = Motion3{0, 0, 3};  // as fast: neither leaves nor presses
  CHECK(test::answer(sweeper, query).status == Status::clear);
  query.motion = Motion3{3, 0, 3};  // slides off it, into the other
  CHECK(test::answer(sweeper, query).status == Status::hit);
  CHECK(test::answer(sweeper, query).object == beside);
  CHECK(test::answer(sweeper, query).t == Approx(4. / 6));
  query.ignoreLeaving = false;
  query.hits = kAllHits;
  const std::vector<Result> hits = sweeper.run({&query, 1}).lists[0].hits;
  REQUIRE(hits.size() == 2);
  CHECK((hits[0].object == below && hits[1].object == beside));
  query.skipOverlapping = true;
  query.worldFromMesh = soups::at(0.3, 0.2, 1.5);
  const Answers skipping = sweeper.run({&query, 1});
  CHECK(skipping.results[0].object == beside);
  CHECK(skipping.lists[0].overlapping == std::vector<ObjectId>{below});
  Query near{
      .mesh = box, .worldFromMesh = soups::at(0, 0, 9), .exclude = {beside}, .motion = Motion3{}, .clearance = 5};
  const Result approached = test::answer(sweeper, near);
  CHECK(approached.object == below);
  CHECK((approached.lo <= 2. / 3 && approached.hi >= 2. / 3 && approached.hi - approached.lo < 1e-5));
  CHECK(approached.point[2] == Approx(3).margin(1e-4));
}

TEST_CASE("queries and objects that break the contract of a step are refused by name") {
  Scene scene;
  const MeshId box = soups::add(scene, soups::box(1, 1, 1));
  const ObjectId object = scene.addObject({.mesh = box});
  Query query{.mesh = box, .motion = Motion3{1, 0, NAN}};
  CHECK_THAT(validate(query, scene), test::StartsWith("motion: expected 3 finite numbers"));
  query.motion = Motion3{1, 0, 0};
  CHECK(validate(query, scene).empty());
  query.distance = 1;
  CHECK_THAT(validate(query, scene), test::Contains("no distance"));
  query.distance = 0;
  CHECK_THAT(validate(query, scene, Mode::sampled), test::StartsWith("mode: expected contact with a motion"));
  CHECK_THROWS_WITH(scene.setMotion(object, {INFINITY, 0, 0}), test::StartsWith("setMotion: expected 3 finite"));
  CHECK_THROWS_WITH(scene.setMotion(7, {}), test::Contains("object 7 does not exist"));
  CHECK_THROWS_WITH(scene.addObject({.mesh = box, .motion = {0, 1e305, 0}}), test::StartsWith("addObject: motion"));
}
