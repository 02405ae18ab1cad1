// Cyber Radar on several devices: a pool hands a batch's queries to every device, and each answers what it can.
//
// Threads: every function of a Pool may be called from any thread at any time, except its destructor. A pool runs one
// thread a device, named "radar-device-0", "-1", ..., and no other; a thread without work sleeps.
#pragma once

#include <future>
#include <map>
#include <stop_token>

#include "radar/radar.h"

namespace radar {

/// Opens the devices of these numbers in listDevices(), in this order; every usable one if none is named. Throws Error
/// that names the device, also for a number given twice, or with all reasons if none is usable.
RADAR_API std::vector<Device> openDevices(std::span<const uint32_t> indices = {},
                                          const std::function<void(const std::string&)>& onValidation = nullptr);

/// The way of a chunk of a batch through a device. Times are milliseconds since the pool was made, on the host's clock.
struct ChunkTrace {
  uint32_t device = 0;  ///< its place in the pool
  uint32_t queries = 0;
  double begun = 0;               ///< a thread began to encode it
  double submitted = 0;           ///< the last submission was with the device
  double awaited = 0;             ///< the thread began to wait for it
  double done = 0;                ///< the thread saw that the device was done
  double decoded = 0;             ///< the answers were there
  std::vector<StageTime> stages;  ///< empty unless SweeperOptions::timestamps
};

/// What became of a batch.
struct PoolAnswers {
  std::vector<Result> results;  ///< in the order of the queries
  /// Why a result is Status::invalid, by its place; beside what a Sweeper says: "cancelled", "the pool was closed", or
  /// that no device is left and why.
  std::map<size_t, std::string> reasons;
  SweepStats stats;                    ///< summed over devices
  std::vector<ChunkTrace> chunks;      ///< in the order in which they ended
  std::vector<std::string> retired;    ///< one line per device that the pool gave up while it worked on this batch
  double submitted = 0, answered = 0;  ///< as in ChunkTrace
};

/// A device of a pool, and what it has done so far.
struct PoolDevice {
  std::string name, driver;
  uint64_t queries = 0, chunks = 0;
  std::string retired;  ///< why it was given up; empty: it works
};

/// Answers batches on all its devices. A batch is cut into chunks that a device takes when it is free, the larger the
/// faster it has been, two at a time, so that one is encoded while the device works on the other. Batches are begun in
/// the order of their submission. The answer to a query has the bits that a Sweeper of one of the devices gives,
/// whatever the number of devices, as long as all have one driver.
///
/// A device that is lost, or fails to allocate, or cannot hold the scene is retired: the other devices do its chunks
/// anew. Where a chunk fails for want of memory on a second device too, or on the last, the trouble is the queries':
/// those are invalid, and the device stays.
class RADAR_API Pool {
 public:
  /// A thread for each device, which makes its pipelines; nothing is awaited. `devices` and `scene` must outlive the
  /// pool, and nothing else uses the devices' queues meanwhile. Throws if there is no device, or one has no queue, or
  /// two have the same. `options` hold for each device and each of its two chunks.
  Pool(std::span<const Device> devices, const Scene& scene, const SweeperOptions& options = {});
  /// Answers what is not begun with Status::invalid ("the pool was closed"), finishes what is with a device, ends the
  /// threads. Every future gets its answers. No other function may be running.
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// Hands over any number of queries; the future gets their answers and no exception. Throws if a query breaks its
  /// contract, or has a mode that one of the devices does not support, naming it. Once `stop` is requested, queries that no device has taken are answered with Status::invalid
  /// ("cancelled") when the batch's turn comes. Blocks only while the scene is being edited.
  std::future<PoolAnswers> submit(std::vector<Query> queries, std::stop_token stop = {});

  /// The scene may change in `change` and nowhere else while the pool lives. Waits until every batch submitted before
  /// is answered, then calls `change` on this thread; every device sees the change in the batches submitted after. What
  /// `change` throws is passed on, and the pool goes on with the scene as it then is. `change` must not call the pool.
  void edit(const std::function<void()>& change);

  /// Waits until every batch submitted before is answered.
  void drain();

  std::vector<PoolDevice> devices() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
