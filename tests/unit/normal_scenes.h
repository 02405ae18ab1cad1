// Scenes whose contacts are ties: lattices, boxes on a floor, flat worlds. With them soups and needles, for the tests
// of normals.
#pragma once

#include "judged.h"
#include "soups.h"
#include "support/catch.h"

namespace normals {

using oracle::Judged;
using radar::test::add;
using radar::test::at;
using radar::test::Case;
using radar::test::placeOf;
using radar::tools::MeshData;
using radar::tools::operator+;
using radar::tools::operator-;
using radar::tools::operator*;
using soups::Random;
using Vector = std::array<double, 3>;

/// Mostly towards some place near an object's.
inline void aim(Random& random, const Case& from, bool isFlat, radar::Query& query) {
  const Vector ahead = placeOf(from.scene.object(0).worldFromMesh) - placeOf(query.worldFromMesh);
  do {
    const Vector aside = random.latticeVector(3);
    for (size_t k = 0; k < 3; ++k) query.direction[k] = ahead[k] + random.integer(0, 1) * aside[k];
    if (random.chance(0.3)) query.direction = aside;
    if (isFlat) query.direction[2] = 0;
  } while (query.direction == Vector{});
  query.distance = 30;
}

/// A box of whole lengths from the origin.
inline MeshData latticeBox(int x, int y, int z) {
  const Vector size{double(x), double(y), double(z)};
  MeshData box;
  append(box, radar::tools::makeBox(size), 0.5 * size);
  return box;
}

inline MeshData anyBox(Random& random) {
  return latticeBox(random.integer(1, 3), random.integer(1, 3), random.integer(1, 3));
}

/// Two boxes; or several, all on one floor if `onFloor`.
inline void boxes(Random& random, bool onFloor, Case& out) {
  const auto place = [&] {
    return at(random.integer(-6, 6), random.integer(-6, 6), onFloor ? 0 : random.integer(-6, 6));
  };
  for (int i = onFloor ? 3 : 1; i-- > 0;) out.scene.addObject({add(out.scene, anyBox(random)), place()});
  const radar::MeshId sensor = add(out.scene, anyBox(random));
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
    MeshData lattice = soups::lattice(random, random.integer(1, 5), side);
    for (size_t i = 2; isFlat && i < lattice.positions.size(); i += 3) lattice.positions[i] = 0;
    return add(out.scene, lattice);
  };
  const auto place = [&] {
    const Vector corner = random.latticeVector(4);
    return at(corner[0], corner[1], isFlat ? 0 : corner[2]);
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
  const auto pose = [&] {
    radar::Transform placed = random.pose(random.uniform(0.3, 2), 4 * random.inBall());
    for (size_t i = 0; i < 3; ++i) placed.m[4 * i] *= stretch;
    return placed;
  };
  const auto mesh = [&] {
    return add(out.scene, soups::soup(random, random.integer(1, 6), random.uniform(0.1, 0.7), 0.3));
  };
  for (int i = 0; i < 2; ++i) out.scene.addObject({mesh(), pose()});
  const radar::MeshId sensor = mesh();
  for (int i = 0; i < 3; ++i) {
    radar::Query query{.mesh = sensor, .worldFromMesh = pose(), .distance = 20};
    const Vector ahead = placeOf(out.scene.object(0).worldFromMesh) - placeOf(query.worldFromMesh);
    query.direction = ahead + random.inBall();
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
    MeshData mesh;
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
    return add(out.scene, mesh);
  };
  out.scene.addObject({fan(0), radar::Transform{}});
  radar::Query query{.mesh = fan(10), .distance = 1e4};
  for (size_t k = 0; k < 3; ++k) query.direction[k] = way[k];
  out.queries.push_back(query);
}

}  // namespace normals
