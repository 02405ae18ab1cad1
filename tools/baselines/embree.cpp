// Embree, in two ways: a ray per pixel from the sensor's front into the scene, like the paper's pictures; or a ray from
// each vertex, of the sensor into the scene and of the scene back onto the sensor.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>

#include "baselines/rigid.h"

// Releases 3 and 4 differ in how rays are asked.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#if RTC_VERSION_MAJOR < 4
using RTCRayQueryContext = RTCIntersectContext;
using RTCRayQueryFlags = RTCIntersectContextFlags;
constexpr RTCRayQueryFlags RTC_RAY_QUERY_FLAG_COHERENT = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
constexpr RTCRayQueryFlags RTC_RAY_QUERY_FLAG_INCOHERENT = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
constexpr RTCSceneFlags RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

namespace radar::tools {

namespace {

using SceneHandle = std::unique_ptr<RTCSceneTy, void (*)(RTCScene)>;
constexpr uint32_t kPacket = 8;

// Axes across a unit vector.
std::pair<Vec3, Vec3> across(const Vec3& w) {
  const size_t least = std::abs(w[0]) < std::abs(w[1]) ? (std::abs(w[0]) < std::abs(w[2]) ? 0 : 2)
                                                       : (std::abs(w[1]) < std::abs(w[2]) ? 1 : 2);
  Vec3 u{};
  u[least] = 1;
  u = u - w[least] * w;
  u = (1 / lengthOf(u)) * u;
  return {u, {w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]}};
}

// World to mesh.
struct Inverse {
  explicit Inverse(const Transform& pose) : at{pose.m[3], pose.m[7], pose.m[11]} {
    const auto& m = pose.m;
    const auto minor = [&](size_t a, size_t b, size_t c, size_t d) { return m[a] * m[d] - m[b] * m[c]; };
    const double determinant = m[0] * minor(5, 6, 9, 10) - m[1] * minor(4, 6, 8, 10) + m[2] * minor(4, 5, 8, 9);
    linear = {minor(5, 6, 9, 10), -minor(1, 2, 9, 10), minor(1, 2, 5, 6),  -minor(4, 6, 8, 10), minor(0, 2, 8, 10),
              -minor(0, 2, 4, 6), minor(4, 5, 8, 9),   -minor(0, 1, 8, 9), minor(0, 1, 4, 5)};
    for (double& value : linear) value /= determinant;
  }
  Vec3 placed(const Vec3& p) const { return turned(linear, p - at); }

  Rotation linear{};
  Vec3 at;
};

// Asks rays. `query`: leaves out the instances that it excludes; null: none.
class Rays : RTCRayQueryContext {
 public:
  Rays(const Query* query, RTCRayQueryFlags coherence) : query_(query) {
    const RTCFilterFunctionN filterFunction = query == nullptr || query->exclude.empty() ? nullptr : leaveOut;
#if RTC_VERSION_MAJOR < 4
    rtcInitIntersectContext(this);
    flags = coherence;
    filter = filterFunction;
#else
    rtcInitRayQueryContext(this);
    rtcInitIntersectArguments(&arguments_);
    arguments_.context = this;
    arguments_.flags =
        filterFunction == nullptr ? coherence : RTCRayQueryFlags(coherence | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
    arguments_.filter = filterFunction;
#endif
  }
  Rays(const Rays&) = delete;
  Rays& operator=(const Rays&) = delete;

#if RTC_VERSION_MAJOR < 4
  void ask(RTCScene scene, RTCRayHit& ray) {
    rtcIntersect1(scene, this, &ray);
  }
  void ask(RTCScene scene, const int* valid, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, this, &rays);
  }
#else
  void ask(RTCScene scene, RTCRayHit& ray) {
    rtcIntersect1(scene, &ray, &arguments_);
  }
  void ask(RTCScene scene, const int* valid, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &arguments_);
  }
#endif

 private:
  static void leaveOut(const RTCFilterFunctionNArguments* arguments) {
    const auto& self = *static_cast<const Rays*>(arguments->context);
    for (uint32_t i = 0; i < arguments->N; ++i) {
      if (isExcluded(*self.query_, RTCHitN_instID(arguments->hit, arguments->N, i, 0))) arguments->valid[i] = 0;
    }
  }

  const Query* query_;
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments_;
#endif
};

// One ray per lane; lanes without a ray are off.
struct Packet {
  alignas(32) int valid[kPacket] = {};
  RTCRayHit8 rays{};
  void set(uint32_t lane, const Vec3& origin, const Vec3& direction, double far) {
    valid[lane] = -1;
    rays.ray.org_x[lane] = static_cast<float>(origin[0]);
    rays.ray.org_y[lane] = static_cast<float>(origin[1]);
    rays.ray.org_z[lane] = static_cast<float>(origin[2]);
    rays.ray.dir_x[lane] = static_cast<float>(direction[0]);
    rays.ray.dir_y[lane] = static_cast<float>(direction[1]);
    rays.ray.dir_z[lane] = static_cast<float>(direction[2]);
    rays.ray.tnear[lane] = 0;
    rays.ray.tfar[lane] = static_cast<float>(far);
    rays.ray.mask[lane] = ~0u;
    rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
  bool hit(uint32_t lane) const { return valid[lane] != 0 && rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID; }
};

using DeviceHandle = std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)>;

DeviceHandle openDevice(const char* options) {
  DeviceHandle device(rtcNewDevice(options), rtcReleaseDevice);
  if (!device) throw std::runtime_error("does not open");
  return device;
}

SceneHandle newScene(RTCDevice device) {
  SceneHandle scene(rtcNewScene(device), rtcReleaseScene);
  rtcSetSceneFlags(scene.get(),
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS));
  return scene;
}

SceneHandle sceneOf(RTCDevice device, const MeshData& mesh, RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM) {
  SceneHandle scene = newScene(device);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, quality);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                           mesh.vertexCount());
  std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<float*>(vertices));
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                          mesh.triangleCount());
  std::copy(mesh.indices.begin(), mesh.indices.end(), static_cast<uint32_t*>(indices));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  return scene;
}

void setPlace(RTCGeometry instance, const Transform& worldFromMesh) {
  float transform[12];
  std::copy(worldFromMesh.m.begin(), worldFromMesh.m.end(), transform);
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, transform);
  rtcCommitGeometry(instance);
}

void addInstance(RTCDevice device, RTCScene top, RTCScene mesh, unsigned number, const Transform& worldFromMesh) {
  const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, mesh);
  setPlace(instance, worldFromMesh);
  rtcAttachGeometryByID(top, instance, number);
  rtcReleaseGeometry(instance);
}

class Embree : public SceneBaseline {
 public:
  Embree(const Workload& workload, uint32_t)
      : workload_(workload), device_(openDevice("threads=1")), top_(nullptr, rtcReleaseScene) {
    if (rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) == 0) {
      throw std::runtime_error("has no packets of 8 rays on this processor");
    }
    for (const MeshData& mesh : workload.meshes) meshes_.push_back(sceneOf(device_.get(), mesh));
  }

 protected:
  void begin(size_t count) override {
    top_ = newScene(device_.get());
    boxes_.assign(count, {});
  }

  void place(size_t number, const Instance& object, bool anew) override {
    const MeshData& mesh = workload_.meshes[object.mesh];
    boxes_[number] = boundsOf({mesh.positions, mesh.indices}, object.worldFromMesh);
    const auto at = static_cast<unsigned>(number);
    if (anew) {
      addInstance(device_.get(), top_.get(), meshes_[object.mesh].get(), at, object.worldFromMesh);
    } else {
      setPlace(rtcGetGeometry(top_.get(), at), object.worldFromMesh);
    }
  }

  void end(bool) override { rtcCommitScene(top_.get()); }

  const Workload& workload_;
  DeviceHandle device_;
  std::vector<SceneHandle> meshes_;
  SceneHandle top_;
  std::vector<Bounds> boxes_;
};

// For each pixel, a ray from ahead finds the sensor's front, and a second ray goes from there into the scene.
class PixelRays : public Embree {
 public:
  PixelRays(const Workload& workload, uint32_t resolution) : Embree(workload, 0), resolution_(resolution) {}

  std::optional<double> cast(const Query& query) override {
    const Vec3 w = unitDirection(query);
    const auto [u, v] = across(w);
    const MeshData& mesh = workload_.meshes[query.mesh];
    Bounds front;  // along u, v and w
    for (const uint32_t vertex : mesh.indices) {
      const Vec3 p = transformPoint(query.worldFromMesh, &mesh.positions[3 * size_t{vertex}]);
      front.add({dot(p, u), dot(p, v), dot(p, w)});
    }
    const auto& [low, high] = front;
    const double pixel = std::max(high[0] - low[0], high[1] - low[1]) / resolution_;
    if (!(pixel > 0)) return std::nullopt;
    const Inverse meshFromWorld(query.worldFromMesh);
    const double ahead = high[2] + pixel, depth = high[2] - low[2] + 2 * pixel;
    const Vec3 back = turned(meshFromWorld.linear, -1 * w);
    Rays own(nullptr, RTC_RAY_QUERY_FLAG_COHERENT), scene(&query, RTC_RAY_QUERY_FLAG_COHERENT);
    double best = std::nextafter(static_cast<float>(query.distance), INFINITY);
    bool found = false;
    for (double y = low[1] + 0.5 * pixel; y < high[1]; y += pixel) {
      for (double x = low[0] + 0.5 * pixel; x < high[0]; x += kPacket * pixel) {
        Vec3 starts[kPacket];
        Packet onto, into;
        for (uint32_t lane = 0; lane < kPacket && x + lane * pixel < high[0]; ++lane) {
          starts[lane] = (x + lane * pixel) * u + y * v + ahead * w;
          onto.set(lane, meshFromWorld.placed(starts[lane]), back, depth);
        }
        own.ask(meshes_[query.mesh].get(), onto.valid, onto.rays);
        for (uint32_t lane = 0; lane < kPacket; ++lane) {
          if (onto.hit(lane)) into.set(lane, starts[lane] - double{onto.rays.ray.tfar[lane]} * w, w, best);
        }
        scene.ask(top_.get(), into.valid, into.rays);
        for (uint32_t lane = 0; lane < kPacket; ++lane) {
          if (!into.hit(lane)) continue;
          best = std::min(best, double{into.rays.ray.tfar[lane]});
          found = true;
        }
      }
    }
    return found ? std::optional(best) : std::nullopt;
  }

 private:
  uint32_t resolution_;
};

class VertexRays : public Embree {
 public:
  using Embree::Embree;

  std::optional<double> cast(const Query& query) override {
    const Vec3 w = unitDirection(query);
    const MeshData& mesh = workload_.meshes[query.mesh];
    Rays own(nullptr, RTC_RAY_QUERY_FLAG_INCOHERENT), scene(&query, RTC_RAY_QUERY_FLAG_INCOHERENT);
    double best = std::nextafter(static_cast<float>(query.distance), INFINITY);
    bool found = false;
    const auto shoot = [&](RTCScene target, Rays& rays, const Vec3& origin, const Vec3& direction) {
      RTCRayHit ray{};
      ray.ray.org_x = float(origin[0]), ray.ray.org_y = float(origin[1]), ray.ray.org_z = float(origin[2]);
      ray.ray.dir_x = float(direction[0]), ray.ray.dir_y = float(direction[1]), ray.ray.dir_z = float(direction[2]);
      ray.ray.tfar = float(best);
      ray.ray.mask = ~0u;
      ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rays.ask(target, ray);
      if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
      best = std::min(best, double{ray.ray.tfar});
      found = true;
    };
    for (size_t i = 0; i < mesh.positions.size(); i += 3) {
      shoot(top_.get(), scene, transformPoint(query.worldFromMesh, &mesh.positions[i]), w);
    }
    const Bounds way = swept(boundsOf({mesh.positions, mesh.indices}, query.worldFromMesh), query.distance * w);
    const Inverse meshFromWorld(query.worldFromMesh);
    const Vec3 back = turned(meshFromWorld.linear, -1 * w);
    for (uint32_t object = 0; object < shown_.size(); ++object) {
      if (!meet(way, boxes_[object]) || isExcluded(query, object)) continue;
      const MeshData& other = workload_.meshes[shown_[object].mesh];
      for (size_t i = 0; i < other.positions.size(); i += 3) {
        const Vec3 p = transformPoint(shown_[object].worldFromMesh, &other.positions[i]);
        if (!meet(way, {p, p})) continue;
        shoot(meshes_[query.mesh].get(), own, meshFromWorld.placed(p), back);
      }
    }
    return found ? std::optional(best) : std::nullopt;
  }
};

template <class Work>
double secondsOf(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::optional<TreeCost> embreeTree(const MeshData& mesh, std::span<const float> moved,
                                   std::span<const Transform> places) {
  std::atomic<ptrdiff_t> held = 0;
  const DeviceHandle device = openDevice("");
  rtcSetDeviceMemoryMonitorFunction(
      device.get(),
      [](void* sum, ssize_t bytes, bool) {
        *static_cast<std::atomic<ptrdiff_t>*>(sum) += bytes;
        return true;
      },
      &held);
  TreeCost cost;
  SceneHandle below(nullptr, rtcReleaseScene), top(nullptr, rtcReleaseScene);
  const double build = secondsOf([&] { below = sceneOf(device.get(), mesh); });
  if (places.empty()) {
    cost.build = build;
    cost.bytes = static_cast<double>(held);
    below = sceneOf(device.get(), mesh, RTC_BUILD_QUALITY_REFIT);
    cost.refit = secondsOf([&] {
      const RTCGeometry geometry = rtcGetGeometry(below.get(), 0);
      std::copy(moved.begin(), moved.end(),
                static_cast<float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0)));
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry);
      rtcCommitScene(below.get());
    });
    return cost;
  }
  const ptrdiff_t before = held;
  cost.build = secondsOf([&] {
    top = newScene(device.get());
    for (size_t i = 0; i < places.size(); ++i) {
      addInstance(device.get(), top.get(), below.get(), static_cast<unsigned>(i), places[i]);
    }
    rtcCommitScene(top.get());
  });
  cost.bytes = static_cast<double>(held - before);
  cost.refit = secondsOf([&] {
    for (size_t i = 0; i < places.size(); ++i) {
      setPlace(rtcGetGeometry(top.get(), static_cast<unsigned>(i)), places[i]);
    }
    rtcCommitScene(top.get());
  });
  return cost;
}

std::vector<BaselineRow> embreeRows() {
  const std::string product = "Embree " RTC_VERSION_STRING;
  return {
      {.family = "Embree rays",
       .product = product,
       .limits = "one ray per pixel from the sensor's front. It misses what lies between pixels, what lies behind the "
                 "front in a concavity, and what surrounds the start. No certificate; deforming meshes need new trees.",
       .sizes = {16, 32, 64, 128, 256, 512, 1024},
       .make = make<PixelRays>},
      {.family = "Embree vertex rays",
       .product = product,
       .limits = "rays from the vertices of both sides. It misses contacts of two edges. No certificate; deforming "
                 "meshes need new trees.",
       .sizes = {0},
       .make = make<VertexRays>}};
}

}  // namespace radar::tools
