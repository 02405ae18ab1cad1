#include "world.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace example {

namespace {

constexpr double kPi = 3.14159265358979;

float onGrid(double x, float grid) {
  return static_cast<float>(std::round(x * grid) / grid);
}

/// The same numbers with every standard library, from 0 to 1.
class Random {
 public:
  double operator()() { return static_cast<double>(engine_() >> 8) / (1 << 24); }

 private:
  std::mt19937 engine_{2024};
};

/// Joins rings of `sides` vertices each, one after another from `first` on, to a tube.
void addQuads(Mesh& mesh, uint32_t first, uint32_t rings, uint32_t sides, bool closed) {
  for (uint32_t ring = 0; ring + (closed ? 0 : 1) < rings; ++ring) {
    for (uint32_t side = 0; side < sides; ++side) {
      const uint32_t a = first + ring * sides, b = first + (ring + 1) % rings * sides, next = (side + 1) % sides;
      mesh.indices.insert(mesh.indices.end(), {a + side, a + next, b + side, b + side, a + next, b + next});
    }
  }
}

/// A box around `centre`, turned about the vertical by `angle`.
void addBox(Mesh& mesh, const vec3& centre, const vec3& half, double angle = 0, float leg = -1) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  const double c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < 8; ++i) {
    const double x = (i & 1) != 0 ? half[0] : -half[0], y = (i & 2) != 0 ? half[1] : -half[1];
    const double z = (i & 4) != 0 ? half[2] : -half[2];
    mesh.vertices.push_back({onGrid(centre[0] + c * x - s * y, kVertexGrid),
                             onGrid(centre[1] + s * x + c * y, kVertexGrid), onGrid(centre[2] + z, kVertexGrid), leg});
  }
  for (const uint32_t i :
       {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
    mesh.indices.push_back(first + i);
}

/// A ring of `radius` in the plane z = centre[2], of three-sided section.
void addRing(Mesh& mesh, const vec3& centre, double radius, double thickness, uint32_t segments) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  for (uint32_t i = 0; i < 3 * segments; ++i) {
    const uint32_t segment = i / 3;
    const double around = 2 * kPi * segment / segments, about = 2 * kPi * (i % 3) / 3;
    const double r = radius + thickness * std::cos(about);
    mesh.vertices.push_back({onGrid(centre[0] + r * std::cos(around), kVertexGrid),
                             onGrid(centre[1] + r * std::sin(around), kVertexGrid),
                             onGrid(centre[2] + thickness * std::sin(about), kVertexGrid), -1});
  }
  addQuads(mesh, first, segments, 3, true);
}

/// Four open rings around a body: another agent's corner fits into them.
Mesh makeDrone() {
  Mesh drone;
  addBox(drone, {0.02f, 0, 0}, {0.24f, 0.15f, 0.09f});
  addBox(drone, {0.14f, 0, 0.12f}, {0.10f, 0.09f, 0.05f});
  for (int i = 0; i < 4; ++i) {
    const double angle = kPi / 4 + i * kPi / 2;
    const auto at = [&](double r) { return vec3{float(r * std::cos(angle)), float(r * std::sin(angle)), 0.02f}; };
    addBox(drone, at(0.30), {0.14f, 0.03f, 0.025f}, angle);
    addRing(drone, at(0.62), 0.27, 0.055, 10);
  }
  return drone;
}

/// A body on four legs of eight sections, at the height of its hips.
Mesh makeWalker() {
  Mesh walker;
  addBox(walker, {0, 0, 0.62f}, {1.05f, 0.42f, 0.28f});
  addBox(walker, {1.15f, 0, 1.0f}, {0.34f, 0.26f, 0.24f});
  addBox(walker, {-0.1f, 0, 0.98f}, {0.6f, 0.3f, 0.12f});
  for (int leg = 0; leg < 4; ++leg) {
    const auto first = static_cast<uint32_t>(walker.vertices.size());
    const double x = leg < 2 ? 0.75 : -0.75, y = leg % 2 == 0 ? 0.52 : -0.52;
    for (int i = 0; i < 9 * 4; ++i) {
      const int section = i / 4;
      const double down = section / 8.0, wide = 0.17 - 0.08 * down + (section == 8 ? 0.06 : 0);
      const double about = kPi / 4 + i % 4 * kPi / 2;
      walker.vertices.push_back({onGrid(x + wide * std::cos(about), kVertexGrid),
                                 onGrid(y + wide * std::sin(about), kVertexGrid), onGrid(0.5 - 1.7 * down, kVertexGrid),
                                 static_cast<float>(leg + 0.98 * down)});
    }
    addQuads(walker, first, 9, 4, false);
    const uint32_t top = first, foot = first + 32;
    walker.indices.insert(walker.indices.end(), {top, top + 1, top + 2, top, top + 2, top + 3});
    walker.indices.insert(walker.indices.end(), {foot, foot + 2, foot + 1, foot, foot + 3, foot + 2});
  }
  return walker;
}

std::vector<float> positionsOf(const Mesh& mesh) {
  std::vector<float> positions;
  for (const vec4& v : mesh.vertices) positions.insert(positions.end(), v.begin(), v.begin() + 3);
  return positions;
}

radar::MeshId add(radar::Scene& scene, const Mesh& mesh) {
  return scene.addMesh(positionsOf(mesh), mesh.indices);
}

/// Of a sphere around the origin with room for rotations on the grid, which are no exact rotations.
float radiusOf(const Mesh& mesh) {
  float radius = 0;
  for (const vec4& v : mesh.vertices) radius = std::max(radius, std::hypot(v[0], v[1], v[2]));
  return radius + 0.01f;
}

radar::Transform placed(const vec3& at, const vec3& scale = {1, 1, 1}) {
  return {{scale[0], 0, 0, at[0], 0, scale[1], 0, at[1], 0, 0, scale[2], at[2]}};
}

}  // namespace

World::World(uint32_t count) : half(std::max(36.0f, 1.3f * std::sqrt(static_cast<float>(count)))) {
  const Mesh drone = makeDrone(), walker = makeWalker();
  half = static_cast<float>(kPitch * std::ceil(half / kPitch));
  addCity();
  addTerrain();

  Mesh anyStep;  // contains a walker in all phases
  addBox(anyStep, {0, 0, 0.05f}, {1.75f, 0.8f, 1.3f});
  const uint32_t wanted = std::min(32u, count / 3);
  const std::vector<vec3> onGround = freePlaces(anyStep, wanted, 30, 5.5f, 1.3125f, 1.4f);
  const std::vector<vec3> inAir = freePlaces(drone, count - static_cast<uint32_t>(onGround.size()), half, 3, 6, 30);
  walkers = static_cast<uint32_t>(onGround.size());
  if (walkers + inAir.size() < count) throw radar::Error("no room for " + std::to_string(count) + " agents");
  const float longerLegs = 0.45f;  // than at rest, in any phase
  for (const vec3& place : onGround) {
    bodies.push_back(add(scene, walker));
    nextBodies.push_back(add(scene, walker));
    addAgent(place, bodies.back(), nextBodies.back(), radiusOf(walker) + longerLegs, 0.06f);
  }
  const radar::MeshId droneMesh = add(scene, drone);
  for (const vec3& place : inAir) addAgent(place, droneMesh, droneMesh, radiusOf(drone), 0.16f);
  models.insert(models.begin(), {{kWalker, walker, 0, walkers}, {kDrone, drone, walkers, count - walkers}});

  // The rest follows the agents.
  for (Model& model : models) {
    if (model.kind == kWalker || model.kind == kDrone) continue;
    const radar::MeshId mesh = add(scene, model.mesh);
    const radar::ObjectId inCity = model.first;
    for (uint32_t i = 0; i < model.count; ++i) {
      const radar::ObjectId id =
          scene.addObject({.mesh = mesh, .worldFromMesh = city_.object(inCity + i).worldFromMesh});
      if (i == 0) model.first = id;
    }
  }
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    const auto& m = scene.object(id).worldFromMesh.m;
    transforms.emplace_back();
    std::transform(m.begin(), m.end(), transforms.back().begin(), [](double x) { return static_cast<float>(x); });
  }
}

void World::addAgent(const vec3& place, radar::MeshId body, radar::MeshId sensor, float radius, float speed) {
  scene.addObject({.mesh = body, .worldFromMesh = placed(place)});
  const auto id = static_cast<int>(agents.size());
  agents.push_back({.place = place,
                    .clear = kReach,
                    .from = place,
                    .speed = speed * (0.8f + 0.4f * static_cast<float>(id * 7 % 10) / 10),
                    .contact = place,
                    .radius = radius,
                    .normal = {},
                    .heading = 0,
                    .body = body,
                    .sensor = sensor,
                    .phase = id * 11 % kCycle,
                    .advanced = 0,
                    .stuck = 0,
                    .side = 0,
                    .goal = 0});
}

/// Towers around a square; the farther out, the higher.
void World::addCity() {
  Random random;
  Mesh box;
  addBox(box, {0, 0, 0.5f}, {0.5f, 0.5f, 0.5f});
  const radar::MeshId mesh = camera_ = add(city_, box);
  Model buildings{kBuilding, box};
  const auto build = [&](const vec3& at, const vec3& size) {
    city_.addObject({.mesh = mesh, .worldFromMesh = placed(at, size)});
    ++buildings.count;
  };
  const int blocks = static_cast<int>(std::lround(half / kPitch));
  for (int i = -blocks; i < blocks; ++i) {
    for (int j = -blocks; j < blocks; ++j) {
      if ((i == -1 || i == 0) && (j == -1 || j == 0)) continue;
      const auto x = static_cast<float>((i + 0.5) * kPitch), y = static_cast<float>((j + 0.5) * kPitch);
      const double outward = std::min(1.0, std::hypot(x, y) / 60.0);
      const auto wide = static_cast<float>(7 + 3 * random()), deep = static_cast<float>(7 + 3 * random());
      const auto high = static_cast<float>(3 + 7 * random() + 16 * outward * random());
      build({x, y, -1}, {wide, deep, high + 1});
      if (random() < 0.6)
        build({x, y, high}, {0.6f * wide, 0.6f * deep, static_cast<float>(1 + 0.5 * high * random())});
    }
  }
  models.push_back(std::move(buildings));
}

/// Flat in the city, with hills around it; the engine itself casts the shadows of the buildings.
void World::addTerrain() {
  constexpr uint32_t kCells = 144;
  Model terrain{kTerrain, {}, city_.objectLimit(), 1};
  Mesh& mesh = terrain.mesh;
  const float side = half + 60;
  std::vector<radar::Query> sun;
  const Mesh speck{{{0, 0, 0, 0}, {0.01f, 0, 0, 0}, {0, 0.01f, 0, 0}}, {0, 1, 2}};
  const radar::MeshId probe = add(city_, speck);
  for (uint32_t i = 0; i < (kCells + 1) * (kCells + 1); ++i) {
    // Closer together in the middle.
    const auto along = [&](uint32_t k) {
      const float u = 2.0f * static_cast<float>(k) / kCells - 1;
      return side * (0.6f * u + 0.4f * u * u * u);
    };
    const float x = along(i % (kCells + 1)), y = along(i / (kCells + 1));
    const float outside = std::max(0.0f, std::max(std::abs(x), std::abs(y)) - half - 3);
    const float wave = 2.2f + std::sin(0.05f * x + 1) + std::sin(0.06f * y) * std::cos(0.04f * x);
    const float z = 0.16f * outside * outside / (30 + outside) * wave;
    mesh.vertices.push_back({x, y, z, 1});
    for (const float aside : {-0.3f, 0.3f}) {
      for (const float ahead : {-0.3f, 0.3f}) {
        sun.push_back({.mesh = probe,
                       .worldFromMesh = placed({x + aside, y + ahead, z + 0.2f}),
                       .direction = {0.48, 0.36, 0.8},
                       .distance = 200,
                       .anyHit = true});
      }
    }
  }
  const radar::Answers shadows = cityRays_.run(sun);
  for (size_t i = 0; i < sun.size(); ++i)
    if (shadows.results[i].status == radar::Status::hit) mesh.vertices[i / 4][3] -= 0.24f;
  for (uint32_t row = 0; row < kCells; ++row) {
    for (uint32_t column = 0; column < kCells; ++column) {
      const uint32_t a = row * (kCells + 1) + column, b = a + kCells + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
    }
  }
  city_.addObject({.mesh = add(city_, mesh)});
  models.push_back(std::move(terrain));
}

/// Places on a lattice, each moved a little, where the mesh touches nothing of the city and has nothing above it:
/// surfaces alone do not tell that a place is inside a building. Agents on the lattice are too far apart to touch each
/// other.
std::vector<vec3> World::freePlaces(const Mesh& mesh, uint32_t most, float within, float spacing, float lowest,
                                    float highest) {
  Random random;
  const radar::MeshId id = add(city_, mesh);
  const double room = spacing - 2 * radiusOf(mesh);
  std::vector<radar::Query> queries;
  for (float z = lowest; z <= highest; z += spacing) {
    for (float y = -within; y < within; y += spacing) {
      for (float x = -within; x < within; x += spacing) {
        const vec3 at{onGrid(x + room * random(), kGrid), onGrid(y + room * random(), kGrid), z};
        queries.push_back({.mesh = id, .worldFromMesh = placed(at), .direction = {0, 0, 1}, .distance = 200});
      }
    }
  }
  const std::vector<radar::Result> found = cityRays_.run(queries).results;
  std::vector<vec3> free;
  for (size_t i = 0; i < queries.size(); ++i) {
    const auto& m = queries[i].worldFromMesh.m;
    if (found[i].status == radar::Status::clear)
      free.push_back({static_cast<float>(m[3]), static_cast<float>(m[7]), static_cast<float>(m[11])});
  }
  for (size_t i = free.size(); i > 1; --i) std::swap(free[i - 1], free[static_cast<size_t>(random() * i)]);
  free.resize(std::min<size_t>(free.size(), most));
  return free;
}

uint32_t World::crossings(const std::vector<std::array<float, 12>>& now, const std::vector<vec3>& skinned,
                          const std::vector<Agent>& states, uint32_t frame) {
  const size_t perWalker = bodies.empty() ? 0 : skinned.size() / (2 * bodies.size());
  for (uint32_t i = 0; i < walkers; ++i) {
    const vec3* shape = &skinned[(2 * i + (states[i].advanced == frame ? 1 : 0)) * perWalker];
    scene.setPositions(bodies[i], {shape->data(), 3 * perWalker});
  }
  std::vector<radar::ObjectId> ids(agents.size());
  std::vector<radar::Transform> poses(agents.size());
  std::vector<radar::Query> queries(agents.size());
  for (radar::ObjectId id = 0; id < ids.size(); ++id) {
    ids[id] = id;
    std::copy(now[id].begin(), now[id].end(), poses[id].m.begin());
    queries[id] = {.mesh = scene.object(id).mesh, .worldFromMesh = poses[id], .direction = {0, 0, 1}, .exclude = {id}};
  }
  scene.setTransforms(ids, poses);
  const std::vector<radar::Result> found = sceneRays_.run(queries).results;
  return static_cast<uint32_t>(std::count_if(
      found.begin(), found.end(), [](const radar::Result& result) { return result.status != radar::Status::clear; }));
}

double World::boom(const vec3& target, const vec3& eye) {
  radar::Query query{.mesh = camera_, .worldFromMesh = placed(target, {0.7f, 0.7f, 0.7f})};
  for (size_t k = 0; k < 3; ++k) query.direction[k] = double{eye[k]} - target[k];
  query.distance = std::hypot(query.direction[0], query.direction[1], query.direction[2]);
  const radar::Result result = cityRays_.run({&query, 1}).results[0];
  return result.status == radar::Status::hit ? result.lo : query.distance;
}

}  // namespace example
