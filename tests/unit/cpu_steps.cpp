// Steps, in which objects move, too: their frames, limits and contracts.
#include "brute_force.h"

#include <limits>
#include "radar/cpu_sweeper.h"
#include "radar/displacement.h"
#include "scene_kinds.h"
#include "support/answer.h"
#include "support/catch.h"

using namespace radar;
using test::add;
using test::at;
using tools::operator+;
using tools::operator-;
using Motion3 = tools::Vec3;

TEST_CASE("a step seen from a moving frame has the same fractions, features and objects") {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    kinds::Random random(seed);
    test::Case step;
    kinds::makeStep(random, 1, 0, step);
    // Multiples of 2^-20, whose sums are exact.
    const auto rounded = [](Motion3 motion) {
      for (double& c : motion) c = std::round(0x1p20 * c) * 0x1p-20;
      return motion;
    };
    for (ObjectId id = 0; id < step.scene.objectLimit(); ++id) {
      step.scene.setMotion(id, rounded(step.scene.object(id).motion));
    }
    for (Query& query : step.queries) query.motion = rounded(*query.motion);
    CpuSweeper sweeper(step.scene, 1);
    const std::vector<Result> still = sweeper.run(step.queries).results;
    const Motion3 frame = rounded(random.inBall());
    for (ObjectId id = 0; id < step.scene.objectLimit(); ++id) {
      step.scene.setMotion(id, step.scene.object(id).motion + frame);
    }
    for (Query& query : step.queries) query.motion = *query.motion + frame;
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
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  const ObjectId wall = scene.addObject({.mesh = box, .worldFromMesh = at(0, 0, 10), .motion = {0, 0, -4}});
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
  const Query resting{.mesh = box, .worldFromMesh = at(0, 0, 7), .direction = {1, 0, 0}};
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
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  scene.addObject({.mesh = box, .worldFromMesh = at(0, 0, 10), .motion = {0, 0, -16}});
  const double least = std::numeric_limits<double>::denorm_min();
  for (const double distance : {least, 3 * least}) {
    const Query query{.mesh = box, .direction = {0, 0, 2}, .distance = distance};
    const Result result = test::answer(scene, query);
    CHECK(result.fraction == 0.5);
    CHECK(oracle::faultOf(oracle::truthOf(scene, query), query, result, {}, {}) == "");
  }
}

TEST_CASE("queries and objects that break the contract of a step are refused by name") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
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

TEST_CASE("a displacement becomes a step, or a sweep that goes at least so far") {
  kinds::Random random(5);
  const auto lengthOf = [](const Motion3& way) {
    long double sum = 0;
    for (const long double x : way) sum += x * x;
    return std::sqrt(sum);
  };
  for (int i = 0; i < 300; ++i) {
    Motion3 way;
    for (double& x : way) x = random.chance(0.25) ? 0 : std::ldexp(random.uniform(-1, 1), random.integer(-30, 30));
    const bool isAlongAxis = (way[0] == 0) + (way[1] == 0) + (way[2] == 0) == 2, rests = way == Motion3{};
    Query step, near{.clearance = 1}, nearMoving{.clearance = 1}, sampled;
    setDisplacement(step, way, Mode::contact, false);
    setDisplacement(near, way, Mode::contact, false);
    setDisplacement(nearMoving, way, Mode::contact, true);
    setDisplacement(sampled, way, Mode::sampled, false);
    for (const Query* query : {&step, &nearMoving}) {
      CHECK(query->motion.has_value() != isAlongAxis);
      CHECK(displacementOf(*query) == way);
    }
    CHECK(near.motion.has_value() == rests);
    CHECK_FALSE(sampled.motion);
    for (const Query* query : {&near, &sampled}) {
      if (query->motion) continue;
      const long double length = lengthOf(way);
      CHECK((query->distance >= length && query->distance <= length * (1 + 0x1p-49L)));
      CHECK(lengthOf(displacementOf(*query) - way) <= 0x1p-48L * length);
    }
  }
  Query wrong;
  setDisplacement(wrong, {0, 0, std::nan("")}, Mode::sampled, false);
  Scene scene;
  wrong.mesh = scene.addMesh(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector<uint32_t>{0, 1, 2});
  CHECK_THAT(validate(wrong, scene, Mode::sampled), test::Contains("3 finite numbers"));
}

TEST_CASE("times of a step become distances, whose bracket holds") {
  kinds::Random random(6);
  for (int i = 0; i < 300; ++i) {
    Query query;
    Result result;
    query.motion = {random.uniform(-1, 1), random.uniform(-1, 1),
                    std::ldexp(random.uniform(-1, 1), random.integer(0, 8))};
    const auto [x, y, z] = std::array<long double, 3>{(*query.motion)[0], (*query.motion)[1], (*query.motion)[2]};
    const long double length = std::sqrt(x * x + y * y + z * z);
    result.lo = i % 3 == 0 ? 0 : random.uniform(0, 0.5);
    result.t = i % 2 == 0 ? result.lo : random.uniform(0.5, 0.75);
    result.hi = i % 5 == 0 ? INFINITY : random.uniform(0.75, 1);
    Result distances = result;
    toDistances(query, distances);
    CHECK((distances.lo <= result.lo * length && distances.lo >= result.lo * length * (1 - 0x1p-49L)));
    CHECK((distances.hi >= result.hi * length && distances.hi <= result.hi * length * (1 + 0x1p-49L)));
    CHECK((distances.lo <= distances.t && distances.t <= distances.hi));
    CHECK((result.t != result.lo || distances.t == distances.lo));
    query.motion.reset();
    toDistances(query, result);
    CHECK((result.t <= 1 && result.lo <= 0.5));
  }
}
