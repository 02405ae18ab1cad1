// Scenes whose contacts are ties: lattices, boxes on a floor, flat worlds. With them soups and needles, for the tests
// of normals.
#pragma once

#include <map>

#include "soups.h"

namespace normals {

using soups::Random;
using Vector = std::array<double, 3>;

/// A scene, and queries through it.
struct Case {
  radar::Scene scene;
  std::vector<radar::Query> queries;
};

inline Vector latticeVector(Random& random, int most) {
  Vector v{};
  while (v == Vector{}) {
    for (double& c : v) c = random.integer(-most, most);
  }
  return v;
}

/// Mostly towards some place near an object's.
inline void aim(Random& random, const Case& from, bool isFlat, radar::Query& query) {
  const radar::Transform& pose = from.scene.object(0).worldFromMesh;
  do {
    const Vector aside = latticeVector(random, 3);
    for (size_t k = 0; k < 3; ++k) {
      query.direction[k] = pose.m[4 * k + 3] - query.worldFromMesh.m[4 * k + 3] + random.integer(0, 1) * aside[k];
    }
    if (random.chance(0.3)) query.direction = aside;
    if (isFlat) query.direction[2] = 0;
  } while (query.direction == Vector{});
  query.distance = 30;
}

/// A box of whole lengths from the origin.
inline soups::Mesh latticeBox(int x, int y, int z) {
  soups::Mesh box = soups::box(0.5, 0.5, 0.5);
  for (size_t i = 0; i < box.positions.size(); i += 3) {
    const std::array<int, 3> size{x, y, z};
    for (size_t k = 0; k < 3; ++k) box.positions[i + k] = (box.positions[i + k] + 0.5f) * static_cast<float>(size[k]);
  }
  return box;
}

inline soups::Mesh anyBox(Random& random) {
  return latticeBox(random.integer(1, 3), random.integer(1, 3), random.integer(1, 3));
}

/// Two boxes; or several, all on one floor if `onFloor`.
inline void boxes(Random& random, bool onFloor, Case& out) {
  const auto place = [&] {
    return soups::at(random.integer(-6, 6), random.integer(-6, 6), onFloor ? 0 : random.integer(-6, 6));
  };
  for (int i = onFloor ? 3 : 1; i-- > 0;) out.scene.addObject({soups::add(out.scene, anyBox(random)), place()});
  const radar::MeshId sensor = soups::add(out.scene, anyBox(random));
  for (int i = 0; i < 4; ++i) {
    radar::Query query{.mesh = sensor, .worldFromMesh = place()};
    aim(random, out, onFloor, query);
    query.ignoreLeaving = random.chance(0.3);
    out.queries.push_back(query);
  }
}

/// Triangles with whole corners, also degenerate ones; all in one plane if `isFlat`.
inline void lattices(Random& random, bool isFlat, Case& out) {
  const int side = random.integer(1, 4);
  const auto mesh = [&] {
    soups::Mesh lattice = soups::lattice(random, random.integer(1, 5), side);
    for (size_t i = 2; isFlat && i < lattice.positions.size(); i += 3) lattice.positions[i] = 0;
    return soups::add(out.scene, lattice);
  };
  const auto place = [&] {
    const Vector at = latticeVector(random, 4);
    return soups::at(at[0], at[1], isFlat ? 0 : at[2]);
  };
  for (int i = 0; i < 2; ++i) out.scene.addObject({mesh(), place()});
  const radar::MeshId sensor = mesh();
  for (int i = 0; i < 4; ++i) {
    radar::Query query{.mesh = sensor, .worldFromMesh = place()};
    aim(random, out, isFlat, query);
    out.queries.push_back(query);
  }
}

/// Soups of floats, with needles and degenerate triangles. `stretch`: of one axis.
inline void floats(Random& random, double stretch, Case& out) {
  const auto near = [&](double spread) {
    Vector at = random.inBall();
    for (double& c : at) c *= spread;
    return at;
  };
  const auto pose = [&](double spread) {
    radar::Transform placed = random.pose(random.uniform(0.3, 2), near(spread));
    for (size_t i = 0; i < 3; ++i) placed.m[4 * i] *= stretch;
    return placed;
  };
  const auto mesh = [&] {
    return soups::add(out.scene, soups::soup(random, random.integer(1, 6), random.uniform(0.1, 0.7), 0.3));
  };
  for (int i = 0; i < 2; ++i) out.scene.addObject({mesh(), pose(4)});
  const radar::MeshId sensor = mesh();
  for (int i = 0; i < 3; ++i) {
    radar::Query query{.mesh = sensor, .worldFromMesh = pose(4), .direction = near(1), .distance = 20};
    for (size_t k = 0; k < 3; ++k) {
      query.direction[k] += out.scene.object(0).worldFromMesh.m[4 * k + 3] - query.worldFromMesh.m[4 * k + 3];
    }
    out.queries.push_back(query);
  }
}

/// Two triangles around a place where corners, borders or faces of both meet, pulled apart along the motion, in floats
/// that are exact: contact there, if it is the first, is a tie that no lattice has.
inline void meetings(Random& random, Case& out) {
  const auto whole = [&](int most) { return static_cast<float>(random.integer(-most, most)); };
  const std::array<float, 3> at{whole(1000), whole(1000), whole(1000)}, way{whole(50), whole(50), whole(50)};
  if (way == std::array<float, 3>{}) return;
  // A fan of triangles: corner 0, or the middle of the first side, is there.
  const auto fan = [&](float back) {
    soups::Mesh mesh;
    const int triangles = random.integer(1, 5);
    const bool atCorner = random.chance(0.6);
    std::array<float, 3> last{whole(300), whole(300), whole(300)};
    for (int t = 0; t < triangles; ++t) {
      const std::array<float, 3> next{whole(300), whole(300), whole(300)}, other{whole(300), whole(300), whole(300)};
      for (size_t c = 0; c < 3; ++c) {
        mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size() / 3));
        for (size_t k = 0; k < 3; ++k) {
          float to = c == 0 ? 0 : c == 1 ? last[k] : next[k];
          if (!atCorner) to = c == 0 ? -last[k] : c == 1 ? last[k] : (t == 0 ? next : other)[k];
          mesh.positions.push_back(at[k] + to - back * way[k]);
        }
      }
      if (atCorner) last = next;
    }
    return soups::add(out.scene, mesh);
  };
  out.scene.addObject({fan(0), radar::Transform{}});
  radar::Query query{.mesh = fan(10), .distance = 1e4};
  for (size_t k = 0; k < 3; ++k) query.direction[k] = way[k];
  out.queries.push_back(query);
}

/// How many hits there are, and how many answers have which fault.
struct Judged {
  int hits = 0;
  std::map<std::string, int> faults;

  void add(const radar::Scene& scene, const radar::Query& query, const radar::Result& result) {
    if (result.status != radar::Status::hit && result.status != radar::Status::overlap) return;
    const std::string fault = oracle::faultOfNormal(scene, query, result);
    if (!fault.empty()) ++faults[fault];
    hits += result.status == radar::Status::hit;
  }
  std::string words() const {
    std::string text = std::to_string(hits) + " hits";
    for (const auto& [fault, count] : faults) text += "; " + std::to_string(count) + " times: " + fault;
    return text;
  }
};

}  // namespace normals
