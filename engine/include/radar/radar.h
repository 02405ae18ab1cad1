// Cyber Radar: how far can a shape move along a direction before its surface first touches anything?
//
// Meshes and objects are in scene.h, balls and capsules in shapes.h, cutters in cutters.h, queries in query.h, queries
// from displacements and poses in displacement.h, answers in answers.h, Vulkan devices in device.h, a scene's copy on
// one in scene_copy.h, a host's buffers in host.h, Eigen's matrices in eigen.h. Who answers:
//
//   one device, or just the answers   Sweeper     (here)           run() blocks; the CPU takes what no device does
//   no device                         CpuSweeper  (cpu_sweeper.h)  the same bits
//   several devices                   Pool        (pool.h)         submit() returns a future
//   your frame, your command buffers  Recorder    (recorder.h)     answers stay on the device; read() brings them
//
// docs/performance.md says what was measured, and on which devices.
//
// Threads: each object of this interface may be used by one thread at a time. Different objects are independent, except
// that a Sweeper reads its Scene during run() and scopes().
//
// Errors: a failed set-up, or an argument that breaks its contract, throws radar::Error (error.h), which tells the two
// apart. A query that cannot be answered gets Status::invalid; other queries are unaffected.
//
// Method: T. Iida, H. Yamachi, Y. Kambayashi, Y. Tsujimura, "Comparison and Multi-GPU based Implementation of a
// Collision Detection Method with Z-buffer in Cyber Space". R, M, L and d are that paper's; docs/method.md has the
// mathematics.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "radar/answers.h"
#include "radar/device.h"
#include "radar/displacement.h"
#include "radar/query.h"
#include "radar/scene.h"
#include "radar/scene_copy.h"

namespace radar {

/// Semantic version of this interface: before 1.0 a new minor version may break compatibility, a patch never does.
inline constexpr uint32_t kVersionMajor = 0;
inline constexpr uint32_t kVersionMinor = 2;
inline constexpr uint32_t kVersionPatch = 0;

struct SweeperOptions {
  /// Mode sampled; false: draws every object for every sensor, the naive baseline. The answers are the same.
  bool select = true;
  bool timestamps = false;  ///< measures each stage, at a small cost
  /// Upper bound on device memory for the pictures of one submission, bytes; larger batches are split. Memory kept
  /// between submissions is at most twice this.
  uint64_t pictureBytes = 256ull << 20;
  /// Batches with fewer queries of mode contact are answered on the CPU, with the same answers. 0: none. kNone: either
  /// side answers those with which it was faster lately; a device that is a CPU (lavapipe) is slower, and answers none.
  uint32_t cpuBatch = kNone;
  /// Threads of the CPU's search; 0: one per core. Large changes of a scene are prepared on all cores.
  uint32_t cpuThreads = 0;
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

/// Answers batches of queries against one scene on one device. Once that is lost, the CPU answers mode contact, with
/// the same bits (SweepStats::lost).
class RADAR_API Sweeper {
 public:
  /// Creates the pipelines of mode contact if the device answers it; those of mode sampled are created at first use.
  /// `device` and `scene` must outlive the sweeper. Throws if the device has no queue, and with reasons if it would
  /// search there and the device answers known queries wrongly.
  Sweeper(const Device& device, const Scene& scene, const SweeperOptions& options = {});
  /// With a copy of the scene that it shares with others.
  explicit Sweeper(SceneCopy& copy, const SweeperOptions& options = {});
  ~Sweeper();
  Sweeper(Sweeper&&) noexcept;
  Sweeper& operator=(Sweeper&&) noexcept;

  /// Applies changes of the scene since the last call to the device's copy or to the tree over objects. run() does this
  /// too; a separate call only moves the cost.
  void sync();

  /// Answers any number of queries. Those that go to the device take one upload, one command buffer and one readback;
  /// batches of more than 16,384, or too large for the device's layers or memory, take several; in mode contact the CPU
  /// answers those for which memory does not suffice. The answer to a query does not depend on its batch. Before
  /// anything is submitted, throws if the device does not support the mode, or, naming the query, if one breaks its
  /// contract. Blocks until done, or soon after another thread requests `stop`: on the CPU at once, on the device once
  /// the submission in hand ends. Queries that have no answer then are Status::invalid ("cancelled").
  Answers run(std::span<const Query> queries, Mode mode = Mode::contact, const std::stop_token& stop = {});
  /// The same, in the memory that `answers` has: batches that repeat allocate nothing. If it throws, nothing is known
  /// of what `answers` holds.
  void run(std::span<const Query> queries, Answers& answers, Mode mode = Mode::contact,
           const std::stop_token& stop = {});

  /// The pictures from which mode sampled answers `query`, at the query's resolution. Throws Error if they do not fit
  /// the device, or it does not support the mode.
  Scopes scopes(const Query& query);

  /// Bytes of its buffers and images on the device, and of its copy of the scene, unless others share that.
  uint64_t memoryUse() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
