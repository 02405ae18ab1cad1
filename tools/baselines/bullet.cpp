// Bullet: sweeps of a convex shape through trees of triangles. A sensor is swept as its hull, or triangle by triangle,
// each no farther than the best so far; objects are trees of triangles or hulls. Margins are 0.
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <LinearMath/btConvexHullComputer.h>
#include <btBulletCollisionCommon.h>

#include "baselines/rigid.h"

namespace radar::tools {

namespace {

btVector3 vectorOf(const double* p) {
  return {p[0], p[1], p[2]};
}

struct Shape {
  std::vector<btVector3> corners;  ///< 3 per triangle
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btBvhTriangleMeshShape> tree;  ///< as scene
  std::unique_ptr<btConvexHullShape> hull;       ///< as sensor
};

Shape shapeOf(const std::vector<double>& positions, const MeshData& mesh) {
  Shape shape;
  for (const uint32_t vertex : mesh.indices) shape.corners.push_back(vectorOf(&positions[3 * size_t{vertex}]));
  shape.triangles = std::make_unique<btTriangleMesh>();
  for (size_t i = 0; i < shape.corners.size(); i += 3) {
    shape.triangles->addTriangle(shape.corners[i], shape.corners[i + 1], shape.corners[i + 2]);
  }
  shape.tree = std::make_unique<btBvhTriangleMeshShape>(shape.triangles.get(), true);
  shape.tree->setMargin(0);
  return shape;
}

std::unique_ptr<btConvexHullShape> hullOf(const std::vector<btVector3>& points) {
  btConvexHullComputer hull;
  hull.compute(&points[0].getX(), sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
  auto shape = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < hull.vertices.size(); ++i) shape->addPoint(hull.vertices[i], false);
  shape->recalcLocalAabb();
  shape->setMargin(0);
  return shape;
}

btConvexHullShape& hullOf(Shape& shape) {
  if (!shape.hull) shape.hull = hullOf(shape.corners);
  return *shape.hull;
}

btTransform transformOf(const RigidPose& pose) {
  const auto& r = pose.rotation;
  return btTransform(btMatrix3x3(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]), vectorOf(pose.at.data()));
}

struct Closest : btCollisionWorld::ClosestConvexResultCallback {
  Closest(const Query& asked, const btVector3& from, const btVector3& to)
      : ClosestConvexResultCallback(from, to), query(asked) {}
  bool needsCollision(btBroadphaseProxy* proxy) const override {
    const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
    return !isExcluded(query, static_cast<uint32_t>(object->getUserIndex()));
  }
  const Query& query;
};

/// What is cast, and past what.
enum class Cast { triangles, hull, hullPastHulls };

template <Cast kind>
class Bullet : public SceneBaseline {
 public:
  Bullet(const Workload& workload, uint32_t) : shapes_(workload, shapeOf) {}
  ~Bullet() override { begin(0); }

  std::optional<double> cast(const Query& query) override {
    const RigidPose pose = rigidPose(query.worldFromMesh);
    Shape& shape = shapes_.of(query.mesh, pose);
    const btTransform from = transformOf(pose);
    const Vec3 v = unitDirection(query);
    btTransform to = from;
    to.setOrigin(from.getOrigin() + query.distance * vectorOf(v.data()));
    Closest closest(query, from.getOrigin(), to.getOrigin());
    const auto sweep = [&](const btConvexShape& moving) { world_.convexSweepTest(&moving, from, to, closest, 0); };
    if constexpr (kind == Cast::triangles) {
      for (size_t i = 0; i < shape.corners.size(); i += 3) {
        btTriangleShape triangle(shape.corners[i], shape.corners[i + 1], shape.corners[i + 2]);
        triangle.setMargin(0);
        sweep(triangle);
      }
    } else {
      sweep(hullOf(shape));
    }
    if (!closest.hasHit()) return std::nullopt;
    return closest.m_closestHitFraction * query.distance;
  }

 private:
  void begin(size_t count) override {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
    objects_.clear();
    objects_.resize(count);
  }

  void place(size_t number, const Instance& instance, bool anew) override {
    const RigidPose pose = rigidPose(instance.worldFromMesh);
    if (anew) objects_[number] = std::make_unique<btCollisionObject>();
    btCollisionObject* object = objects_[number].get();
    Shape& shape = shapes_.of(instance.mesh, pose);
    if constexpr (kind == Cast::hullPastHulls) {
      object->setCollisionShape(&hullOf(shape));
    } else {
      object->setCollisionShape(shape.tree.get());
    }
    object->setWorldTransform(transformOf(pose));
    object->setUserIndex(static_cast<int>(number));
    if (anew) {
      world_.addCollisionObject(object);
    } else {
      world_.updateSingleAabb(object);
    }
  }

  ShapeCache<Shape> shapes_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

}  // namespace

std::vector<BaselineRow> bulletRows() {
  const std::string product =
      "Bullet " + std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100) + ", doubles";
  return {{.family = "Bullet hull",
           .product = product,
           .limits = "casts only convex shapes, and any other sensor as its hull, which is a different shape. No "
                     "certificate; deforming meshes need new trees.",
           .sizes = {0},
           .sections = {"front", "table1", "growth", "single"},
           .make = make<Bullet<Cast::hull>>},
          {.family = "Bullet hull past hulls",
           .product = product,
           .limits = "casts only convex shapes past convex shapes, and takes any other as its hull. No certificate.",
           .sizes = {0},
           .sections = {"single"},
           .make = make<Bullet<Cast::hullPastHulls>>},
          {.family = "Bullet triangles",
           .product = product,
           .limits = "casts the sensor triangle by triangle: any shape, at the cost of that many casts. No "
                     "certificate; deforming meshes need new trees.",
           .sizes = {0},
           .sections = {"front"},
           .make = make<Bullet<Cast::triangles>>}};
}

}  // namespace radar::tools
