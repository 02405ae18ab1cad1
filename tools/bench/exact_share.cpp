// How often the reference needs exact integers, and what that costs: on ordinary scenes (random poses), and for
// comparison where doubles can tell little: aligned boxes, whose every contact is of parallel faces, and a grid of
// boxes, where nearly everything touches.
//
// Prints CSV: scene, microseconds per query, pairs per query, share of pairs that needed exact integers, and an upper
// estimate of the share of time they took: decisions times the cost of one, measured first on coordinates in general
// position (those of a grid cost a fraction of that).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "exact/contact.h"
#include "reference/reference.h"

namespace {

using radar::MeshId;
using radar::Pose;
using radar::Query;
using radar::Scene;
using Vec = std::array<double, 3>;

std::mt19937_64 engine(1);

double uniform(double lo, double hi) {
  return lo + (hi - lo) * std::generate_canonical<double, 53>(engine);
}

Vec inBall() {
  for (;;) {
    const Vec v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (square <= 1 && square > 0.01) return v;
  }
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Pose randomPose(double scale, double side) {
  double q[4], square;
  do {
    square = 0;
    for (double& c : q) {
      c = uniform(-1, 1);
      square += c * c;
    }
  } while (square > 1 || square < 0.01);
  for (double& c : q) c /= std::sqrt(square);
  const auto [w, x, y, z] = q;
  Pose pose;
  pose.m = {scale * (1 - 2 * (y * y + z * z)), scale * 2 * (x * y - z * w),
            scale * 2 * (x * z + y * w),       uniform(0, side),
            scale * 2 * (x * y + z * w),       scale * (1 - 2 * (x * x + z * z)),
            scale * 2 * (y * z - x * w),       uniform(0, side),
            scale * 2 * (x * z - y * w),       scale * 2 * (y * z + x * w),
            scale * (1 - 2 * (x * x + y * y)), uniform(0, side)};
  return pose;
}

MeshId addBox(Scene& scene) {
  std::vector<float> positions;
  for (int k = 0; k < 8; ++k) {
    for (int bit : {1, 2, 4}) positions.push_back(k & bit ? 0.5f : -0.5f);
  }
  const std::vector<uint32_t> indices{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return scene.addMesh(positions, indices);
}

/// `around` x `along` vertices, 2 * around * along triangles; of size 1.
MeshId addTorus(Scene& scene, uint32_t around, uint32_t along) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < around; ++i) {
    for (uint32_t k = 0; k < along; ++k) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * k / along, r = 0.35 + 0.15 * std::cos(v);
      for (double c : {r * std::cos(u), r * std::sin(u), 0.15 * std::sin(v)})
        positions.push_back(static_cast<float>(c));
      const uint32_t i1 = (i + 1) % around, k1 = (k + 1) % along;
      const uint32_t corner[4] = {i * along + k, i1 * along + k, i * along + k1, i1 * along + k1};
      indices.insert(indices.end(), {corner[0], corner[1], corner[2], corner[1], corner[3], corner[2]});
    }
  }
  return scene.addMesh(positions, indices);
}

/// Seconds per exact decision: contact of triangles of which two corners lie behind each other up to rounding, less
/// that of triangles in general position.
double costOfDecision() {
  struct Case {
    radar::exact::Triangle a, b;
    Vec direction;
  };
  const auto time = [](const std::vector<Case>& cases, uint64_t& decisions) {
    const uint64_t before = radar::exact::exactDecisions();
    const double start = seconds();
    for (const Case& c : cases) radar::exact::contact(c.a, c.b, c.direction);
    const double spent = seconds() - start;
    decisions = radar::exact::exactDecisions() - before;
    return spent;
  };
  std::vector<Case> open(20000), hard(20000);
  for (std::vector<Case>* cases : {&open, &hard}) {
    for (Case& c : *cases) {
      for (Vec& v : c.a) v = inBall();
      for (Vec& v : c.b) v = inBall();
      c.direction = inBall();
      if (cases == &open) continue;
      for (int k = 0; k < 3; ++k) c.b[0][k] = c.a[0][k] + 3 * c.direction[k];
    }
  }
  uint64_t few = 0, many = 0;
  time(open, few);
  const double easy = time(open, few), spent = time(hard, many);
  return (spent - easy) / static_cast<double>(many - few);
}

void report(const std::string& name, const Scene& scene, const std::vector<Query>& queries, double perDecision) {
  radar::reference::Reference reference(scene);
  reference.run(queries);
  const uint64_t pairs = reference.pairs(), exact = reference.exactPairs();
  const uint64_t decisions = radar::exact::exactDecisions();
  constexpr int kRepeats = 9;
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const double start = seconds();
    reference.run(queries);
    times.push_back(seconds() - start);
  }
  std::sort(times.begin(), times.end());
  const double count = static_cast<double>(queries.size());
  const double pairCount = static_cast<double>(reference.pairs() - pairs) / kRepeats;
  const double exactCount = static_cast<double>(reference.exactPairs() - exact) / kRepeats;
  const double decisionCount = static_cast<double>(radar::exact::exactDecisions() - decisions) / kRepeats;
  std::printf("%s,%.2f,%.0f,%.5f%%,%.3f%%\n", name.c_str(), 1e6 * times[kRepeats / 2] / count, pairCount / count,
              100 * exactCount / pairCount, std::min(100.0, 100 * decisionCount * perDecision / times[kRepeats / 2]));
}

std::vector<Query> randomQueries(MeshId mesh, double scale, double side, double distance) {
  std::vector<Query> queries(1000);
  for (Query& query : queries) {
    query.mesh = mesh;
    query.worldFromMesh = randomPose(scale, side);
    query.direction = inBall();
    query.distance = distance;
  }
  return queries;
}

void ordinary(double perDecision) {
  for (int boxes : {1000, 10000, 100000}) {
    Scene scene;
    const MeshId box = addBox(scene), ring = addTorus(scene, 20, 10), torus = addTorus(scene, 79, 40);
    const double side = 100 * std::cbrt(boxes / 10000.0);
    for (int i = 0; i < boxes; ++i) scene.addObject({box, randomPose(uniform(0.5, 2), side)});
    const std::string among = " among " + std::to_string(boxes) + " boxes";
    report("box" + among, scene, randomQueries(box, 1, side, 30), perDecision);
    report("torus of 400 triangles" + among, scene, randomQueries(ring, 2, side, 30), perDecision);
    report("torus of 6320 triangles" + among, scene, randomQueries(torus, 6, side, 30), perDecision);
  }
  Scene scene;
  const MeshId torus = addTorus(scene, 79, 40);
  for (int i = 0; i < 60; ++i) scene.addObject({torus, randomPose(4, 40)});
  report("torus of 6320 triangles among 60 like it", scene, randomQueries(torus, 4, 40, 30), perDecision);
}

/// Boxes that are not turned, at random places: edges and faces are parallel, or edge-on to a motion along an axis.
void aligned(double perDecision) {
  Scene scene;
  const MeshId box = addBox(scene);
  const auto pose = [] {
    Pose p = randomPose(1, 100);
    for (size_t row = 0; row < 3; ++row) {
      for (size_t k = 0; k < 3; ++k) p.m[4 * row + k] = row == k ? uniform(0.5, 2) : 0;
    }
    return p;
  };
  for (int i = 0; i < 10000; ++i) scene.addObject({box, pose()});
  std::vector<Query> queries = randomQueries(box, 1, 100, 30);
  for (Query& query : queries) query.worldFromMesh = pose();
  report("aligned box among 10000 aligned boxes (not ordinary)", scene, queries, perDecision);
  for (Query& query : queries) query.direction = {0, 0, query.direction[2] > 0 ? 1.0 : -1.0};
  report("the same along an axis (not ordinary)", scene, queries, perDecision);
}

/// Boxes on every other point of an integer grid; sensors on the grid too, along an axis or a diagonal.
void grid(double perDecision) {
  Scene scene;
  const MeshId box = addBox(scene);
  const auto pose = [](double x, double y, double z) {
    Pose p;
    p.m[3] = x;
    p.m[7] = y;
    p.m[11] = z;
    return p;
  };
  for (int i = 0; i < 8000; ++i) {
    if (engine() % 4 == 0) scene.addObject({box, pose(i % 20, i / 20 % 20, i / 400)});
  }
  std::vector<Query> queries(1000);
  for (Query& query : queries) {
    query.mesh = box;
    const auto any = [] { return static_cast<double>(engine() % 20); };
    query.worldFromMesh = pose(any(), any(), -5);
    query.direction = {static_cast<double>(engine() % 3) - 1, static_cast<double>(engine() % 3) - 1, 1};
    query.distance = 30;
  }
  report("box in a grid of boxes (not ordinary)", scene, queries, perDecision);
}

}  // namespace

int main() {
  const double perDecision = costOfDecision();
  std::printf("# one exact decision: %.0f ns\nscene,us_per_query,pairs_per_query,exact_pairs,exact_time_at_most\n",
              1e9 * perDecision);
  ordinary(perDecision);
  aligned(perDecision);
  grid(perDecision);
}
