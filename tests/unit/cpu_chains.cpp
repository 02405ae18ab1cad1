// First conflicts of chains: closed forms, turns, and random chains against exact tests of poses before and at contact,
// which long doubles place.
#include <cmath>
#include <numbers>

#include "query/chain_motion.h"
#include "radar/chain.h"
#include "radar/cpu_sweeper.h"
#include "scene/scene.h"
#include "support/catch.h"
#include "support/seeds.h"
#include "support/world.h"
#include "unit/chain_truth.h"
#include "workloads/shapes.h"

using namespace radar;
using test::add;
using tools::placedAt;
using tools::Random;

namespace {

constexpr double kPi = std::numbers::pi;

ChainResult answerOf(const Scene& scene, const Chain& chain, const ChainQuery& query) {
  return ChainSweeper(scene, chain, 1).run({&query, 1})[0];
}

Transform rotated(const tools::Rotation& rotation, const Vector& place) {
  return tools::makePose(rotation, {1, 1, 1}, place);
}

bool isContact(const Result& result) {
  return result.status == Status::hit || result.status == Status::overlap;
}

}  // namespace

TEST_CASE("a forearm folds back onto its own upper arm at the angle that geometry says") {
  Scene scene;
  // An upper arm along x, from 0 to 10 and 1 thick, and a forearm that is only a finger, (5.5, 1) to (6.5, 3) from the
  // joint at 10.
  const MeshId upper = add(scene, tools::makeBox({10, 1, 1})), finger = add(scene, tools::makeBox({1, 2, 1}));
  Chain chain;
  chain.variables = 2;
  const LinkMesh meshes[] = {{upper, placedAt({5, 0, 0})}, {finger, placedAt({6, 2, 0})}};
  chain.links = {{.joint = JointType::revolute, .axis = {0, 0, 1}, .variable = 0, .meshes = {meshes[0]}},
                 {.parent = 0,
                  .parentFromJoint = placedAt({10, 0, 0}),
                  .joint = JointType::revolute,
                  .axis = {0, 0, -2},
                  .variable = 1,
                  .meshes = {meshes[1]}}};
  const double from[] = {0.3, 0}, to[] = {1.3, -kPi};
  const ChainQuery query{.from = from, .to = to, .worldFromBase = placedAt({100, -50, 20})};
  CHECK(answerOf(scene, chain, query).contact.status == Status::clear);
  chain.pairs = {{0, 1}};
  const ChainResult folded = answerOf(scene, chain, query);
  // Its outer inner corner is the first to come down on the arm's upper side.
  const double expected = (kPi - std::asin(0.5 / std::hypot(5.5, 3)) - std::atan2(3, 5.5)) / kPi;
  CAPTURE(folded.contact.lo, folded.contact.hi, expected);
  REQUIRE(folded.contact.status == Status::hit);
  CHECK(folded.contact.lo <= expected + 1e-12);
  CHECK(folded.contact.hi >= expected - 1e-12);
  CHECK((folded.contact.hi - folded.contact.lo) * kPi * 7 < 1.1e-6 * 10);
  CHECK((folded.link == 0 && folded.otherLink == 1));
  CHECK(folded.contact.object == kNone);
  // In the world: 10 along the upper arm, which has turned by 0.3 and more, and back by what the corner is along it.
  const double turned = 0.3 + folded.contact.lo, back = std::sqrt(5.5 * 5.5 + 9 - 0.25);
  const Vector point{100 + (10 - back) * std::cos(turned) - 0.5 * std::sin(turned),
                     -50 + (10 - back) * std::sin(turned) + 0.5 * std::cos(turned), 0};
  CHECK(folded.contact.point[0] == Approx(point[0]).margin(1e-4));
  CHECK(folded.contact.point[1] == Approx(point[1]).margin(1e-4));
}

TEST_CASE("what a link meets only amid its arc, within it or beyond it, is found") {
  Random random(9);
  for (int trial = 0; trial < 400; ++trial) {
    Scene scene;
    const tools::MeshData one = tools::makeBox({0.1f, 1e-3f, 1e-3f});
    // A bar, or two that are opposite to each other, so that their middle stands.
    tools::MeshData moved = one;
    const bool isPair = random.oneIn(2);
    if (isPair) {
      for (const uint32_t vertex : one.indices) moved.indices.push_back(one.vertexCount() + vertex);
      moved.positions.insert(moved.positions.end(), one.positions.begin(), one.positions.end());
    }
    // Two bars on one ray from the axis amid the motion. They overlap there by a share of what the inner or the outer
    // one's arc differs from its chord.
    const double angle = random.uniform(0.02, 0.12), overlap = random.uniform(0.2, 0.8) * angle * angle / 8;
    const double inner = 0.95 + overlap, outer = 1.05;
    const bool isOuter = random.oneIn(2);
    const double radius = isOuter ? outer : inner;
    for (size_t i = 0; i < moved.positions.size(); i += 3) {
      moved.positions[i] += static_cast<float>(i < one.positions.size() ? radius : -radius);
    }
    const MeshId bar = add(scene, one), link = add(scene, moved);
    const Vector place = scaled(random.magnitude(-2, 2), random.direction());
    scene.addObject({.mesh = bar, .worldFromMesh = placedAt(along(place, 1, {isOuter ? inner : outer, 0, 0}))});
    Chain chain;
    chain.variables = 1;
    chain.links = {{.joint = JointType::revolute, .axis = {0, 0, 1}, .variable = 0, .meshes = {{link, {}}}}};
    const double from[] = {-angle / 2}, to[] = {angle / 2};
    const ChainQuery query{.from = from, .to = to, .worldFromBase = placedAt(place)};
    CAPTURE(trial, angle, overlap, isOuter, isPair, place[0]);
    CHECK(answerOf(scene, chain, query).contact.status == Status::hit);
  }
}

TEST_CASE("a chain of one joint turns as a turn does, and one of three slides as a step does") {
  Random random(1);
  Scene scene;
  const MeshId torus = add(scene, tools::makeTorus(1, 0.3, 12, 6));
  for (int i = 0; i < 12; ++i) scene.addObject({.mesh = torus, .worldFromMesh = random.affine(random.inCube(5))});
  int met = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Transform start = rotated(random.rotation(), random.inCube(5));
    Query asked{.mesh = torus, .worldFromMesh = start};
    Chain chain;
    std::vector<double> from, to;
    if (random.oneIn(3)) {
      asked.motion = random.inCube(6);
      for (uint32_t k = 0; k < 3; ++k) {
        Link link{.parent = k == 0 ? kNone : k - 1, .joint = JointType::prismatic, .axis = {}, .variable = k};
        link.axis[k] = 3;
        chain.links.push_back(link);
        to.push_back((*asked.motion)[k]);
      }
    } else {
      asked.turn = Turn{random.direction(), random.uniform(-4, 4), random.inCube(3)};
      for (int k = 0; k < 3; ++k) start.m[4 * k + 3] -= asked.turn->centre[k];
      chain.links = {{.parentFromJoint = placedAt(asked.turn->centre),
                      .joint = JointType::revolute,
                      .axis = asked.turn->axis,
                      .variable = 0}};
      to = {asked.turn->angle};
    }
    chain.links.back().meshes = {{torus, start}};
    chain.variables = static_cast<uint32_t>(to.size());
    from.resize(to.size());
    const Result expected = CpuSweeper(scene, 1).run({&asked, 1}).results[0];
    const ChainResult found = answerOf(scene, chain, {.from = from, .to = to});
    CAPTURE(trial, expected.lo, expected.hi, found.contact.lo, found.contact.hi);
    CHECK(found.contact.status == expected.status);
    if (!isContact(expected)) continue;
    ++met;
    CHECK(found.contact.lo <= expected.hi + 1e-9);
    CHECK(found.contact.hi >= expected.lo - 1e-9);
    if (expected.status == Status::hit) CHECK(found.contact.object == expected.object);
  }
  CHECK(met > 30);
}

TEST_CASE("random chains meet nothing before lo, and certainly something at hi") {
  const uint32_t seed = GENERATE(from_range(test::seeds({1, 2, 3})));
  Random random(seed);
  int statuses[5] = {}, links = 0, wide = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const double size = random.magnitude(-4, 4);
    const auto f = static_cast<float>(size);
    Scene scene;
    const MeshId meshes[] = {add(scene, tools::makeBox({f, 0.3f * f, 2 * f})),
                             add(scene, tools::makeTorus(f, 0.3f * f, 8, 5)),
                             add(scene, tools::makeRod(0.05f * f, 3 * f, 5))};
    const bool move = random.oneIn(4);
    for (int i = 0; i < 14; ++i) {
      const Vector way = move && random.oneIn(2) ? Vector(random.inCube(size)) : Vector{};
      scene.addObject({.mesh = meshes[random.below(3)],
                       .worldFromMesh = rotated(random.rotation(), random.inCube(6 * size)),
                       .mask = 1u << random.below(3),
                       .motion = way});
    }
    Chain chain;
    const uint32_t count = 1 + random.below(6);
    chain.variables = count;
    std::vector<double> from, to;
    const double much = 4 * std::pow(random.uniform(0, 1), 2);
    for (uint32_t i = 0; i < count; ++i) {
      const auto type = static_cast<JointType>(random.oneIn(6) ? 0 : random.oneIn(4) ? 2 : 1);
      Link link{.parent = i == 0            ? kNone
                          : random.oneIn(4) ? random.below(i)
                                            : i - 1,
                .parentFromJoint = rotated(random.rotation(), random.inCube(3 * size)),
                .joint = type,
                .axis = scaled(random.magnitude(-2, 2), random.direction()),
                .variable = random.oneIn(8) ? random.below(count) : i};
      for (uint32_t k = i + 1 == count ? 1 : random.below(3); k > 0; --k) {
        link.meshes.push_back({meshes[random.below(3)], rotated(random.rotation(), random.inCube(1.5 * size))});
      }
      for (uint32_t other = 0; other < i; ++other) {
        if (other != link.parent && random.oneIn(2)) chain.pairs.push_back({other, i});
      }
      chain.links.push_back(link);
    }
    for (uint32_t i = 0; i < count; ++i) {
      bool isLength = false;
      for (const Link& link : chain.links) isLength |= link.joint == JointType::prismatic && link.variable == i;
      const double unit = isLength ? size : 1;
      from.push_back(random.uniform(-3, 3) * unit);
      to.push_back(from.back() + random.uniform(-1, 1) * much * unit);
    }
    // A length for an angle, or the other way round, would be an odd motion.
    if (size > 100 || size < 0.01) {
      for (Link& link : chain.links) {
        if (link.joint == JointType::prismatic) link.joint = JointType::fixed;
      }
    }
    const double far = random.oneIn(3) ? random.magnitude(0, 3) * size : 0;
    ChainQuery query{.from = from, .to = to, .worldFromBase = rotated(random.rotation(), random.inCube(2 * size))};
    if (far > 0) {
      const Vector away = scaled(far, random.direction());
      for (int k = 0; k < 3; ++k) query.worldFromBase.m[4 * k + 3] += away[k];
      for (ObjectId id = 0; id < 14; ++id) {
        Transform pose = scene.object(id).worldFromMesh;
        for (int k = 0; k < 3; ++k) pose.m[4 * k + 3] += away[k];
        scene.setTransform(id, pose);
      }
    }
    if (random.oneIn(3)) query.mask = 3;
    if (random.oneIn(3)) query.exclude = {random.below(14)};
    if (random.oneIn(3)) query.clearance = random.uniform(0, 0.5) * size;
    const ChainResult answer = answerOf(scene, chain, query);
    const Result& found = answer.contact;
    ++statuses[static_cast<size_t>(found.status)];
    links += answer.otherLink != kNone;
    const test::ChainTruth truth(chain, query, scene);
    const double rounding = 1e-10 * size + 1e-13 * far;
    CAPTURE(seed, trial, size, far, count, found.lo, found.hi, query.clearance, static_cast<uint32_t>(found.status));
    const double free = found.status == Status::clear ? 1 : found.lo;
    for (int k = 0; k <= 60 && free > 0; ++k) REQUIRE(!truth.meet((1 - 1e-12) * free * k / 60, rounding));
    if (isContact(found)) REQUIRE(truth.meet(found.hi, query.clearance > 0 ? -rounding : 0));
    if (found.status == Status::hit) wide += found.hi - found.lo > 1e-4 + 1e-12 * far / size;
    if (isContact(found)) CHECK((answer.otherLink != kNone) != (found.object != kNone));
    query.anyHit = true;
    const Result any = answerOf(scene, chain, query).contact;
    CHECK((any.status == Status::hit) == isContact(found));
  }
  CAPTURE(seed, statuses[0], statuses[1], statuses[2], statuses[3], statuses[4], links);
  CHECK(statuses[static_cast<size_t>(Status::hit)] > 5);
  CHECK(statuses[static_cast<size_t>(Status::clear)] > 15);
  if (seed <= 3) CHECK(links > 0);
  CHECK(statuses[static_cast<size_t>(Status::undecided)] == 0);
  CHECK(wide <= 1);  // what touches gently gets deeper only later
}

TEST_CASE("of a chain's way that is cut at half way, the half that meets first does so at the same time") {
  Random random(4);
  Scene scene;
  const MeshId torus = add(scene, tools::makeTorus(1, 0.3, 12, 6));
  for (int i = 0; i < 12; ++i) scene.addObject({.mesh = torus, .worldFromMesh = random.affine(random.inCube(6))});
  Chain chain;
  chain.variables = 3;
  for (uint32_t i = 0; i < 3; ++i) {
    chain.links.push_back({.parent = i == 0 ? kNone : i - 1,
                           .parentFromJoint = rotated(random.rotation(), random.inCube(3)),
                           .joint = JointType::revolute,
                           .axis = random.direction(),
                           .variable = i,
                           .meshes = {{torus, rotated(random.rotation(), random.inCube(1))}}});
  }
  ChainSweeper sweeper(scene, chain);
  std::vector<std::array<double, 9>> configurations(200);  // start, middle, end
  std::vector<ChainQuery> queries;
  for (std::array<double, 9>& q : configurations) {
    for (size_t k = 0; k < 3; ++k) {
      q[k] = random.uniform(-3, 3);
      q[3 + k] = q[k] + random.uniform(-1, 1);
      q[6 + k] = q[3 + k] + (q[3 + k] - q[k]);
    }
    const std::span<const double, 9> all(q);
    queries.push_back({.from = all.first(3), .to = all.last(3)});
    queries.push_back({.from = all.first(3), .to = all.subspan(3, 3)});
    queries.push_back({.from = all.subspan(3, 3), .to = all.last(3)});
  }
  const std::vector<ChainResult> results = sweeper.run(queries);
  int met = 0;
  for (size_t i = 0; i < results.size(); i += 3) {
    const Result &whole = results[i].contact, &first = results[i + 1].contact, &second = results[i + 2].contact;
    CAPTURE(i, whole.lo, first.lo, second.lo);
    const bool isFirst = isContact(first);
    if (!isFirst && second.status == Status::overlap) continue;  // the seam is within the bracket
    const Result& half = isFirst ? first : second;
    CHECK(whole.status == half.status);
    if (!isContact(whole)) continue;
    ++met;
    const double from = isFirst ? 0 : 0.5;
    CHECK(from + half.lo / 2 <= whole.hi + 1e-12);
    CHECK(from + half.hi / 2 >= whole.lo - 1e-12);
    CHECK(results[i].link == results[i + (isFirst ? 1 : 2)].link);
  }
  CHECK(met > 20);
}

TEST_CASE("a clearance between links is a length in the world, though poses may be rigid only to a millionth") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  for (const double scale : {1 + 4.9e-7, 1 - 4.9e-7}) {
    // Two boxes at the end of seven poses, each of which scales by a little; they come nearer to 10 until the end.
    Transform slightly;
    for (int k = 0; k < 3; ++k) slightly.m[5 * k] = scale;
    Chain chain;
    chain.variables = 1;
    for (uint32_t i = 0; i < 6; ++i) {
      chain.links.push_back({.parent = i == 0 ? kNone : i - 1, .parentFromJoint = slightly});
    }
    chain.links[5].meshes = {{box, {}}};
    chain.links.push_back({.parent = 5, .joint = JointType::prismatic, .variable = 0, .meshes = {{box, {}}}});
    chain.pairs = {{5, 6}};
    const double all = std::pow(scale, 7), end = 11 + (scale > 1 ? -2e-5 : 2e-5);
    const double from[] = {12}, to[] = {end};
    const ChainQuery query{.from = from, .to = to, .worldFromBase = slightly, .clearance = 10};
    const Result found = answerOf(scene, chain, query).contact;
    CAPTURE(scale, found.lo, found.hi);
    const double gap = all * (end - 1);  // in the frame of either box, it is on the other side of 10
    CHECK(isContact(found) == (gap < 10));
    if (isContact(found)) CHECK(all * (12 + found.hi * (end - 12) - 1) < 10);
    if (isContact(found)) CHECK(all * (12 + found.lo * (end - 12) - 1) > 10);
  }
}

TEST_CASE("objects as far away as a scene may have them are clear of a chain") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  scene.addObject({.mesh = box, .worldFromMesh = placedAt({0x1p520, 0, 0})});
  scene.addObject({.mesh = box, .worldFromMesh = placedAt({0, -0x1p800, 0})});
  Chain chain;
  chain.variables = 1;
  chain.links = {{.joint = JointType::revolute, .variable = 0, .meshes = {{box, placedAt({3, 0, 0})}}}};
  const double from[] = {0}, to[] = {1};
  for (const double clearance : {0.0, 1.0}) {
    const ChainQuery query{.from = from, .to = to, .clearance = clearance};
    CHECK(answerOf(scene, chain, query).contact.status == Status::clear);
  }
}

TEST_CASE("a bracket is as narrow far from the origin of the world as near it") {
  for (const double far : {0.0, 1e6, 1e8}) {
    Scene scene;
    const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
    scene.addObject({.mesh = box, .worldFromMesh = placedAt({far + 3.25, 0.3, 0.2})});
    Chain chain;
    chain.variables = 1;
    chain.links = {{.joint = JointType::prismatic, .variable = 0, .meshes = {{box, {}}}}};
    const double from[] = {0}, to[] = {4};
    const ChainQuery query{.from = from, .to = to, .worldFromBase = placedAt({far, 0, 0}), .tolerance = 1e-9};
    const Result found = answerOf(scene, chain, query).contact;
    CAPTURE(far, found.lo, found.hi);
    REQUIRE(found.status == Status::hit);
    CHECK(found.lo <= 2.25 / 4);
    CHECK(found.hi >= 2.25 / 4);
    CHECK((found.hi - found.lo) * 4 <= 1e-9);
  }
}

TEST_CASE("a chain, or a question about one, that says nothing is refused by name") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  scene.addObject({.mesh = box, .worldFromMesh = placedAt({9, 9, 9})});
  Chain good;
  good.variables = 2;
  good.links = {{.joint = JointType::revolute, .variable = 0, .meshes = {{box, {}}}},
                {.parent = 0, .joint = JointType::prismatic, .variable = 1}};
  CHECK(validate(good, scene) == "");
  const auto wrong = [&](const auto& change) {
    Chain chain = good;
    change(chain);
    const std::string text = validate(chain, scene);
    CHECK_THROWS_WITH(ChainSweeper(scene, chain), "chain: " + text);
    return text;
  };
  CHECK(wrong([](Chain& c) { c.links[1].parent = 1; }) == "link 1: parent: expected a link before it, got 1");
  CHECK(wrong([](Chain& c) { c.links[0].axis = {}; }) == "link 0: axis: expected a vector that is not zero");
  CHECK(wrong([](Chain& c) { c.links[0].axis[2] = NAN; }) == "link 0: axis: expected 3 finite numbers, got nan");
  CHECK(wrong([](Chain& c) { c.links[1].variable = 2; }) == "link 1: variable: expected less than 2, got 2");
  CHECK(wrong([](Chain& c) { c.links[0].meshes[0].mesh = 7; }) == "link 0: mesh 0: mesh 7 of the scene does not exist");
  CHECK(wrong([](Chain& c) {
          c.links[0].parentFromJoint.m[0] = 2;
        }).starts_with("link 0: parentFromJoint: expected a rigid"));
  CHECK(wrong([](Chain& c) { c.pairs = {{1, 1}}; }) == "pair 0: expected two links below 2, got 1 and 1");
  const double from[] = {0, 0}, to[] = {1, 1e5};
  const ChainQuery asked{.from = from, .to = to};
  CHECK(validate(asked, good, scene) == "");
  const auto refused = [&](const auto& change) {
    ChainQuery query = asked;
    change(query);
    const std::string text = validate(query, good, scene);
    CHECK_THROWS_WITH(ChainSweeper(scene, good).run({&query, 1}), "query 0: " + text);
    return text;
  };
  const double far[] = {1e5, 0}, odd[] = {0, INFINITY};
  CHECK(refused([&](ChainQuery& q) { q.from = {from, 1}; }) == "from: expected 2 numbers, got 1");
  CHECK(refused([&](ChainQuery& q) { q.to = far; }) == "to: variable 0: expected an angle up to 2^16, got 1e+05");
  CHECK(refused([&](ChainQuery& q) { q.to = odd; }) == "to: variable 1: expected a length up to 2^300, got inf");
  CHECK(refused([](ChainQuery& q) { q.worldFromBase.m[5] = -2; }).starts_with("worldFromBase: expected a rigid pose"));
  CHECK(refused([](ChainQuery& q) { q.exclude = {5}; }) == "exclude: object 5 does not exist");
  CHECK(refused([](ChainQuery& q) { q.clearance = -1; }) == "clearance: expected 0 to 2^300, got -1");
  CHECK(refused([](ChainQuery& q) { q.tolerance = NAN; }).starts_with("tolerance: expected a finite number"));
  // Given up, it has no answers.
  std::stop_source stop;
  stop.request_stop();
  CHECK(ChainSweeper(scene, good).run({&asked, 1}, stop.get_token())[0].contact.status == Status::invalid);
}
