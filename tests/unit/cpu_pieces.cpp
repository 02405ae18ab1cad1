// Where a sensor leaves the straight way of a piece by no more than its deviation, the search passes every pair of
// triangles that meets.
#include <cmath>
#include <set>
#include <tuple>

#include "cpu/mesh_search.h"
#include "query/swept.h"
#include "support/catch.h"
#include "workloads/shapes.h"

using namespace radar;
using namespace radar::cpu;
using tools::Random;

namespace {

using Name = std::tuple<ObjectId, uint32_t, uint32_t>;

/// A turn by up to `angle` about an axis through a centre that moves by `way`.
struct TurnAbout {
  Vector centre, axis, way;
  double angle;

  Vector place(const Vector& p, double s) const {
    const Vector arm = minus(p, centre), up = scaled(dot(axis, arm), axis), side = cross(axis, arm);
    const double c = std::cos(s * angle);
    return along(along(along(along(centre, s, way), 1, up), c, minus(arm, up)), std::sin(s * angle), side);
  }
  Transform place(const Transform& start, double s) const {
    const auto column = [&](int k) { return Vector{start.m[k], start.m[4 + k], start.m[8 + k]}; };
    const Vector from = column(3), at = place(from, s);
    Transform placed;
    for (int k = 0; k < 4; ++k) {
      const Vector moved = k == 3 ? at : minus(place(along(from, 1, column(k)), s), at);
      for (int i = 0; i < 3; ++i) placed.m[4 * i + k] = moved[i];
    }
    return placed;
  }
};

/// The part of a turn from `from` to `end`: the sensor keeps the pose that it has half way, and moves straight.
struct Straightened {
  Piece piece;
  Transform pose;  // at the start

  Straightened(const TurnAbout& turn, const Transform& start, const Mesh& mesh, double from, double end) {
    const Box box = boxOf(mesh, start.m);
    const Vector middle{box.middle(0), box.middle(1), box.middle(2)}, first = turn.place(middle, from);
    const Vector way = minus(turn.place(middle, end), first);
    const double length = std::sqrt(dot(way, way)), angle = turn.angle * (end - from);
    const double radius = 0.5 * std::hypot(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]);
    const Vector arm = minus(middle, turn.centre);
    const double sagitta = std::sqrt(dot(arm, arm)) * angle * angle / 8;
    piece = {length > 0 ? scaled(1 / length, way) : Vector{1, 0, 0}, from, end, (1 + 1e-12) * length / (end - from),
             (1 + 1e-9) * (radius * angle / 2 + sagitta)};
    const double half = 0.5 * (from + end);
    pose = turn.place(start, half);
    const Vector back = minus(first, turn.place(middle, half));
    for (int i = 0; i < 3; ++i) pose.m[4 * i + 3] += back[i];
  }
};

class Passed final : public PairVisitor {
 public:
  Passed() : PairVisitor(1) {}
  void consider(const exact::PairName& name, const exact::PlacedPair&, Axis) override {
    names.emplace(name.object, name.triB, name.triA);
  }
  std::set<Name> names;
};

std::set<Name> passedOn(const Straightened& part, const Query& query, const Scene::Impl& scene) {
  const Mesh& sensor = scene.meshes[query.mesh];
  const MeshPlacement placement(sensor, part.pose);
  Passed passed;
  MeshSearch search;
  uint64_t pairs = 0;
  const auto visit = [&](ObjectId id) {
    const Object& object = scene.objects[id].object;
    const Mesh& mesh = scene.meshes[object.mesh];
    const MeshPlacement other(mesh, object.worldFromMesh);
    const PairMotion motion(placement, other, part.piece, 0, passed.latest());
    const RelativePlacement fromSensor(MeshAxes(placement.linear), other, motion, -1);
    const RelativePlacement fromOther(MeshAxes(other.linear), placement, motion, 1);
    TimeSpan times;
    narrow(times, fromSensor, sensor.tree.nodes[0], mesh.tree.nodes[0]);
    narrow(times, fromOther, mesh.tree.nodes[0], sensor.tree.nodes[0]);
    if (times.empty()) return;
    const MeshPair pair{
        {sensor, part.pose, placement}, {mesh, object.worldFromMesh, other}, id, motion, fromSensor, fromOther};
    search.run(pair, times.from, passed, pairs, {});
  };
  const double way = part.piece.wayUntil(1);
  walk(
      Participants(query, scene), scene.objectTree(), part.piece, boxOf(sensor, part.pose.m),
      [&](double near) { return near <= way; }, visit);
  return passed.names;
}

size_t trianglesOf(const Mesh& mesh) {
  return mesh.indices.size() / 3;
}

}  // namespace

TEST_CASE("the search of a piece passes all pairs that cross while the sensor turns within the piece's deviation") {
  Random random(67);
  size_t crossing = 0, passed = 0, all = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Scene scene;
    const tools::MeshData shapes[] = {tools::makeBox({1, 0.2, 3}), tools::makeTorus(1, 0.3, 9, 5),
                                      tools::makeRod(0.1, 4, 6)};
    for (const tools::MeshData& shape : shapes) scene.addMesh(shape.positions, shape.indices);
    const double size = random.magnitude(-3, 4), angle = random.magnitude(-3, 1);
    const auto pose = [&](double within) {
      return tools::makePose(random.rotation(), {size, size, size}, random.inCube(within * size));
    };
    for (int i = 0; i < 8; ++i) scene.addObject({.mesh = random.below(3), .worldFromMesh = pose(5)});
    const Query query{.mesh = random.below(3), .worldFromMesh = pose(2)};
    const Vector towards = random.inCube(1);
    const TurnAbout turn{random.inCube(4 * size), scaled(1 / std::sqrt(dot(towards, towards)), towards),
                         random.oneIn(3) ? Vector{} : Vector(random.inCube(3 * size)), angle};
    const Scene::Impl& impl = scene.impl();
    const Mesh& sensor = impl.meshes[query.mesh];
    const uint32_t parts = 1 + random.below(6);
    for (uint32_t part = 0; part < parts; ++part) {
      const double from = double(part) / parts, end = double(part + 1) / parts;
      const std::set<Name> names = passedOn({turn, query.worldFromMesh, sensor, from, end}, query, impl);
      passed += names.size();
      for (int k = 0; k <= 6; ++k) {
        const Transform at = turn.place(query.worldFromMesh, from + k * (end - from) / 6);
        for (ObjectId id = 0; id < 8; ++id) {
          const Object& object = impl.objects[id].object;
          const Mesh& mesh = impl.meshes[object.mesh];
          if (k == 0) all += trianglesOf(sensor) * trianglesOf(mesh);
          if (!overlap(boxOf(sensor, at.m), boxOf(mesh, object.worldFromMesh.m), 0)) continue;
          for (uint32_t a = 0; a < trianglesOf(sensor); ++a) {
            const exact::Triangle placedA = placedTriangle(sensor, at, a);
            for (uint32_t b = 0; b < trianglesOf(mesh); ++b) {
              if (!exact::cross(placedA, placedTriangle(mesh, object.worldFromMesh, b), 0)) continue;
              ++crossing;
              INFO("trial " << trial << ", part " << part << " of " << parts << ", place " << k);
              REQUIRE(names.contains({id, b, a}));
            }
          }
        }
      }
    }
  }
  CHECK(crossing > 1000);
  CHECK(2 * passed < all);
}
