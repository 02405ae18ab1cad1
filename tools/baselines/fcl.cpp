// FCL: trees of OBBRSS over triangles under a dynamic tree of boxes, at steps along the motion and then by bisection.
// FCL's continuous mode is approximate and takes one pair of objects per call, so users with a scene do not use it.
#include <fcl/fcl.h>
#include <fcl/math/motion/interp_motion.h>

#include <limits>

#include "baselines/rigid.h"

namespace radar::tools {

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Model> modelOf(const std::vector<double>& positions, const MeshData& mesh) {
  std::vector<fcl::Vector3d> vertices;
  for (size_t i = 0; i < positions.size(); i += 3) {
    vertices.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  }
  std::vector<fcl::Triangle> triangles;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    triangles.emplace_back(mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]);
  }
  auto model = std::make_shared<Model>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

fcl::Transform3d transformOf(const RigidPose& pose) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) transform.linear()(row, k) = pose.rotation[static_cast<size_t>(3 * row + k)];
    transform.translation()[row] = pose.at[static_cast<size_t>(row)];
  }
  return transform;
}

using Shapes = ShapeCache<std::shared_ptr<Model>>;

std::unique_ptr<fcl::CollisionObjectd> placed(Shapes& shapes, const Instance& instance) {
  const RigidPose pose = rigidPose(instance.worldFromMesh);
  return std::make_unique<fcl::CollisionObjectd>(shapes.of(instance.mesh, pose), transformOf(pose));
}

struct Check {
  const Query* query = nullptr;
  bool meets = false;
};

bool checkPair(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
  auto& check = *static_cast<Check*>(data);
  // The sensor has no user data.
  const fcl::CollisionObjectd* object = a->getUserData() == nullptr ? b : a;
  const auto number = reinterpret_cast<uintptr_t>(object->getUserData()) - 1;
  if (isExcluded(*check.query, static_cast<uint32_t>(number))) return false;
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  check.meets = fcl::collide(a, b, request, result) > 0;
  return check.meets;
}

bool measurePair(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& least) {
  auto& nearest = *static_cast<double*>(data);
  fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  // A negative one says that they meet.
  nearest = std::min(nearest, std::max(0.0, fcl::distance(a, b, request, result)));
  least = nearest;
  return nearest == 0;
}

bool findPair(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
  auto& meets = *static_cast<bool*>(data);
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  meets = fcl::collide(a, b, request, result) > 0;
  return meets;
}

class FclBodies : public RigidBodies {
 public:
  explicit FclBodies(const Workload& workload) : shapes_(workload, modelOf) {
    for (uint32_t i = 0; i < workload.objectCount(0); ++i) {
      objects_.push_back(placed(shapes_, workload.instance(0, i)));
      manager_.registerObject(objects_.back().get());
    }
    manager_.setup();
  }

  double distance(const Instance& body) override {
    double nearest = std::numeric_limits<double>::infinity();
    manager_.distance(placed(shapes_, body).get(), &nearest, measurePair);
    return nearest;
  }

  std::optional<double> stepped(uint32_t steps, const std::function<std::vector<Instance>(double)>& at) override {
    return steppedContact(1, steps, [&](double s) {
      bool meets = false;
      for (const Instance& body : at(s)) {
        if (!meets) manager_.collide(placed(shapes_, body).get(), &meets, findPair);
      }
      return meets;
    });
  }

  // It takes one pair a call, so the pairs are those whose boxes meet the box around the whole way.
  std::optional<double> continuous(const Instance& body, const Transform& end, uint32_t steps) override {
    const std::unique_ptr<fcl::CollisionObjectd> moving = placed(shapes_, body);
    const fcl::Transform3d from = moving->getTransform(), to = transformOf(rigidPose(end));
    const fcl::CollisionGeometryd& shape = *moving->collisionGeometry();
    const double radius = shape.aabb_center.norm() + shape.aabb_radius;
    const fcl::Vector3d low = from.translation().cwiseMin(to.translation()),
                        high = from.translation().cwiseMax(to.translation());
    fcl::Transform3d middle = fcl::Transform3d::Identity();
    middle.translation() = 0.5 * (low + high);
    fcl::CollisionObjectd region(std::make_shared<fcl::Boxd>(high - low + fcl::Vector3d::Constant(2 * radius)), middle);
    Sweep sweep{moving.get(), &region, from, to, steps};
    manager_.collide(&region, &sweep, sweepPair);
    return sweep.first;
  }

 private:
  struct Sweep {
    const fcl::CollisionObjectd *moving, *region;
    fcl::Transform3d from, to;
    uint32_t steps;
    std::optional<double> first{};
  };
  // FCL 0.7.0 would turn it about a point that it leaves unset.
  static fcl::InterpMotion<double> motionOf(const fcl::Transform3d& from, const fcl::Transform3d& to) {
    return {from.linear(), from.translation(), to.linear(), to.translation(), fcl::Vector3d::Zero()};
  }
  static bool sweepPair(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    auto& sweep = *static_cast<Sweep*>(data);
    const fcl::CollisionObjectd& object = a == sweep.region ? *b : *a;
    const fcl::ContinuousCollisionRequestd request(sweep.steps, 1e-4, fcl::CCDM_LINEAR, fcl::GST_LIBCCD,
                                                   fcl::CCDC_NAIVE);
    fcl::ContinuousCollisionResultd result;
    const fcl::Transform3d& still = object.getTransform();
    const fcl::InterpMotion<double> motion = motionOf(sweep.from, sweep.to), rest = motionOf(still, still);
    fcl::continuousCollide(sweep.moving->collisionGeometry().get(), &motion, object.collisionGeometry().get(), &rest,
                           request, result);
    if (result.is_collide) sweep.first = std::min(sweep.first.value_or(1), result.time_of_contact);
    return false;
  }

  Shapes shapes_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

class Fcl : public SceneBaseline {
 public:
  Fcl(const Workload& workload, uint32_t steps) : shapes_(workload, modelOf), steps_(steps) {}

  std::optional<double> cast(const Query& query) override {
    const std::unique_ptr<fcl::CollisionObjectd> sensor = placed(shapes_, {query.mesh, query.worldFromMesh});
    const fcl::Vector3d start = sensor->getTranslation();
    const Vec3 v = unitDirection(query);
    return steppedContact(query.distance, steps_, [&](double t) {
      sensor->setTranslation(start + t * fcl::Vector3d(v[0], v[1], v[2]));
      sensor->computeAABB();
      Check check{&query};
      manager_->collide(sensor.get(), &check, checkPair);
      return check.meets;
    });
  }

 private:
  void begin(size_t count) override {
    manager_ = std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>();
    objects_.clear();
    objects_.resize(count);
  }

  void place(size_t number, const Instance& instance, bool anew) override {
    if (!anew) manager_->unregisterObject(objects_[number].get());
    objects_[number] = placed(shapes_, instance);
    objects_[number]->setUserData(reinterpret_cast<void*>(number + 1));
    if (!anew) manager_->registerObject(objects_[number].get());
  }

  void end(bool anew) override {
    if (!anew) return;
    std::vector<fcl::CollisionObjectd*> all;
    for (const auto& object : objects_) all.push_back(object.get());
    manager_->registerObjects(all);
    manager_->setup();
  }

  Shapes shapes_;
  uint32_t steps_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::unique_ptr<fcl::DynamicAABBTreeCollisionManagerd> manager_;
};

}  // namespace

std::unique_ptr<RigidBodies> makeRigidBodies(const Workload& workload) {
  return std::make_unique<FclBodies>(workload);
}

std::vector<BaselineRow> fclRows() {
  return {{.family = "FCL steps",
           .product = "FCL " FCL_VERSION,
           .limits = "asks at a number of steps whether the shapes meet, then bisects. It passes through what is "
                     "thinner than a step. No certificate; shears, scales and deforming meshes need new trees.",
           .sizes = {16, 64, 256},
           .make = make<Fcl>}};
}

}  // namespace radar::tools
