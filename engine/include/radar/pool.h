// Cyber Radar on several devices: a pool shares each batch among its devices.
//
// Threads: any thread may call any function of a Pool at any time, except the destructor. A pool runs one thread per
// device, named "radar-device-0", "-1", ..., and no others; idle threads sleep.
#pragma once

#include <future>
#include <stop_token>

#include "radar/radar.h"

namespace radar {

/// Opens the devices with these indices in listDevices(), in this order, whatever `options.index` is; with none given,
/// every usable device. Throws Error naming the device, also for an index given twice, or with all reasons if none is
/// usable.
RADAR_API std::vector<Device> openDevices(std::span<const uint32_t> indices = {}, const DeviceOptions& options = {});

/// Timing of one chunk of a batch on its device. Times are milliseconds since the pool was made, on the host's clock.
struct ChunkTrace {
  uint32_t device = 0;  ///< index in the pool
  uint32_t queries = 0;
  double begun = 0;               ///< encoding began
  double submitted = 0;           ///< the last submission was made
  double awaited = 0;             ///< waiting began
  double done = 0;                ///< the device was seen to be done
  double decoded = 0;             ///< the answers were decoded
  std::vector<StageTime> stages;  ///< empty unless SweeperOptions::timestamps
};

/// The answers to a batch. Reasons beyond a Sweeper's: "cancelled", "the pool was closed", or that no device is left
/// and why. Statistics are summed over devices.
struct PoolAnswers : Answers {
  std::vector<ChunkTrace> chunks;    ///< in order of completion
  std::vector<std::string> retired;  ///< one line per device retired, or the last one lost, while working on this batch
  double submitted = 0, answered = 0;  ///< as in ChunkTrace
};

/// A device of a pool, and its work so far.
struct PoolDevice {
  std::string name, driver;
  uint64_t queries = 0, chunks = 0;
  std::string retired;  ///< why it was retired or, being the last, is lost; empty if it works
};

/// Answers batches on all its devices. A batch is cut into chunks. A free device takes the next chunk; faster devices
/// take larger ones. Each device holds two chunks, so that one is encoded while the device works on the other. Batches
/// begin in the order of submission. If all devices have the same driver, an answer has the bits that a Sweeper on one
/// of them gives, whatever the number of devices.
///
/// A device that is lost, fails to allocate, or cannot hold the scene is retired, and the other devices redo its
/// chunks. If a chunk runs out of memory on a second device too, or on the last one, the device is kept and the chunk
/// is answered as Sweeper::run() says; so are all chunks once the last device is lost.
class RADAR_API Pool {
 public:
  /// Starts a thread per device, which creates its pipelines; does not wait. `devices` and `scene` must outlive the
  /// pool, and nothing else may use the devices' queues meanwhile. Throws if there is no device, one has no queue, two
  /// share one, or a thread cannot be started. `options` apply to each device and to each of its two chunks.
  Pool(std::span<const Device> devices, const Scene& scene, const SweeperOptions& options = {});
  /// Answers queries not yet begun with Status::invalid ("the pool was closed"), finishes those with a device, and ends
  /// the threads. Every future gets its answers. No other function may be running.
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// Submits any number of queries; the future gets their answers, or std::bad_alloc if the host's memory does not
  /// suffice: the pool keeps its devices, and later batches are answered. Throws if a device does not support the mode,
  /// or, naming the query, if one breaks its contract. Once `stop` is requested, queries that no device has taken
  /// become Status::invalid ("cancelled") when the batch's turn comes, and a device's as Sweeper::run says. Blocks only
  /// while the scene is being edited.
  std::future<PoolAnswers> submit(std::vector<Query> queries, Mode mode = Mode::contact, std::stop_token stop = {});

  /// While the pool lives, the scene may change only in `change`. Waits until all earlier batches are answered, then
  /// calls `change` on this thread; later batches see the change on every device. An exception from `change` is passed
  /// on, and the pool continues with the scene as it then is. `change` must not call the pool. If it does nothing, this
  /// only waits.
  void edit(const std::function<void()>& change);

  std::vector<PoolDevice> devices() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
