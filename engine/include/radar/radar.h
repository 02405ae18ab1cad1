// Cyber Radar: how far can a shape move along a direction before its surface first touches anything?
//
// The public interface; see also cpu_sweeper.h (the CPU alone), pool.h (several devices) and recorder.h (a host's own
// command buffers). Lengths may be in any one unit; angles never appear. Coordinates may be left- or right-handed.
// Meshes are two-sided triangle soups: winding is ignored, and they need not be closed or connected.
//
// Ranges: mode contact accepts all finite numbers. The CPU answers what floats cannot hold; a Recorder cannot fall back
// on the CPU, so recorder.h lists these limits. Mode sampled answers Status::invalid, with a reason, if coordinates
// exceed 2^80, the sensor's size is below 2^-80, an object in reach is more than 2^40 times as large as the sensor, or
// the components of a direction differ by a factor of more than about 2^1000.
//
// Threads: each object of this header may be used by one thread at a time. Different objects are independent, except
// that a Sweeper reads its Scene during run() and scopes().
//
// Errors: a failed set-up, or an argument that breaks its contract, throws radar::Error. A query that cannot be
// answered gets Status::invalid; other queries are unaffected.
//
// Method: T. Iida, H. Yamachi, Y. Kambayashi, Y. Tsujimura, "Comparison and Multi-GPU based Implementation of a
// Collision Detection Method with Z-buffer in Cyber Space". R, M, L, d below are that paper's; docs/method.md has the
// mathematics.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

// Exports a symbol from a shared library.
#if defined(_WIN32)
#define RADAR_API
#else
#define RADAR_API __attribute__((visibility("default")))
#endif

namespace radar {

/// Semantic version of this interface: before 1.0 a new minor version may break compatibility, a patch never does.
inline constexpr uint32_t kVersionMajor = 0;
inline constexpr uint32_t kVersionMinor = 1;
inline constexpr uint32_t kVersionPatch = 0;

/// No object, no triangle.
inline constexpr uint32_t kNone = 0xffffffffu;

/// The message names the call, the value and what was expected. `reasons`: one line per device if no device was usable,
/// else empty. `result`: the VkResult of a failed Vulkan call, else VK_SUCCESS.
class RADAR_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what, VkResult code = VK_SUCCESS, std::vector<std::string> perDevice = {})
      : std::runtime_error(what), result(code), reasons(std::move(perDevice)) {}
  VkResult result;
  std::vector<std::string> reasons;
};

/// A placement: world = M p + t, with row-major rows (m0 m1 m2 t). M is any invertible matrix, mirrors included.
/// Vertices are placed as ((m0*x + m1*y) + m2*z) + t in double precision, without fused multiply-add; this result *is*
/// the geometry.
struct Transform {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  friend bool operator==(const Transform&, const Transform&) = default;
};

/// Places the mesh vertex `p` by the formula above.
RADAR_API std::array<double, 3> transformPoint(const Transform& pose, const float* p);

/// Ids are small integers. An id names one mesh or object until that is removed, whatever else is added or removed. New
/// items get the least free id, so objects added to a fresh scene are 0, 1, 2, ...
using MeshId = uint32_t;
using ObjectId = uint32_t;

/// An axis-aligned box, ends included.
struct Bounds {
  std::array<double, 3> lo{}, hi{};
};

/// A triangle mesh, as passed to addMesh.
struct MeshView {
  std::span<const float> positions;   ///< 3 floats per vertex
  std::span<const uint32_t> indices;  ///< 3 vertex numbers per triangle; triangle ids count in this order
  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
};

/// An object of the scene: a placed mesh.
struct Object {
  MeshId mesh = kNone;
  Transform worldFromMesh;
  uint32_t mask = ~0u;  ///< takes part in a query if it shares a bit with the query's mask
  /// How far it moves during the step that queries ask about, at constant velocity, world units: see Query::motion.
  std::array<double, 3> motion{};
};

/// Meshes, and objects that place them. Plain data on the CPU, independent of any device; any number of sweepers may
/// read it. Input is copied.
class RADAR_API Scene {
 public:
  Scene();
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Adds a mesh of positions.size()/3 vertices and indices.size()/3 triangles. Throws if it has no triangle, a size is
  /// not a multiple of 3, a number is not finite, or an index is out of range; with `bounds`, also if a lower bound
  /// exceeds its upper bound, or a bound or position exceeds 2^120.
  ///
  /// `bounds`, mesh units: declares that the host will deform the mesh on its device within them
  /// (radar/host_geometry.h). `positions` are then the rest pose: the closer they are to the deformed mesh, the faster
  /// the search. All other calls use these positions.
  MeshId addMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                 const std::optional<Bounds>& bounds = std::nullopt);
  /// Moves the vertices of a mesh: 3 floats for each, as many as it has. Its tree is fitted to them, and built anew
  /// only if that would make it much worse. Throws if the mesh does not exist, was declared with `bounds`, has another
  /// number of vertices, or a number is not finite.
  void setPositions(MeshId mesh, std::span<const float> positions);
  /// Throws if an object uses the mesh.
  void removeMesh(MeshId mesh);

  /// Throws if the mesh does not exist, the pose is singular or not finite, or a component of the motion is above
  /// 2^1000.
  ObjectId addObject(const Object& object);
  void setTransform(ObjectId object, const Transform& worldFromMesh);
  /// Sets Object::motion. The pose stays that at the start of the step.
  void setMotion(ObjectId object, const std::array<double, 3>& motion);
  /// Declares that the host will move the object on its device within `world` (radar/host_geometry.h). Larger bounds
  /// cost more time. All other calls use the object's pose. Replaces earlier bounds; removing the object removes them.
  /// Throws if the object does not exist, a lower bound exceeds its upper bound, or a bound exceeds 2^120.
  void setBounds(ObjectId object, const Bounds& world);
  void removeObject(ObjectId object);

  bool hasMesh(MeshId mesh) const;
  bool hasObject(ObjectId object) const;
  /// Valid until the mesh is removed.
  MeshView mesh(MeshId mesh) const;
  /// Valid until the scene changes.
  const Object& object(ObjectId object) const;
  /// Every id in use is below this.
  MeshId meshLimit() const;
  ObjectId objectLimit() const;

  /// Increases with every change of a mesh or object.
  uint64_t version() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Which method answers a query.
enum class Mode : uint32_t {
  sampled,  ///< select, then the paper's method: `hi` is certain, `lo` is 0, a contact may be missed
  contact   ///< the exact search, on the device or on the CPU: never undecided, unless Query::clearance is above 0
};

/// One sweep: the sensor `mesh`, placed by `worldFromMesh`, moves along `direction` for `distance`.
struct Query {
  MeshId mesh = kNone;                ///< of the scene
  Transform worldFromMesh;            ///< invertible
  std::array<double, 3> direction{};  ///< finite, not zero; its length does not matter
  double distance = 0;                ///< D >= 0, finite, world units
  Mode mode = Mode::contact;
  bool anyHit = false;            ///< asks only whether there is contact within D: see Result. Cheaper if there is
  std::vector<ObjectId> exclude;  ///< objects to ignore, such as the sensor's own; at most a handful
  uint32_t mask = ~0u;            ///< an object takes part if its mask shares a bit

  /// Mode contact, instead of `direction` and `distance`, which stay 0: how far the sensor moves during a step, world
  /// units, at constant velocity; may be zero. Objects move by Object::motion meanwhile. First contact is that of the
  /// relative motion, and t, lo and hi are fractions of the step. If objects move, a query with a direction takes a
  /// step, too, in which the sensor moves by D; t is then the fraction times D. Relative motions round once.
  std::optional<std::array<double, 3>> motion;

  /// Mode contact: counts only pairs of triangles that block, as placed at the start. A pair does not block if a plane
  /// keeps the triangles apart and the motion does not go against it: what rests on something may leave it or slide
  /// along it. Triangles in one plane that face each other and overlap block exactly if the direction goes into the
  /// object's. Exact for closed meshes, wound outwards, whose interiors are disjoint at the start; docs/exact.md has
  /// the rule.
  bool ignoreLeaving = false;
  /// Mode contact: objects whose surfaces cross the sensor's at the start, by more than the slack, take no part and are
  /// listed (Lists::overlapping). Whether a motion deepens an interpenetration cannot be told from surfaces.
  bool skipOverlapping = false;
  /// With the two above, world units: by how much rounding may have let surfaces that touch sink into each other. Faces
  /// pressed together block even so, at t = 0; crossings no deeper are no overlap. It is for rounding: far below the
  /// size of triangles. Without a value: 2^-48 times the greatest coordinate of the two shapes as placed (its terms'
  /// absolute values summed), which covers poses rounded once.
  std::optional<double> slack;
  /// Mode contact, world units, at least 0: surfaces are in contact where their distance is at most this. If above 0, t
  /// is lo, and hi - lo at most `tolerance`, if rounding allows: an object that passes at the clearance to within
  /// rounding leaves the answer undecided, or lowers lo. `point` is of the touched surface, and `normal` may point
  /// along the motion if they are in contact at the start. With `ignoreLeaving`, pairs that do not block take no part,
  /// however near they come.
  double clearance = 0;
  /// With `clearance`, world units, at least 0. Without a value: 1e-6 of the longest side of the sensor's box.
  std::optional<double> tolerance;
  /// Mode contact: lists the first contacts with this many nearest objects (Lists::hits), one per object; kAllHits:
  /// with all in reach. 1: no list.
  uint32_t hits = 1;

  /// Mode sampled: pixels along the window's longer side, up to kMaxResolution. 0: chosen from the meshes.
  uint32_t resolution = 0;
};

inline constexpr uint32_t kMaxResolution = 2048;
inline constexpr uint32_t kAllHits = 0xffffffffu;

enum class Status : uint32_t {
  hit,        ///< certain contact within D: t*, the exact distance, lies in [lo, hi], hi <= D
  clear,      ///< certainly no contact within D
  overlap,    ///< certain contact at the start: t = lo = hi = 0
  undecided,  ///< no contact before lo; later contact is possible
  invalid     ///< not answered; Sweeper::reason gives the reason
};

/// The stage that produced an answer.
enum class Tier : uint32_t { select, sampled, contact, reference };

/// The paper's first step: whether any surface lies in the target volume.
enum class Detected : uint32_t {
  no,        ///< certainly none (after sampling: none at any pixel centre)
  yes,       ///< at least one
  notLooked  ///< not determined
};

/// A part of a triangle; the value is the number of its corners.
enum class Feature : uint32_t { none, vertex, edge, face };

/// Bits of Result::flags: why a Recorder (radar/recorder.h) gave no answer.
inline constexpr uint32_t kFlagUnresolved =
    1;  ///< pairs of triangles too close for the device: Recorder::read() decides
inline constexpr uint32_t kFlagCandidates = 2;  ///< Capacity::candidates, or a list of the search, was too small
inline constexpr uint32_t kFlagRounds = 4;      ///< Capacity::rounds was too small
inline constexpr uint32_t kFlagRange = 8;       ///< floats cannot hold the scene, or the sensor or D relative to it
inline constexpr uint32_t kFlagBounds = 16;     ///< a vertex or an object of HostGeometry has left its declared bounds

/// An answer. Layout version 3: 128 bytes, natural alignment. Absent ids are kNone. Where no contact within D is
/// certain, t, hi and fraction are +infinity, and if the answer is clear, lo is, too: distances of any answers compare.
/// Other absent numbers, and all of an invalid answer, are NaN.
///
/// If the query has `anyHit`, the status is hit (overlap included), clear or undecided; ids, features, point and
/// normal are absent, and for a hit t and fraction are; then lo is 0 and hi at most D (in mode contact: D).
struct RADAR_API Result {
  Status status = Status::invalid;
  Tier tier = Tier::select;
  Detected detected = Detected::notLooked;
  uint32_t resolution = 0;  ///< pixels along the window's longer side; 0 if no picture was drawn
  double t;                 ///< best estimate of t*, world units; tier sampled: hi
  double lo, hi;            ///< the certified bracket, world units
  double fraction;          ///< t / D (0 if D is 0); of the step, if the query takes one
  ObjectId object = kNone;  ///< the object touched
  uint32_t triB = kNone;    ///< its triangle
  uint32_t triA = kNone;    ///< the sensor's triangle
  uint32_t flags = 0;       ///< kFlag*: why a Recorder gave no answer; else 0
  /// The smallest features of the two triangles that contain every point at which they touch then, exactly; with a
  /// clearance, of the nearest points. Tier sampled: those that were found, none at the start.
  Feature featureB = Feature::none, featureA = Feature::none;
  std::array<double, 3> point;   ///< world position of the contact at the moment of contact
  std::array<double, 3> normal;  ///< unit, from the touched surface towards the sensor: normal . direction <= 0
  double paperMinL;              ///< the paper's literal min(L), for comparison: may be negative, too early or too late
  Result();
  /// An answer without a contact: clear or undecided, with lo to be set. Others as above.
  explicit Result(Status status);
};
inline constexpr uint32_t kResultVersion = 3;
static_assert(sizeof(Result) == 128);

/// What the queries of a batch list besides their first contacts. All vectors are empty if no query lists anything.
struct RADAR_API Lists {
  /// Of queries with `hits` above 1: the first contact with each object, by (t, object), t being exact and not rounded.
  /// Those of query i begin at hitOffsets[i] and end before hitOffsets[i + 1]. With a clearance, by (lo, object), and
  /// beside as many objects as were asked for those that are undecided: they have a lo, but no finite hi.
  std::vector<Result> hits;
  std::vector<size_t> hitOffsets;
  /// Of queries with `skipOverlapping`: the objects left out, ascending. Offsets as above.
  std::vector<ObjectId> overlapping;
  std::vector<size_t> overlappingOffsets;

  std::span<const Result> hitsOf(size_t query) const;
  std::span<const ObjectId> overlappingOf(size_t query) const;
};

/// Check the contracts of Scene and Query. Return an empty string, or what is wrong and what was expected.
RADAR_API std::string validate(const Transform& worldFromMesh);
RADAR_API std::string validate(const Query& query, const Scene& scene);

// ---------------------------------------------------------------------------------------------------------------------

/// A limit of a physical device that shaders rely on; `name` is its name in VkPhysicalDeviceLimits.
struct DeviceLimit {
  std::string name;
  uint64_t needed = 0, has = 0;  ///< the least value needed; the device's value
  Mode mode = Mode::contact;     ///< the mode that needs it; sampled needs everything that contact needs
};

/// What is known of a physical device.
struct DeviceReport {
  std::string name, driver, type;
  std::vector<std::string> reasons;         ///< why it cannot be used; empty if it can
  std::vector<std::string> sampledReasons;  ///< why it does not support mode sampled; empty if it does
  std::string version;                      ///< the device's Vulkan version: "1.3.224"
  uint64_t memory = 0;                      ///< size of the largest device-local heap, bytes
  uint32_t subgroup = 0;                    ///< invocations in a workgroup of the search; 0 before Vulkan 1.3
  bool doubles = false;                     ///< supports shaderFloat64
  std::vector<DeviceLimit> limits;          ///< empty before Vulkan 1.3
  bool usable() const { return reasons.empty(); }
};

/// Lists the Vulkan loader's physical devices, in its order. Throws if there is no loader or no driver.
RADAR_API std::vector<DeviceReport> listDevices();

/// Vulkan handles that the host owns. All outlive the Device made from them. `device` has the features of
/// requirements() enabled. `queue` belongs to family `queueFamily`, which supports compute and, for mode sampled,
/// graphics.
///
/// `queue` may be null if the host makes every submission itself. The engine then never submits: a Recorder works in
/// full; a Sweeper, a Pool and addMesh() of a HostMesh throw Error. Without a queue the device's doubles cannot be
/// compared with the CPU's, so `doubles` is trusted: if they differ, answers may be wrong. If unsure, pass false, or
/// the value that Device::doubles() gave when the same device and driver were adopted with a queue.
struct HostDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  VkQueue queue = VK_NULL_HANDLE;
  bool doubles = true;      ///< shaderFloat64 is enabled on `device`
  bool sampled = false;     ///< the features of requirements(Mode::sampled, ...) are enabled on `device`
  bool debugNames = false;  ///< VK_EXT_debug_utils is enabled on the instance
  /// Used to look up all Vulkan functions. Null: the system's loader.
  PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
  const VkAllocationCallbacks* allocator = nullptr;  ///< for the engine's objects, not the loader's
  VkPipelineCache pipelineCache = VK_NULL_HANDLE;    ///< for every pipeline; optional
  /// Called around each vkQueueSubmit2, on the submitting thread. Set both if other threads use the queue too, else
  /// none.
  std::function<void()> lockQueue, unlockQueue;
};

/// What a VkDevice must have enabled: the version, and VK_TRUE for each feature needed. The host chains it into its
/// VkDeviceCreateInfo (without pEnabledFeatures), or copies the enabled features into its own structs.
struct Requirements {
  uint32_t apiVersion = VK_API_VERSION_1_3;  ///< of instance and device
  VkPhysicalDeviceFeatures2 core{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan12Features vulkan12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features vulkan13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  /// For VkDeviceCreateInfo::pNext: chains all three structs, then `next`. Valid until this object moves or ends.
  const void* chain(void* next = nullptr);
};
/// `mode`: sampled needs everything that contact needs, and graphics. `doubles`: includes shaderFloat64, which is
/// optional but lets mode contact leave less to the CPU.
RADAR_API Requirements requirements(Mode mode, bool doubles);

/// Why a host's physical device cannot be used for `mode`: one line per missing item, empty if it can. Reads only
/// `instance`, `physicalDevice` and `getInstanceProcAddr`.
RADAR_API std::vector<std::string> unsupportedReasons(const HostDevice& host, Mode mode);

struct DeviceOptions {
  uint32_t index = kNone;  ///< into listDevices(); kNone: the best usable one (discrete, integrated, virtual, CPU)
  /// Receives each warning or error of active validation layers, on any thread.
  std::function<void(const std::string&)> onValidation;
  bool doubles = true;  ///< false: do not use them, as if shaderFloat64 were missing
};

/// A logical device with one queue: opened here and owned, or borrowed from a host.
class RADAR_API Device {
 public:
  /// Throws, listing devices and reasons, if no device is usable, or the requested one is not.
  static Device open(const DeviceOptions& options = {});
  /// Throws with reasons if the physical device lacks what mode contact needs, or its arithmetic breaks the error
  /// bounds. While this call or a Sweeper of this device runs, the host keeps other threads from using `queue`, unless
  /// it gives the lock functions. If `host` has a queue, submits at most twice, to check the arithmetic. Any number of
  /// Devices may be made from one VkDevice.
  static Device adopt(const HostDevice& host);
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const std::string& name() const;
  const std::string& driver() const;
  /// Whether the device supports a mode: contact always; sampled needs graphics.
  bool supports(Mode mode) const;
  /// Whether the device solves pairs in double precision. It does if it has doubles and the checks at opening
  /// (radar/arithmetic.h) found the operations involved to match the CPU's, bit for bit. Otherwise it solves pairs in
  /// float, with error bounds, and the CPU decides what that leaves open: the answers are the same. Without a queue:
  /// HostDevice::doubles, untested.
  bool doubles() const;
  const HostDevice& handles() const;

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  explicit Device(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

struct SweeperOptions {
  /// Mode sampled; false: draws every object for every sensor, the naive baseline. The answers are the same.
  bool select = true;
  bool timestamps = false;  ///< measures each stage, at a small cost
  /// Upper bound on device memory for the pictures of one submission, bytes; larger batches are split. Memory kept
  /// between submissions is at most twice this.
  uint64_t pictureBytes = 256ull << 20;
  /// Batches with fewer queries of mode contact are answered on the CPU, with the same answers. 0: none. kNone: 16, or
  /// every batch if the device runs on the CPU (lavapipe), where its search is slower.
  uint32_t cpuBatch = kNone;
  uint32_t cpuThreads = 0;  ///< threads of the CPU's search; 0: one per core
};

/// Time of one stage, summed over the submissions of the last run(), milliseconds.
struct StageTime {
  std::string name;
  double ms = 0;
};

/// Statistics of the last run().
struct SweepStats {
  uint32_t submissions = 0;
  uint64_t drawnObjects = 0;      ///< objects drawn, summed over sensors
  uint64_t drawnTriangles = 0;    ///< triangles drawn for R and M, summed over sensors
  uint64_t pairs = 0;             ///< proposed pairs of triangles (sampled), pairs of leaves (contact)
  uint64_t cpuPairs = 0;          ///< pairs of triangles left to the CPU
  uint64_t cpuQueries = 0;        ///< queries answered by the CPU alone (contact)
  uint64_t nodePairs = 0;         ///< node pairs tested on the device (contact)
  uint64_t solves = 0;            ///< pairs of triangles solved on the device (contact)
  std::vector<StageTime> stages;  ///< with SweeperOptions::timestamps, CPU stages included; else empty
};

/// The scopes of one query as pictures: row-major from the window's lower left corner, `width` x `height` floats, world
/// units along the motion. NaN if R is empty, the sensor does not cover the pixel, or there is no L.
struct Scopes {
  uint32_t width = 0, height = 0;
  double pixel = 0;      ///< side of a pixel, world units
  double d = 0;          ///< target area distance: sensor length + D
  double length = 0;     ///< extent of the sensor along the motion
  std::vector<float> R;  ///< from the sensor's back plane to the scene
  std::vector<float> M;  ///< from the far end of the target volume back to the sensor
  std::vector<float> L;  ///< R + M - d
  /// worldFromWindow: world = origin + right*u + up*v + forward*w for u, v, w in world units from the window's corner
  /// at the back plane; right, up, forward are orthonormal.
  std::array<double, 3> origin{}, right{}, up{}, forward{};
  Result result;  ///< the answer to the same query
};

/// Answers batches of queries against one scene on one device.
class RADAR_API Sweeper {
 public:
  /// Creates the pipelines of mode contact if the device answers it; those of mode sampled are created at first use.
  /// `device` and `scene` must outlive the sweeper. Throws if the device has no queue.
  Sweeper(const Device& device, const Scene& scene, const SweeperOptions& options = {});
  ~Sweeper();
  Sweeper(Sweeper&&) noexcept;
  Sweeper& operator=(Sweeper&&) noexcept;

  /// Applies changes of the scene since the last call to the device's copy or to the tree over objects. run() does this
  /// too; a separate call only moves the cost.
  void sync();

  /// Answers any number of queries, each in its mode, in the order given. Queries that go to the device take one
  /// upload, one command buffer and one readback per mode; batches of more than 16,384, or too large for the device's
  /// layers or memory, take several. The answer to a query does not depend on its batch. Before anything is submitted,
  /// throws, naming the query, if one breaks its contract or has a mode that the device does not support. Blocks until
  /// done.
  std::vector<Result> run(std::span<const Query> queries);

  /// The pictures from which mode sampled answers `query`, at the query's resolution. Throws Error if they do not fit
  /// the device, or it does not support the mode.
  Scopes scopes(const Query& query);

  const SweepStats& stats() const;
  /// Lists of the last run(): of queries with `hits` above 1 or `skipOverlapping`.
  const Lists& lists() const;
  /// Why the i-th answer of the last run() is invalid; empty if it is valid.
  const std::string& reason(size_t i) const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
