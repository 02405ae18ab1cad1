// Queries that ignore what they leave, skip what overlaps or list several contacts: compares the CPU's answers with
// brute force by the definition, and with the truth about solids.
#include "blocking_oracle.h"
#include "radar/cpu_sweeper.h"
#include "voxel_solids.h"

using namespace radar;
using oracle::Rational;
using soups::Random;

namespace {

double magnitude(const Scene& scene, MeshId mesh, const Transform& pose) {
  double greatest = 0;
  const MeshView view = scene.mesh(mesh);
  std::array<double, 3> most{};
  for (size_t i = 0; i < view.positions.size(); ++i) {
    most[i % 3] = std::max(most[i % 3], std::abs(double{view.positions[i]}));
  }
  for (size_t i = 0; i < 3; ++i) {
    double sum = std::abs(pose.m[4 * i + 3]);
    for (size_t k = 0; k < 3; ++k) sum += std::abs(pose.m[4 * i + k]) * most[k];
    greatest = std::max(greatest, sum);
  }
  return greatest;
}

double slackFor(const Scene& scene, const Query& query, ObjectId id) {
  const Object& object = scene.object(id);
  return query.slack.value_or(0x1p-48 * std::max(magnitude(scene, query.mesh, query.worldFromMesh),
                                                 magnitude(scene, object.mesh, object.worldFromMesh)));
}

bool isMirrored(const Transform& pose) {
  using oracle::RationalVec;
  const auto row = [&](size_t i) {
    return RationalVec{Rational(pose.m[4 * i]), Rational(pose.m[4 * i + 1]), Rational(pose.m[4 * i + 2])};
  };
  return oracle::dot(row(0), oracle::cross(row(1), row(2))) < 0;
}

/// The first contact that counts, by brute force.
oracle::Answer truthOf(const Scene& scene, const Query& query) {
  const bool mirroredA = isMirrored(query.worldFromMesh);
  const auto counts = [&](ObjectId id, const oracle::Corners& a, const oracle::Corners& b) {
    if (!query.ignoreLeaving) return true;
    const bool mirroredB = isMirrored(scene.object(id).worldFromMesh);
    return oracle::blocks(a, mirroredA, b, mirroredB, query.direction, slackFor(scene, query, id));
  };
  const auto touches = [&](ObjectId id, const oracle::Corners& a, const oracle::Corners& b) {
    if (!query.ignoreLeaving) return false;
    const bool mirroredB = isMirrored(scene.object(id).worldFromMesh);
    return oracle::arePressed(a, mirroredA, b, mirroredB, query.direction, slackFor(scene, query, id));
  };
  return oracle::answer(scene, query, counts, touches);
}

bool surfacesCross(const Scene& scene, const Query& query, ObjectId id) {
  const Object& object = scene.object(id);
  const MeshView sensor = scene.mesh(query.mesh), mesh = scene.mesh(object.mesh);
  for (uint32_t triA = 0; triA < sensor.triangleCount(); ++triA) {
    for (uint32_t triB = 0; triB < mesh.triangleCount(); ++triB) {
      const oracle::Corners a = oracle::corners(sensor, query.worldFromMesh, triA);
      const oracle::Corners b = oracle::corners(mesh, object.worldFromMesh, triB);
      const auto interval = oracle::contact(a, b, query.direction);
      if (!interval || interval->first.sign() > 0 || interval->last.sign() < 0) continue;
      if (oracle::cross(a, b, slackFor(scene, query, id))) return true;
    }
  }
  return false;
}

/// Checks an answer and its lists by brute force.
void check(const Scene& scene, const Query& asked) {
  CpuSweeper sweeper(scene, 1);
  const Result result = sweeper.run({&asked, 1})[0];
  Query query = asked;
  if (asked.skipOverlapping) {
    std::vector<ObjectId> crossing;
    for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
      const bool isExcluded = std::find(asked.exclude.begin(), asked.exclude.end(), id) != asked.exclude.end();
      if (!isExcluded && (scene.object(id).mask & asked.mask) != 0 && surfacesCross(scene, asked, id)) {
        crossing.push_back(id);
      }
    }
    const auto listed = sweeper.lists().overlappingOf(0);
    REQUIRE(std::vector(listed.begin(), listed.end()) == crossing);
    query.exclude.insert(query.exclude.end(), crossing.begin(), crossing.end());
  }
  soups::checkTruth(truthOf(scene, query), query, result);
  if (asked.hits == 1) {
    REQUIRE(sweeper.lists().hitsOf(0).empty());
    return;
  }
  // Each object alone.
  std::vector<std::pair<oracle::Answer, ObjectId>> alone;
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (std::find(query.exclude.begin(), query.exclude.end(), id) != query.exclude.end()) continue;
    Query one = query;
    for (ObjectId other = 0; other < scene.objectLimit(); ++other) {
      if (other != id) one.exclude.push_back(other);
    }
    if (const oracle::Answer truth = truthOf(scene, one); truth.found) alone.emplace_back(truth, id);
  }
  std::stable_sort(alone.begin(), alone.end(),
                   [](const auto& p, const auto& q) { return oracle::compare(p.first.s, q.first.s) < 0; });
  if (alone.size() > asked.hits) alone.resize(asked.hits);
  const auto hits = sweeper.lists().hitsOf(0);
  REQUIRE(hits.size() == alone.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    REQUIRE(hits[i].object == alone[i].second);
    soups::checkTruth(alone[i].first, query, hits[i]);
  }
}

/// A packing of solids, of which the first is the sensor.
struct Assembly {
  Scene scene;
  std::vector<voxels::Solid> solids;
  std::vector<MeshId> meshes;
};

Assembly assembly(Random& random, int side) {
  Assembly out;
  while (out.solids.empty() || out.solids[0].empty()) out.solids = voxels::packing(random, side, random.integer(2, 4));
  std::erase_if(out.solids, [](const voxels::Solid& solid) { return solid.empty(); });
  for (const voxels::Solid& solid : out.solids) {
    out.meshes.push_back(soups::add(out.scene, voxels::boundary(solid, random)));
  }
  return out;
}

/// A pose that turns the axes into one another, some of them reversed, times a power of two.
Transform turnedAxes(Random& random) {
  Transform pose;
  pose.m.fill(0);
  const int first = random.integer(0, 2), step = random.integer(1, 2);
  const double scale = std::ldexp(1.0, random.integer(-2, 2));
  for (int i = 0; i < 3; ++i) {
    pose.m[4 * i + (first + step * i) % 3] = random.chance(0.5) ? scale : -scale;
    pose.m[4 * i + 3] = random.integer(-3, 3);
  }
  return pose;
}

std::array<int, 3> latticeDirection(Random& random, bool generic) {
  std::array<int, 3> d{};
  while (d == std::array<int, 3>{} || (generic && (d[0] == 0 || d[1] == 0 || d[2] == 0))) {
    for (int& c : d) c = random.integer(-2, 2);
  }
  return d;
}

std::array<double, 3> turned(const Transform& pose, const std::array<int, 3>& d) {
  std::array<double, 3> out;
  for (size_t i = 0; i < 3; ++i) out[i] = pose.m[4 * i] * d[0] + pose.m[4 * i + 1] * d[1] + pose.m[4 * i + 2] * d[2];
  return out;
}

/// The least s over all solids, or -1.
Rational truthOf(const Assembly& made, const std::array<int, 3>& direction) {
  Rational best = -1;
  for (size_t i = 1; i < made.solids.size(); ++i) {
    const Rational s = voxels::begins(made.solids[0], made.solids[i], direction);
    if (s >= 0 && (best < 0 || s < best)) best = s;
  }
  return best;
}

}  // namespace

TEST_CASE("solids that fit exactly move until their interiors would meet") {
  Random random(1);
  int blocked = 0, free = 0, later = 0;
  for (int i = 0; i < 3000; ++i) {
    INFO("case " << i);
    Assembly made = assembly(random, random.integer(2, 5));
    const Transform pose = turnedAxes(random);
    for (size_t k = 1; k < made.meshes.size(); ++k) made.scene.addObject({made.meshes[k], pose});
    const std::array<int, 3> direction = latticeDirection(random, false);
    Query query{.mesh = made.meshes[0], .worldFromMesh = pose, .direction = turned(pose, direction), .distance = 1000};
    query.ignoreLeaving = true;
    if (random.chance(0.5)) query.slack = 0;
    const Result result = CpuSweeper(made.scene, 1).run({&query, 1})[0];
    const Rational truth = truthOf(made, direction);
    if (truth < 0) {
      REQUIRE(result.status == Status::clear);
      ++free;
    } else if (truth == 0) {
      REQUIRE(result.status == Status::overlap);
      ++blocked;
    } else {
      REQUIRE(result.status == Status::hit);
      const auto& d = query.direction;
      REQUIRE(result.t == Approx(truth.convert_to<double>() * std::hypot(d[0], d[1], d[2])).epsilon(1e-14));
      ++later;
    }
  }
  REQUIRE(blocked > 200);
  REQUIRE(free > 200);
  REQUIRE(later > 100);
}

TEST_CASE("solids at rest in rotated poses move as they would unrotated") {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    INFO("case " << i);
    Assembly made = assembly(random, random.integer(2, 5));
    const Transform pose = random.pose(std::exp(random.uniform(-5, 5)), {random.uniform(-9, 9), 0, 7});
    for (size_t k = 1; k < made.meshes.size(); ++k) made.scene.addObject({made.meshes[k], pose});
    const std::array<int, 3> direction = latticeDirection(random, true);
    Query query{.mesh = made.meshes[0], .worldFromMesh = pose, .direction = turned(pose, direction), .distance = 1e6};
    // Rounded once more, so that surfaces that touched may cross.
    for (size_t k : {3, 7, 11}) query.worldFromMesh.m[k] *= 1 + 0x1p-53 * random.integer(-1, 1);
    query.ignoreLeaving = true;
    const Result result = CpuSweeper(made.scene, 1).run({&query, 1})[0];
    const Rational truth = truthOf(made, direction);
    if (truth < 0) {
      REQUIRE(result.status == Status::clear);
    } else if (truth == 0) {
      REQUIRE(result.status != Status::clear);
      REQUIRE(result.t <= 1e-12);
    } else {
      const auto& d = query.direction;
      REQUIRE(result.t == Approx(truth.convert_to<double>() * std::hypot(d[0], d[1], d[2])).epsilon(1e-9));
    }
  }
}

TEST_CASE("queries that ignore what they leave equal brute force on solids and on lattice soups") {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    INFO("case " << i);
    const bool solid = random.chance(0.5);
    Assembly made = assembly(random, 2);
    if (!solid) {
      for (MeshId& mesh : made.meshes) mesh = soups::add(made.scene, soups::lattice(random, random.integer(1, 8), 2));
    }
    const auto pose = [&] { return random.chance(0.6) ? Transform() : turnedAxes(random); };
    for (size_t k = 1; k < made.meshes.size(); ++k) made.scene.addObject({made.meshes[k], pose()});
    const std::array<int, 3> d = latticeDirection(random, false);
    Query query{
        .mesh = made.meshes[0], .worldFromMesh = pose(), .direction = {double(d[0]), double(d[1]), double(d[2])}};
    query.distance = random.chance(0.2) ? 0 : random.uniform(0, 12);
    query.ignoreLeaving = random.chance(0.7);
    query.skipOverlapping = random.chance(0.5);
    query.hits = random.chance(0.3) ? 1 : random.chance(0.5) ? kAllHits : static_cast<uint32_t>(random.integer(2, 3));
    if (random.chance(0.7)) query.slack = random.chance(0.5) ? 0 : random.uniform(0, 0.5);
    check(made.scene, query);
  }
}

namespace {

/// The six rods of a burr, 2 x 2 x 6 cells each, in pairs along the axes. Each lacks what the rods before it have.
std::vector<voxels::Solid> burr() {
  std::vector<voxels::Solid> pieces;
  std::set<voxels::Cell> taken;
  for (int side : {-2, 0}) {
    for (size_t axis = 0; axis < 3; ++axis) {
      voxels::Solid& piece = pieces.emplace_back();
      for (int along = -3; along < 3; ++along) {
        for (int across : {side, side + 1}) {
          for (int up : {-1, 0}) {
            voxels::Cell cell;
            cell[axis] = along;
            cell[(axis + 1) % 3] = across;
            cell[(axis + 2) % 3] = up;
            if (taken.insert(cell).second) piece.insert(cell);
          }
        }
      }
    }
  }
  return pieces;
}

const std::vector<std::array<int, 3>>& directions26() {
  static const std::vector<std::array<int, 3>> all = [] {
    std::vector<std::array<int, 3>> list;
    for (int i = 0; i < 27; ++i) {
      if (i != 13) list.push_back({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
    }
    return list;
  }();
  return all;
}

}  // namespace

TEST_CASE("the blocking graph of a burr puzzle is the known one, and peeling takes the puzzle apart") {
  const std::vector<voxels::Solid> pieces = burr();
  Random random(1);
  Scene scene;
  std::vector<MeshId> meshes;
  meshes.reserve(pieces.size());
  for (const voxels::Solid& piece : pieces) meshes.push_back(soups::add(scene, voxels::boundary(piece, random)));
  for (const MeshId mesh : meshes) scene.addObject({mesh, Transform()});
  CpuSweeper sweeper(scene, 2);
  std::vector<ObjectId> removed;
  for (size_t key = 0; key < pieces.size(); ++key) {
    std::set<size_t> free;
    for (size_t piece = 0; piece < pieces.size(); ++piece) {
      if (std::find(removed.begin(), removed.end(), piece) != removed.end()) continue;
      for (const std::array<int, 3>& direction : directions26()) {
        Query query{.mesh = meshes[piece], .distance = 100, .exclude = removed};
        for (size_t k = 0; k < 3; ++k) query.direction[k] = direction[k];
        query.exclude.push_back(static_cast<ObjectId>(piece));
        query.ignoreLeaving = true;
        query.hits = kAllHits;
        const Result first = sweeper.run({&query, 1})[0];
        if (first.status == Status::clear) free.insert(piece);
        std::map<ObjectId, double> expected, found;
        for (ObjectId other = 0; other < pieces.size(); ++other) {
          if (std::find(query.exclude.begin(), query.exclude.end(), other) != query.exclude.end()) continue;
          const Rational s = voxels::begins(pieces[piece], pieces[other], direction);
          const double length = std::hypot(direction[0], direction[1], direction[2]);
          if (s >= 0) expected[other] = s.convert_to<double>() * length;
        }
        for (const Result& hit : sweeper.lists().hitsOf(0)) found[hit.object] = hit.t;
        INFO("step " << key << ", piece " << piece << ", direction " << direction[0] << direction[1] << direction[2]);
        REQUIRE(found.size() == expected.size());
        for (const auto& [object, t] : expected) REQUIRE(found.at(object) == Approx(t).epsilon(1e-14));
      }
    }
    REQUIRE(free.contains(key));
    if (key == 0) REQUIRE(free.size() < 3);
    removed.push_back(static_cast<ObjectId>(key));
  }
}
