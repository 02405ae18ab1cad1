#include "agreement/random_options.h"

namespace radar::test {

namespace {

using soups::Random;
using tools::MeshData;
using tools::Vec3;
using tools::operator+;
using tools::operator-;
using tools::operator*;

constexpr size_t kQueries = 32;

MeshData shape(Random& random) {
  MeshData mesh;
  const auto corner = [&](int most) { return random.wholeVector(static_cast<uint32_t>(most)); };
  const Vec3 p = corner(1), q = p + random.latticeVector(2);
  switch (random.below(9)) {
    case 0:
      soups::addTriangle(mesh, {p, p, p});
      break;
    case 1:
      soups::addTriangle(mesh, {p, q, q});
      break;
    case 2:
      append(mesh,
             tools::makeGrid(1, tools::Diagonal::rising,
                             [](uint32_t x, uint32_t y) {
                               return Vec3{2.0 * x, 2.0 * y, 0};
                             }),
             p);
      break;
    case 3:
      return soups::soup(random, random.integer(1, 3), random.uniform(0.3, 1), 0.2);
    case 4:
    case 5:
      return soups::lattice(random, random.integer(1, 4), 2);
    default: {
      const Vec3 size{double(random.integer(1, 3)), double(random.integer(1, 3)), double(random.integer(1, 2))};
      append(mesh, tools::makeBox(size), 0.5 * size);
    }
  }
  return mesh;
}

/// Half a lattice's step apart; in the common pose.
Transform placed(Random& random, const Transform& rest, int reach) {
  Transform pose = rest;
  const Vec3 at = 0.5 * random.wholeVector(static_cast<uint32_t>(2 * reach));
  tools::moveBy(pose, tools::turned(tools::linearPart(rest), at));
  if (random.chance(0.1)) tools::moveBy(pose, 0x1p-50 * random.wholeVector(3));
  if (random.chance(0.1)) tools::moveBy(pose, random.inCube(1));
  return pose;
}

double quarters(Random& random, int most) {
  return 0.25 * random.integer(1, most);
}

void addOptions(Random& random, uint32_t options, const Scene& scene, uint32_t objects, Query& query) {
  if ((options & kExclude) != 0 && objects > 0) {
    for (int i = random.integer(1, 2); i-- > 0;) query.exclude.push_back(random.below(objects));
  }
  if ((options & kMask) != 0) query.mask = random.chance(0.1) ? 0 : 1u << random.below(2);
  query.skipOverlapping = (options & kSkipOverlapping) != 0;
  query.ignoreLeaving = (options & kIgnoreLeaving) != 0;
  // Alone, the next two options change nothing.
  if ((options & kSlack) != 0 && (options & (kIgnoreLeaving | kSkipOverlapping)) == 0) {
    query.ignoreLeaving = random.chance(0.5);
    query.skipOverlapping = random.chance(0.3);
  }
  if ((options & kTolerance) != 0 && random.chance(0.7)) options |= kClearance;
  query.anyHit = (options & kDecide) != 0;
  if ((options & kHits) != 0) query.hits = random.chance(0.5) ? kAllHits : 2 + random.below(2);
  if ((options & kClearance) != 0) {
    query.clearance = random.chance(0.6)   ? quarters(random, 5)
                      : random.chance(0.8) ? std::exp(random.uniform(-7, 1))
                                           : random.magnitude(-300, -9);
  }
  if ((options & kTolerance) != 0) query.tolerance = random.chance(0.3) ? 0 : std::exp(random.uniform(-24, -3));
  if ((options & kSlack) != 0) {
    const double most =
        std::max(tools::boundsOf(scene.mesh(query.mesh), query.worldFromMesh).longest(), query.clearance);
    query.slack = random.chance(0.3) ? 0 : 0.0999 * most * (random.chance(0.4) ? 1e-9 : random.uniform(0, 1));
  }
}

}  // namespace

std::vector<Query> drawn(Random& random, uint32_t options, Scene& scene) {
  tools::Workload nothing;
  nothing.scenes.emplace_back();
  replaceBy(nothing, 0, scene);
  const bool moves = (options & kMotion) != 0;
  Transform rest;
  if (random.chance(0.2)) rest = tools::makePose(random.quarterTurns(), {0.5, 0.5, 0.5}, {3, 0, -1});
  if (random.chance(0.15)) rest = random.pose(random.uniform(0.3, 2), random.inCube(5));
  if (random.chance(0.1)) rest.m[0] = -rest.m[0], rest.m[4] = -rest.m[4], rest.m[8] = -rest.m[8];
  const auto motion = [&] { return random.chance(0.3) ? 2 * random.inCube(1) : 0.5 * random.wholeVector(8); };
  const uint32_t meshes = 3;
  for (uint32_t i = 0; i < meshes; ++i) add(scene, shape(random));
  const uint32_t objects = random.oneIn(20) ? 0 : 1 + random.below(5);
  const bool moving = moves && random.chance(0.7);
  for (uint32_t i = 0; i < objects; ++i) {
    const Vec3 way = moving && random.chance(0.7) ? motion() : Vec3{};
    scene.addObject({random.below(meshes), placed(random, rest, 2), random.chance(0.4) ? ~0u : random.below(4), way});
  }
  std::vector<Query> queries(kQueries);
  for (Query& query : queries) {
    query.mesh = random.below(meshes);
    query.worldFromMesh = placed(random, rest, 3);
    const bool isAxis = random.chance(0.4);
    query.direction = isAxis ? random.axis() : random.latticeVector(2);
    if (random.chance(0.8)) query.direction = tools::turned(tools::linearPart(rest), query.direction);
    const Vec3 ahead = objects == 0
                           ? Vec3{}
                           : placeOf(scene.object(random.below(objects)).worldFromMesh) - placeOf(query.worldFromMesh);
    if (ahead != Vec3{} && random.chance(0.4)) query.direction = ahead;
    if (random.chance(0.1)) query.direction = random.inBall();
    query.distance = random.chance(0.1) ? 0 : isAxis ? 0.25 * random.integer(1, 30) : random.uniform(0, 8);
    if (moves && !(moving && random.chance(0.4))) {
      query.motion = motion();
      query.direction = {};
      query.distance = 0;
    }
    addOptions(random, options, scene, objects, query);
  }
  return queries;
}

}  // namespace radar::test
