// ODE with OPCODE, the library that the paper compares with. A linear walk over boxes finds objects, OPCODE's trees
// find triangles, at steps along the motion and then by bisection.
#include <ode/ode.h>

#include "baselines/rigid.h"

namespace radar::tools {

namespace {

// Vertices and indices must outlive the data made from them.
struct Mesh {
  std::vector<double> positions;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data = nullptr;
};

std::shared_ptr<Mesh> meshOf(const std::vector<double>& positions, const MeshData& mesh) {
  auto made =
      std::shared_ptr<Mesh>(new Mesh{positions, {mesh.indices.begin(), mesh.indices.end()}, nullptr}, [](Mesh* old) {
        dGeomTriMeshDataDestroy(old->data);
        delete old;
      });
  made->data = dGeomTriMeshDataCreate();
  dGeomTriMeshDataBuildDouble(made->data, made->positions.data(), 3 * sizeof(double),
                              static_cast<int>(made->positions.size() / 3), made->indices.data(),
                              static_cast<int>(made->indices.size()), 3 * sizeof(dTriIndex));
  return made;
}

using Geometry = std::unique_ptr<dxGeom, void (*)(dGeomID)>;

Bounds boundsOf(dGeomID geometry) {
  dReal bounds[6];
  dGeomGetAABB(geometry, bounds);
  return {{bounds[0], bounds[2], bounds[4]}, {bounds[1], bounds[3], bounds[5]}};
}

class Ode : public SceneBaseline {
 public:
  Ode(const Workload& workload, uint32_t steps) : shapes_(workload, meshOf), steps_(steps) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
  }

  std::optional<double> cast(const Query& query) override {
    const Geometry sensor = placed({query.mesh, query.worldFromMesh});
    const Bounds box = boundsOf(sensor.get());
    const Vec3 v = unitDirection(query);
    const Bounds way = swept(box, query.distance * v);
    std::vector<uint32_t> near;
    for (uint32_t i = 0; i < boxes_.size(); ++i) {
      if (meet(way, boxes_[i]) && !isExcluded(query, i)) near.push_back(i);
    }
    const dReal* position = dGeomGetPosition(sensor.get());
    const Vec3 start{position[0], position[1], position[2]};
    return steppedContact(query.distance, steps_, [&](double t) {
      const Vec3 now = start + t * v;
      dGeomSetPosition(sensor.get(), now[0], now[1], now[2]);
      const Bounds here = boundsOf(sensor.get());
      for (const uint32_t i : near) {
        dContactGeom contact;
        if (meet(here, boxes_[i]) &&
            dCollide(sensor.get(), objects_[i].get(), 1 | CONTACTS_UNIMPORTANT, &contact, sizeof contact) > 0) {
          return true;
        }
      }
      return false;
    });
  }

 private:
  void begin(size_t) override {
    objects_.clear();
    boxes_.clear();
  }

  void place(size_t number, const Instance& instance, bool anew) override {
    if (anew) {
      objects_.emplace_back(nullptr, dGeomDestroy);
      boxes_.emplace_back();
    }
    objects_[number] = placed(instance);
    boxes_[number] = boundsOf(objects_[number].get());
  }

  Geometry placed(const Instance& instance) {
    const RigidPose pose = rigidPose(instance.worldFromMesh);
    const std::shared_ptr<Mesh>& mesh = shapes_.of(instance.mesh, pose);
    Geometry geometry(dCreateTriMesh(nullptr, mesh->data, nullptr, nullptr, nullptr), dGeomDestroy);
    const auto& r = pose.rotation;
    const dMatrix3 rotation{r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], r[7], r[8], 0};
    dGeomSetRotation(geometry.get(), rotation);
    dGeomSetPosition(geometry.get(), pose.at[0], pose.at[1], pose.at[2]);
    return geometry;
  }

  ShapeCache<std::shared_ptr<Mesh>> shapes_;
  uint32_t steps_;
  std::vector<Geometry> objects_;
  std::vector<Bounds> boxes_;
};

}  // namespace

std::vector<BaselineRow> odeRows() {
  return {{.family = "ODE/OPCODE steps",
           .product = "ODE " dODE_VERSION,
           .limits = "asks at a number of steps whether the shapes meet, then bisects. It passes through what is "
                     "thinner than a step, and misses what lies inside another shape without a contact point. No "
                     "certificate; one thread; shears, scales and deforming meshes need new trees.",
           .sizes = {16, 64, 256},
           .threads = false,
           .make = make<Ode>}};
}

}  // namespace radar::tools
