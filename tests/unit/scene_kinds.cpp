#include "scene_kinds.h"

#include "cpu_wild_scenes.h"
#include "normal_scenes.h"
#include "workloads/hard_cases.h"
#include "workloads/voxels.h"

namespace kinds {

namespace {

using namespace radar;
using test::add;
using test::at;
using test::placeOf;
using tools::operator+;
using tools::operator-;
using tools::operator*;
using tools::Vec3;

Vec3 turnedBy(const Transform& pose, const Vec3& v) {
  return tools::turned(tools::linearPart(pose), v);
}

/// Of about the size `scale`, up to `far` from the origin.
void makeSoups(Random& random, double scale, double far, Case& out) {
  const Vec3 centre{far * random.uniform(-1, 1), far * random.uniform(-1, 1), far};
  const auto near = [&](double spread) { return centre + scale * spread * random.inBall(); };
  for (int m = 0; m < 3; ++m) {
    add(out.scene, soups::soup(random, random.integer(1, 14), random.uniform(0.05, 0.7), 0.2));
  }
  for (int i = random.integer(1, 5); i-- > 0;) {
    const Transform pose = random.pose(scale * random.uniform(0.3, 2), near(4));
    out.scene.addObject({random.below(3), pose, random.chance(0.2) ? 1u : ~0u});
  }
  for (int i = 0; i < 4; ++i) {
    Query query{.mesh = random.below(3)};
    query.worldFromMesh = random.pose(scale * random.uniform(0.3, 1), near(random.chance(0.3) ? 0.5 : 4));
    query.direction = random.inBall();
    if (random.chance(0.5)) {
      query.direction = placeOf(out.scene.object(0).worldFromMesh) - placeOf(query.worldFromMesh);
    }
    if (random.chance(0.2)) query.direction = {0, 0, random.chance(0.5) ? 2.0 : -3.0};
    query.distance = random.chance(0.1) ? 0 : random.chance(0.1) ? 1e12 : scale * random.uniform(0, 8);
    if (random.chance(0.2)) query.exclude = {0};
    if (random.chance(0.2)) query.mask = 2;
    out.queries.push_back(query);
  }
}

void soupsAnywhere(Random& random, Case& out) {
  constexpr std::array<std::array<double, 2>, 6> kScaleAndFar{
      {{1e-4, 1}, {1e4, 0}, {1, 1e7}, {1e-4, 1e5}, {1e-60, 0}, {1e60, 0}}};
  const auto [scale, far] = kScaleAndFar[random.below(6)];
  makeSoups(random, scale, far, out);
}

void tinyBesideHuge(Random& random, Case& out) {
  const MeshId a = add(out.scene, soups::soup(random, 10, 0.6, 0.1)),
               b = add(out.scene, soups::soup(random, 10, 1.5, 0.1));
  const double sizeA = std::pow(10, random.uniform(-4, 4)), sizeB = std::pow(10, random.uniform(-4, 4));
  const double size = std::max(sizeA, sizeB);
  out.scene.addObject({b, random.pose(sizeB, {0, 0, 0})});
  out.scene.addObject({a, random.pose(sizeA, {0, 0, 5 * sizeA})});
  Query query{.mesh = a, .direction = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 1}, .distance = 20 * size};
  query.worldFromMesh =
      random.pose(sizeA, {0.5 * sizeB * random.uniform(-1, 1), 0.5 * sizeB * random.uniform(-1, 1), -2 * size});
  out.queries.push_back(query);
}

/// `nudged`: objects are moved by single ulps.
void makeLattices(Random& random, bool nudged, Case& out) {
  const int side = random.integer(1, 5);
  const auto mesh = [&] { return add(out.scene, soups::lattice(random, random.integer(1, 12), side)); };
  const MeshId sensor = mesh();
  for (int i = random.integer(1, 3); i-- > 0;) {
    Transform pose = at(random.integer(-2, 2), random.integer(-2, 2), random.integer(0, 8));
    double& c = pose.m[4 * random.below(3) + 3];
    if (nudged && random.chance(0.7)) c = std::nextafter(c, random.chance(0.5) ? 100 : -100);
    out.scene.addObject({mesh(), pose});
  }
  for (int q = 0; q < 3; ++q) {
    Query query{.mesh = sensor, .distance = double(random.integer(0, 12))};
    while (query.direction == Vec3{}) {
      for (double& c : query.direction) c = random.chance(0.4) ? 0 : random.integer(-3, 3);
    }
    out.queries.push_back(query);
  }
}

void wildWithExtremeDirections(Random& random, Case& out) {
  wild::make(random, 1, out);
  const bool greatest = random.chance(0.5);
  for (Query& query : out.queries) {
    for (double& c : query.direction) c = std::ldexp(std::rint(3 * random.uniform(-1, 1)), greatest ? 1021 : -1074);
    if (query.direction == Vec3{}) query.direction[0] = std::ldexp(1.0, greatest ? 1023 : -1074);
  }
}

void wildWithAnyDistance(Random& random, Case& out) {
  wild::make(random, random.uniform(1, 30), out);
  for (Query& query : out.queries) {
    query.distance = std::min(query.distance * wild::power(random, random.chance(0.5) ? 12 : 60), 1e300);
  }
}

Vec3 anyMotion(Random& random, double scale) {
  if (random.chance(0.2)) return {};
  const bool whole = random.chance(0.5);
  return whole ? scale * random.wholeVector(3) : 4 * scale * random.inBall();
}

/// Solids that fit each other, in a common pose, and sometimes a lattice. The first is at rest, beside it, or turned.
void makeSolids(Random& random, uint32_t mostSide, size_t queries, Case& out) {
  const uint32_t side = 2 + random.below(mostSide - 1), count = 2 + random.below(4);
  Transform rest;
  if (random.chance(0.6)) rest = random.pose(std::exp(random.uniform(-6, 6)), {random.uniform(-50, 50), 0, 3});
  for (const tools::Solid& solid : tools::packedSolids(side, count, random)) {
    const MeshId mesh = add(out.scene, tools::boundaryOf(solid, random));
    if (mesh != 0) out.scene.addObject({mesh, rest});
  }
  if (random.chance(0.3)) {
    out.scene.addObject({add(out.scene, soups::lattice(random, random.integer(1, 12), 3)), rest});
  }
  while (out.queries.size() < queries) {
    Query query{.mesh = 0, .worldFromMesh = rest, .direction = random.latticeVector(2)};
    if (random.chance(0.5)) query.direction = turnedBy(rest, query.direction);
    if (random.chance(0.2)) query.direction = random.inBall();
    if (random.chance(0.2)) query.worldFromMesh.m[3] += random.uniform(-3, 3);
    if (random.chance(0.1)) query.worldFromMesh = random.pose(1, {0, 0, 0});
    if (random.chance(0.2)) {
      for (size_t k : {0, 4, 8}) query.worldFromMesh.m[k] = -query.worldFromMesh.m[k];
    }
    query.distance = random.chance(0.1) ? 0 : random.uniform(0, 20);
    query.ignoreLeaving = !random.chance(0.1);
    if (random.chance(0.4)) query.slack = random.chance(0.5) ? 0 : random.uniform(0, 0.3);
    // A large slack beside a small sensor is refused.
    if (!validate(query, out.scene).empty()) *query.slack *= 1e-3;
    out.queries.push_back(query);
  }
}

/// Equal boxes pressed together, though rounding has let them pass each other.
void pressedBoxes(Random& random, Case& out) {
  const MeshId box = add(out.scene, tools::makeBox({1, 1, 1}));
  const Transform rest = random.chance(0.5) ? at(0, 0, random.uniform(-9, 9)) : random.pose(1, {1, 2, 3});
  out.scene.addObject({box, rest});
  for (int i = 0; i < 40; ++i) {
    Query query{.mesh = box, .worldFromMesh = rest, .distance = random.chance(0.5) ? 0.5 : 5, .ignoreLeaving = true};
    const double sunk = i % 4 == 0 ? random.uniform(0, 1e-3) : random.integer(-2, 2) * 0x1p-52;
    const Vec3 up = turnedBy(rest, {0, 0, 1});
    tools::moveBy(query.worldFromMesh, (1 - sunk) * up);
    query.direction = Vec3{} - up;
    if (i % 3 == 0) query.direction = query.direction + random.inCube(1);
    if (i % 4 == 0) query.slack = 1e-3;
    out.queries.push_back(query);
  }
}

/// Boxes that slide along each other but for a rounding, and so never touch.
void slidingBoxes(Random& random, Case& out) {
  const MeshId box = add(out.scene, tools::makeBox({1, 1, 1})), longBox = add(out.scene, tools::makeBox({2.5, 1, 1}));
  const Transform rest = random.pose(std::exp(random.uniform(-9, 1)), random.inBall());
  out.scene.addObject({box, rest});
  for (int i = 0; i < 40; ++i) {
    Query query{.mesh = longBox, .worldFromMesh = rest, .distance = random.uniform(0, 5), .ignoreLeaving = true};
    tools::moveBy(query.worldFromMesh, turnedBy(rest, {random.uniform(-1.5, 1.5), 0, 1}));
    query.direction = turnedBy(rest, {i % 2 == 0 ? 1.0 : -1.0, 0, -std::exp(random.uniform(-37, -29))});
    out.queries.push_back(query);
  }
}

/// Faces pressed together that touch a rounding ahead.
void facesAhead(Random& random, Case& out) {
  const MeshId large = add(out.scene, {"", {-1, -1, 0, 3, -1, 0, -1, 3, 0}, {0, 1, 2}}),
               small = add(out.scene, {"", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 2, 1}});
  const Transform rest = random.pose(1, {random.uniform(-1e5, 1e5), 3, 5});
  out.scene.addObject({large, rest});
  for (int i = 0; i < 20; ++i) {
    Query query{.mesh = small, .worldFromMesh = rest, .distance = 5, .ignoreLeaving = true};
    tools::moveBy(query.worldFromMesh, turnedBy(rest, {0, 0, random.uniform(0, 1e-10)}));
    query.direction = turnedBy(rest, {random.uniform(-1, 1), 0, -1});
    out.queries.push_back(query);
  }
}

/// Soups with a clearance; poses stretch one axis by up to 1e11.
void slivers(Random& random, Case& out) {
  const double stretch = std::pow(10.0, random.integer(0, 11));
  const auto mesh = [&] {
    return add(out.scene, soups::soup(random, random.integer(1, 6), random.uniform(0.05, 0.7), 0.2));
  };
  const bool isStretched = random.chance(0.75);
  const auto pose = [&](double scale) {
    Transform placed = random.pose(scale, 4 * random.inBall());
    const size_t axis = random.below(3);
    for (size_t i = 0; i < 3 && isStretched; ++i) placed.m[4 * i + axis] *= stretch;
    return placed;
  };
  const MeshId sensor = mesh(), other = mesh();
  for (int i = random.integer(1, 3); i-- > 0;) out.scene.addObject({other, pose(random.uniform(0.3, 2))});
  for (int i = 0; i < 4; ++i) {
    Query query{.mesh = sensor, .worldFromMesh = pose(random.uniform(0.3, 1))};
    query.direction = placeOf(out.scene.object(0).worldFromMesh) - placeOf(query.worldFromMesh) + random.inBall();
    query.distance = random.uniform(0, 12) * (random.chance(0.5) ? stretch : 1);
    query.clearance = std::exp(random.uniform(-7, 1)) * (random.chance(0.3) ? stretch : 1);
    if (random.chance(0.3)) query.tolerance = random.chance(0.3) ? 0 : std::exp(random.uniform(-20, -3));
    out.queries.push_back(query);
  }
}

void stepsAnywhere(Random& random, Case& out) {
  const double scale = random.chance(0.25) ? std::exp(random.uniform(-100, 100)) : 1;
  makeStep(random, scale, random.chance(0.2) ? 1e4 * scale : 0, out);
}

/// The scene scaled, then moved along x and y, or at another scale where products of coordinates overflow or underflow.
void place(Random& random, Case& out) {
  constexpr std::array<std::array<double, 2>, 6> kScaleAndFar{
      {{1.1, 4000}, {1e-100, 0}, {1e-151, 0}, {1e151, 0}, {1e-200, 0}, {1e200, 0}}};
  const auto [scale, far] = kScaleAndFar[random.below(6)];
  const auto placed = [&, scale = scale, far = far](Transform pose) {
    for (double& c : pose.m) c *= scale;
    tools::moveBy(pose, {far, -far / 3, 0});
    return pose;
  };
  for (ObjectId id = 0; id < out.scene.objectLimit(); ++id) {
    out.scene.setTransform(id, placed(out.scene.object(id).worldFromMesh));
  }
  const double clearance = random.chance(0.3) ? scale * random.uniform(0.01, 0.5) : 0;
  for (Query& query : out.queries) {
    query.worldFromMesh = placed(query.worldFromMesh);
    query.distance *= 10 * scale;
    query.clearance = clearance;
  }
}

void tiesAnywhere(Random& random, Case& out) {
  normals::lattices(random, random.chance(0.5), out);
  place(random, out);
}

void floatsAnywhere(Random& random, Case& out) {
  normals::floats(random, 1, out);
  place(random, out);
}

constexpr uint64_t kMostPairs = 1000;

/// A case of a family, unless it has too many triangles for brute force.
void hardCase(Random& random, bool atRest, Case& out) {
  const std::vector<tools::HardFamily>& families = tools::hardFamilies();
  const tools::HardFamily* family = nullptr;
  while (family == nullptr || family->ignoresLeaving != atRest) family = &families[random.below(families.size())];
  const tools::HardCase hard = tools::hardCase(*family, 23, random.below(300));
  uint64_t pairs = 0;
  for (const tools::PlacedMesh& object : hard.objects) {
    pairs += uint64_t{object.mesh.triangleCount()} * hard.sensor.mesh.triangleCount();
  }
  if (pairs > kMostPairs) return;
  const tools::Workload workload = tools::sceneOf({hard}, tools::Company::isolated);
  replaceBy(workload, 0, out.scene);
  out.queries = tools::queriesOf(workload.queries);
  if (atRest) out.queries[0].hits = kAllHits;
}

constexpr Kind kKinds[]{
    {"soups", [](Random& random, Case& out) { makeSoups(random, 1, 0, out); }, 150, 20, 70},
    {"soups at every scale and far from the origin", soupsAnywhere, 240, 20, 110},
    {"tiny sensors beside huge objects, and the other way round", tinyBesideHuge, 150, 20, 50},
    {"integer lattices", [](Random& random, Case& out) { makeLattices(random, false, out); }, 400, 20, 300},
    {"lattices moved by single ulps", [](Random& random, Case& out) { makeLattices(random, true, out); }, 150, 20, 100},
    {"sizes at the limits of doubles", [](Random& random, Case& out) { wild::make(random, 150, out); }, 40, 0, 60,
     1e-9},
    {"nearly singular poses", [](Random& random, Case& out) { wild::make(random, 3, out); }, 40, 60, 60, 1e-9},
    {"directions at the limits of doubles", wildWithExtremeDirections, 60, 20, 60, 1e-9},
    {"distances at the limits of floats", wildWithAnyDistance, 20, 200, 25, 1e-9},
    {"steps, in which objects move, too", stepsAnywhere, 400, 40, 400},
    {"small solids at rest", [](Random& random, Case& out) { makeSolids(random, 2, 4, out); }, 250, 0, 200},
    {"solids at rest", [](Random& random, Case& out) { makeSolids(random, 5, 48, out); }, 0, 60, 0},
    {"boxes pressed together", pressedBoxes, 20, 20, 500},
    {"boxes that slide along each other", slidingBoxes, 10, 30, 50},
    {"faces pressed together that touch a rounding ahead", facesAhead, 20, 20, 100},
    {"boxes on a lattice", [](Random& random, Case& out) { normals::boxes(random, false, out); }, 400, 20, 300},
    {"boxes on one floor", [](Random& random, Case& out) { normals::boxes(random, true, out); }, 300, 20, 300},
    {"ties of lattices", [](Random& random, Case& out) { normals::lattices(random, false, out); }, 1500, 20, 1000},
    {"ties of lattices at extreme scales and far away", tiesAnywhere, 600, 0, 200},
    {"soups at extreme scales and far away", floatsAnywhere, 200, 0, 50},
    {"triangles in one plane", [](Random& random, Case& out) { normals::lattices(random, true, out); }, 400, 20, 300},
    {"needles",
     [](Random& random, Case& out) { normals::floats(random, std::pow(10.0, 4 * random.integer(-1, 2)), out); }, 400,
     20, 100, 1e-9},
    {"meetings of corners and borders", normals::meetings, 2000, 60, 1000},
    {"hard cases", [](Random& random, Case& out) { hardCase(random, false, out); }, 900, 60, 300},
    {"bodies at rest", [](Random& random, Case& out) { hardCase(random, true, out); }, 1400, 100, 250},
    {"slivers with a clearance", slivers, 0, 600, 0},
};

}  // namespace

std::span<const Kind> all() {
  return kKinds;
}

void makeStep(Random& random, double scale, double far, Case& out) {
  const Vec3 centre{far * random.uniform(-1, 1), far, 0};
  const bool onLattice = random.chance(0.4);
  const auto mesh = [&] {
    return add(out.scene, onLattice ? soups::lattice(random, random.integer(1, 8), 2)
                                    : soups::soup(random, random.integer(1, 10), random.uniform(0.1, 0.7), 0.2));
  };
  const auto pose = [&](double spread) {
    if (onLattice)
      return tools::makePose(tools::kUpright, {scale, scale, scale}, centre + scale * random.wholeVector(3));
    return random.pose(scale * random.uniform(0.3, 2), centre + scale * spread * random.inBall());
  };
  for (int i = random.integer(1, 6); i-- > 0;) {
    out.scene.addObject({mesh(), pose(4), random.chance(0.2) ? 1u : ~0u, anyMotion(random, scale)});
  }
  const MeshId sensor = mesh();
  for (int i = 0; i < 6; ++i) {
    Query query{.mesh = sensor, .worldFromMesh = pose(random.chance(0.3) ? 0.5 : 4)};
    query.motion = anyMotion(random, scale);
    if (random.chance(0.2)) query.exclude = {0};
    if (random.chance(0.2)) query.mask = 2;
    out.queries.push_back(query);
  }
}

void vary(Random& random, Query& query) {
  query.ignoreLeaving = random.chance(0.6);
  query.skipOverlapping = random.chance(0.5);
  query.hits = random.chance(0.3) ? 1 : random.chance(0.5) ? kAllHits : 2 + random.below(2);
}

}  // namespace kinds
