// Cyber Radar: how far can a shape move along a direction before its surface first touches anything?
//
// The public interface, with cpu_sweeper.h for the CPU alone, pool.h for several devices and recorder.h for a host's
// own command buffers. Units: any one unit of length, used throughout; angles never appear. Coordinates are left- or
// right-handed; meshes are two-sided triangle soups, winding is ignored, nothing has to be closed or connected.
//
// Ranges: mode contact takes all finite numbers; what floats cannot hold is answered on the CPU (recorder.h, which has
// none beside it, says what that is). Mode sampled answers Status::invalid, with a reason, where coordinates are beyond
// 2^80, the sensor's size is below 2^-80, an object in reach is more than 2^40 times as large as the sensor, or the
// components of a direction differ by more than about 2^1000 times.
//
// Threads: an object of this header may be used by one thread at a time; different objects are independent, except that
// a Sweeper reads its Scene during run() and scopes().
//
// Errors: a set-up that fails, and an argument that breaks its contract, throw radar::Error; a query that cannot be
// answered gets Status::invalid and leaves its neighbours alone.
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

// What a shared library shows.
#if defined(_WIN32)
#define RADAR_API
#else
#define RADAR_API __attribute__((visibility("default")))
#endif

namespace radar {

/// Semantic version of this interface: before 1.0 a new minor version may break what was there, a patch never does.
inline constexpr uint32_t kVersionMajor = 0;
inline constexpr uint32_t kVersionMinor = 1;
inline constexpr uint32_t kVersionPatch = 0;

/// No object, no triangle.
inline constexpr uint32_t kNone = 0xffffffffu;

/// What went wrong, in words that name the call, the value and what was expected. `reasons` holds one line per device
/// where no device was usable, else it is empty; `result` is the VkResult of a failed Vulkan call, else VK_SUCCESS.
class RADAR_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what, VkResult code = VK_SUCCESS, std::vector<std::string> perDevice = {})
      : std::runtime_error(what), result(code), reasons(std::move(perDevice)) {}
  VkResult result;
  std::vector<std::string> reasons;
};

/// A placement: world = M p + t, row-major rows (m0 m1 m2 t), any invertible affine matrix, mirrors too. Vertices are
/// placed as ((m0*x + m1*y) + m2*z) + t in double precision, without fused multiply-add: that result *is* the geometry.
struct Pose {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// Where `pose` puts the mesh vertex `p`, by the formula above.
RADAR_API std::array<double, 3> place(const Pose& pose, const float* p);

/// Ids are small integers. An id names one mesh or object until that is removed, whatever else is added or removed; the
/// least free id is given next, so objects added to a fresh scene are 0, 1, 2, ...
using MeshId = uint32_t;
using ObjectId = uint32_t;

/// An axis-aligned box, ends included.
struct Bounds {
  std::array<double, 3> lo{}, hi{};
};

/// A triangle mesh as it was given.
struct MeshView {
  std::span<const float> positions;   ///< 3 floats per vertex
  std::span<const uint32_t> indices;  ///< 3 vertex numbers per triangle; the triangle's id is its place here
  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
};

/// An object of the scene: a mesh, placed.
struct Object {
  MeshId mesh = kNone;
  Pose worldFromMesh;
  uint32_t mask = ~0u;  ///< takes part in a query when it shares a bit with the query's mask
};

/// Meshes, and objects that place them. Plain data on the CPU: a scene knows no device, and any number of
/// sweepers may read it. Copies everything it is given.
class RADAR_API Scene {
 public:
  Scene();
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Adds a mesh of positions.size()/3 vertices and indices.size()/3 triangles. Throws if it has no triangle, a size is
  /// not a multiple of 3, a number is not finite, an index is out of range, or a bound is above its other or beyond
  /// 2^120, or, where there are bounds, a position is.
  ///
  /// `bounds`, mesh units: the host will deform the mesh on its device (radar/host_geometry.h), within them. The closer
  /// `positions` are to what it will be (its rest pose), the faster the search; elsewhere they are the mesh.
  MeshId addMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                 const std::optional<Bounds>& bounds = std::nullopt);
  /// Throws while an object uses the mesh.
  void removeMesh(MeshId mesh);

  /// Throws if the mesh does not exist, or the pose is singular or not finite.
  ObjectId addObject(const Object& object);
  void setPose(ObjectId object, const Pose& worldFromMesh);
  /// The host will move the object on its device (radar/host_geometry.h), within `world`, whose size is what it costs;
  /// elsewhere it is at its pose. Replaces earlier bounds; they end with the object. Throws if the object does not
  /// exist, or a bound is above its other or beyond 2^120.
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

  /// Rises with every change, of mesh or object.
  uint64_t version() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// How far the tiers go: the cheapest that settles a query answers it, none beyond this one is asked.
enum class Mode : uint32_t {
  sampled,  ///< select, then the paper's method: `hi` is certain, `lo` is 0, a contact may be missed
  contact   ///< the exact search, on the device or on the CPU: never undecided
};

/// One sweep: the sensor `mesh`, placed by `worldFromMesh`, moves along `direction` for `distance`.
struct Query {
  MeshId mesh = kNone;                ///< of the scene
  Pose worldFromMesh;                 ///< invertible
  std::array<double, 3> direction{};  ///< finite, not zero; its length does not matter
  double distance = 0;                ///< D >= 0, finite, world units
  Mode mode = Mode::contact;
  bool decide = false;  ///< only "within D or not" is asked: see Result. Costs less where something is in the way
  std::vector<ObjectId> exclude;  ///< objects that take no part, such as the sensor's own; at most a handful
  uint32_t mask = ~0u;            ///< an object takes part when it shares a bit
  /// Of mode sampled: pixels of the window's longer side, up to kMaxResolution. 0: chosen from the meshes.
  uint32_t resolution = 0;
};

inline constexpr uint32_t kMaxResolution = 2048;

enum class Status : uint32_t {
  hit,        ///< first contact within D, for certain: t*, the exact distance, lies in [lo, hi], hi <= D
  clear,      ///< certainly no contact within D
  overlap,    ///< the surfaces meet at the start, for certain: t = lo = hi = 0
  undecided,  ///< there is no contact before lo; whether there is one after is not known (hi is NaN)
  invalid     ///< not answered; Sweeper::reason says why
};

/// The stage that settled an answer.
enum class Tier : uint32_t { select, sampled, contact, reference };

/// The paper's first step: is there anything in the target volume?
enum class Detected : uint32_t {
  no,        ///< certainly nothing (after sampling: nothing at any pixel centre)
  yes,       ///< some surface lies there
  notLooked  ///< the question did not come up
};

/// Why a Recorder (radar/recorder.h) has left a query without an answer: bits of Result::flags.
inline constexpr uint32_t kFlagOpen = 1;  ///< pairs of triangles too close for the device: Recorder::read() decides
inline constexpr uint32_t kFlagCandidates = 2;  ///< Capacity::candidates, or a list of the search, was too small
inline constexpr uint32_t kFlagRounds = 4;      ///< Capacity::rounds was
inline constexpr uint32_t kFlagRange = 8;    ///< floats cannot hold the scene, or the sensor or D beside it
inline constexpr uint32_t kFlagBounds = 16;  ///< a vertex or an object of HostGeometry has left its declared bounds

/// An answer. Numbers that do not exist are NaN, ids kNone. Layout version 2: 120 bytes, natural alignment.
///
/// To a query with `decide` the status is hit (overlap included), clear or undecided; t, fraction, ids, point and
/// normal do not exist; where it is hit, lo is 0 and hi at most D (in mode contact: D).
struct RADAR_API Result {
  Status status = Status::invalid;
  Tier tier = Tier::select;
  Detected detected = Detected::notLooked;
  uint32_t resolution = 0;       ///< pixels of the window's longer side; 0 where no picture was drawn
  double t;                      ///< best estimate of t*, world units; tier sampled: hi
  double lo, hi;                 ///< the certified bracket, world units
  double fraction;               ///< t / D (0 where D is 0)
  ObjectId object = kNone;       ///< what is touched
  uint32_t triB = kNone;         ///< its triangle
  uint32_t triA = kNone;         ///< the sensor's triangle
  uint32_t flags = 0;            ///< kFlag*: why a Recorder has left the query open; else 0
  std::array<double, 3> point;   ///< world position of the contact at the moment of contact
  std::array<double, 3> normal;  ///< unit, from the touched surface towards the sensor: normal . direction <= 0
  double paperMinL;              ///< the paper's literal min(L), for comparison: may be negative, too early or too late
  Result();
};
inline constexpr uint32_t kResultVersion = 2;
static_assert(sizeof(Result) == 120);

/// Checks what Scene and Query promise of their numbers. Return an empty string, or what is wrong and what was
/// expected.
RADAR_API std::string whatIsWrong(const Pose& worldFromMesh);
RADAR_API std::string whatIsWrong(const Query& query, const Scene& scene);

// ---------------------------------------------------------------------------------------------------------------------

/// A limit of a physical device that shaders rely on, by its name in VkPhysicalDeviceLimits.
struct DeviceLimit {
  std::string name;
  uint64_t needed = 0, has = 0;  ///< at least; the device's own
  Mode mode = Mode::contact;     ///< which relies on it: what contact needs, sampled needs, too
};

/// A physical device as seen from here.
struct DeviceReport {
  std::string name, driver, type;
  std::vector<std::string> reasons;         ///< why it cannot be used; empty: it can
  std::vector<std::string> sampledReasons;  ///< why it cannot answer in mode sampled; empty: it can
  std::string version;                      ///< of Vulkan, that the device has: "1.3.224"
  uint64_t memory = 0;                      ///< bytes of the largest heap that is the device's own
  uint32_t subgroup = 0;                    ///< invocations in a workgroup of the search; 0 before Vulkan 1.3
  bool doubles = false;                     ///< it has the feature shaderFloat64
  std::vector<DeviceLimit> limits;          ///< empty before Vulkan 1.3
  bool usable() const { return reasons.empty(); }
};

/// Every physical device that the Vulkan loader lists, in its order. Throws where there is no loader or no driver at
/// all.
RADAR_API std::vector<DeviceReport> listDevices();

/// Vulkan handles of a host that owns them, all of which outlive the Device made from them. `device` has enabled what
/// requirements() lists. `queue` belongs to family `queueFamily`, which does compute; for mode sampled, graphics, too.
///
/// `queue` may be null where every submission is to be the host's own: the engine then never submits. A Recorder works
/// in full; a Sweeper, a Pool and addMesh() of a HostMesh throw Error. Nor can the device's doubles be compared with
/// the CPU's: `doubles` is taken at its word, and answers may be wrong where they differ. Who is not sure says false,
/// or what Device::doubles() says where the same device and driver were adopted with a queue.
struct HostDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  VkQueue queue = VK_NULL_HANDLE;
  bool doubles = true;      ///< the feature shaderFloat64 is enabled on `device`
  bool sampled = false;     ///< what requirements(Mode::sampled, ...) lists is enabled on `device`
  bool debugNames = false;  ///< VK_EXT_debug_utils is enabled on the instance
  /// The host's own way to Vulkan: all functions are looked up through it. Null: the loader of this machine.
  PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
  const VkAllocationCallbacks* allocator = nullptr;  ///< for every object made; not for what the loader makes
  VkPipelineCache pipelineCache = VK_NULL_HANDLE;    ///< for every pipeline made; any, or none
  /// Called around each vkQueueSubmit2, on the submitting thread, where other threads use the queue too; both or none.
  std::function<void()> lockQueue, unlockQueue;
};

/// What a VkDevice must have enabled: the version, and VK_TRUE for each feature needed. A host chains it into its
/// VkDeviceCreateInfo (without pEnabledFeatures), or copies the features that are on into structs of its own.
struct Requirements {
  uint32_t apiVersion = VK_API_VERSION_1_3;  ///< of instance and device
  VkPhysicalDeviceFeatures2 core{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan12Features vulkan12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features vulkan13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  /// For VkDeviceCreateInfo::pNext: all three, chained, then `next`; valid while this object stays where it is.
  const void* chain(void* next = nullptr);
};
/// `mode`: sampled needs what contact needs, and graphics. `doubles`: with shaderFloat64, which is not needed but makes
/// mode contact leave less to the CPU.
RADAR_API Requirements requirements(Mode mode, bool doubles);

/// Why a host's physical device cannot be used for `mode`, a line for each thing it lacks; empty if it can. Looks at
/// `instance`, `physicalDevice` and `getInstanceProcAddr` only.
RADAR_API std::vector<std::string> reasonsAgainst(const HostDevice& host, Mode mode);

struct DeviceOptions {
  uint32_t index = kNone;  ///< into listDevices(); kNone: the best usable one (discrete, integrated, virtual, CPU)
  /// Receives each warning or error of the validation layers that are active; called on any thread.
  std::function<void(const std::string&)> onValidation;
  bool doubles = true;  ///< false: do without them, as where shaderFloat64 is missing
};

/// A logical device with one queue: opened here (and then owned), or a host's (and then only borrowed).
class RADAR_API Device {
 public:
  /// Throws with the list of devices and reasons if none is usable, or the one asked for is not.
  static Device open(const DeviceOptions& options = {});
  /// Throws with reasons if the physical device lacks what mode contact needs, or its arithmetic breaks the bounds.
  /// While this and a Sweeper of this device run, the host keeps other threads from using `queue`, unless it gives the
  /// functions that lock it. Submits twice at most, to check the arithmetic, where `host` has a queue. Any number of
  /// Devices may be made of one VkDevice.
  static Device adopt(const HostDevice& host);
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const std::string& name() const;
  const std::string& driver() const;
  /// Whether queries of this mode can be answered: contact always can; sampled needs graphics.
  bool supports(Mode mode) const;
  /// Whether pairs are solved in double precision on the device: it has doubles, and the checks at opening
  /// (radar/arithmetic.h) found what they rest on to be as on the CPU, bit for bit. Else they are solved in float, with
  /// error bounds, and what that leaves open is decided on the CPU: the answers are the same. Adopted without a queue:
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
  /// Of mode sampled; false: draw every object for every sensor, the naive baseline. The answers are the same.
  bool select = true;
  bool timestamps = false;  ///< measure each stage; costs a little
  /// Upper bound on device memory for the pictures of one submission, bytes; a batch that needs more is split. What is
  /// kept from one submission to the next takes at most twice as much.
  uint64_t pictureBytes = 256ull << 20;
  /// Batches of fewer queries of mode contact are answered on the CPU, with the same answers. 0: none is. kNone: 16,
  /// but all of them where the device itself runs on the CPU (lavapipe): its search is slower there.
  uint32_t cpuBatch = kNone;
  uint32_t cpuThreads = 0;  ///< of the CPU's search; 0: one for each core
};

/// Time of one stage, summed over the submissions of the last run(), milliseconds.
struct StageTime {
  std::string name;
  double ms = 0;
};

/// What the last run() did.
struct SweepStats {
  uint32_t submissions = 0;
  uint64_t drawnObjects = 0;      ///< objects drawn, summed over sensors
  uint64_t drawnTriangles = 0;    ///< triangles drawn for R and M, summed over sensors
  uint64_t pairs = 0;             ///< pairs: of triangles that were nominated (sampled), of leaves (contact)
  uint64_t cpuPairs = 0;          ///< pairs of triangles left to the CPU
  uint64_t cpuQueries = 0;        ///< queries answered by the CPU alone (contact)
  uint64_t nodePairs = 0;         ///< pairs of nodes of both meshes' trees looked at on the device (contact)
  uint64_t solves = 0;            ///< pairs of triangles solved on the device (contact)
  std::vector<StageTime> stages;  ///< empty unless SweeperOptions::timestamps (then CPU stages too)
};

/// The scopes of one query as pictures: row-major from the window's lower left corner, `width` x `height` floats, world
/// units along the motion; NaN where R is empty, the sensor does not cover the pixel, or there is no L.
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
  /// Creates the pipelines of mode contact, where it is answered on the device; those of mode sampled are made when
  /// first used. `device` and `scene` must outlive the sweeper. Throws if the device has no queue.
  Sweeper(const Device& device, const Scene& scene, const SweeperOptions& options = {});
  ~Sweeper();
  Sweeper(Sweeper&&) noexcept;
  Sweeper& operator=(Sweeper&&) noexcept;

  /// Brings what changed in the scene since the last call to where it is needed, the device or the tree over objects.
  /// run() does it too; calling it apart only moves the cost.
  void sync();

  /// Answers each query as its mode says, in the order given: any number of queries. Those that go to the device are
  /// one upload, one command buffer, one readback for each mode, or several where they are too many for the device's
  /// layers or memory, or more than 16,384. The answer to a query does not depend on its batch. Throws if a query
  /// breaks its contract or has a mode that the device does not support, naming it, before anything is submitted.
  /// Blocks until the answers are here.
  std::vector<Result> run(std::span<const Query> queries);

  /// The pictures behind the answer to `query` in mode sampled, at the query's resolution. Throws Error where they do
  /// not fit the device, or it does not support the mode.
  Scopes scopes(const Query& query);

  const SweepStats& stats() const;
  /// Why the i-th answer of the last run() is invalid; empty if it is not.
  const std::string& reason(size_t i) const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
