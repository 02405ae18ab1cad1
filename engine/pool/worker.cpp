#include "pool/worker.h"

#ifdef __linux__
#include <pthread.h>
#endif

#include <algorithm>

#include "gpu/check.h"

namespace radar {

namespace {

void nameThread([[maybe_unused]] uint32_t number) {
#ifdef __linux__
  // Linux allows 15 characters.
  pthread_setname_np(pthread_self(), ("radar-device-" + std::to_string(number % 100)).c_str());
#endif
}

}  // namespace

Worker::Worker(uint32_t number, const Device& device, const Scene& scene, const SweeperOptions& options,
               WorkQueue& queue)
    : number_(number), device_(device), scene_(scene), options_(options), queue_(queue), thread_([this] { run(); }) {}

void Worker::run() {
  nameThread(number_);
  try {
    copy_ = std::make_shared<GpuScene>(device_.impl());
    while (serve()) {
    }
  } catch (const std::exception& error) {
    // The other lane's work on the device must end before its chunk goes to other workers.
    std::vector<Chunk> chunks = chunksInFlight();
    for (Lane& lane : lanes_) {
      try {
        if (lane.sweep) lane.sweep->finish();
      } catch (const std::exception&) {  // the first error is the one to report
      }
    }
    queue_.retire(number_, error.what(), std::move(chunks));
  }
}

std::vector<Chunk> Worker::chunksInFlight() const {
  std::vector<Chunk> chunks;
  for (size_t i = 0; i < inFlight_; ++i) chunks.push_back(lanes_[(oldest_ + i) % kLanes].chunk);
  return chunks;
}

// Takes a chunk, or finishes one. Returns whether there is more to do.
bool Worker::serve() {
  if (inFlight_ < (isSynced_ ? kLanes : 1)) {
    size_t queries = 0;
    for (const Chunk& chunk : chunksInFlight()) queries += chunk.count;
    if (std::optional<Chunk> chunk = queue_.take(number_, queries)) {
      begin(lanes_[(oldest_ + inFlight_) % kLanes], std::move(*chunk));
      return true;
    }
    if (inFlight_ == 0) return false;
  }
  finish(lanes_[oldest_]);
  return true;
}

void Worker::begin(Lane& lane, Chunk chunk) {
  lane.chunk = std::move(chunk);
  ++inFlight_;
  lane.trace = {.device = number_, .queries = static_cast<uint32_t>(lane.chunk.count), .begun = queue_.now()};
  lane.results.assign(lane.chunk.count, Result());
  if (!lane.sweep) lane.sweep = std::make_unique<Sweeper::Impl>(device_, scene_, options_, copy_);
  // The scene changes only while nothing is in flight, so the copy that both lanes use may be written now.
  if (const uint64_t version = scene_.version(); version != seenVersion_) {
    const std::optional<Error> error = lane.sweep->sync();
    if (error && queue_.leave(number_)) throw Error(*error);
    isSynced_ = !error;
    if (isSynced_) seenVersion_ = version;
  }
  lane.sweep->begin(lane.chunk.queries(), lane.results);
  lane.trace.submitted = queue_.now();
}

void Worker::finish(Lane& lane) {
  Sweeper::Impl& sweep = *lane.sweep;
  lane.trace.awaited = queue_.now();
  sweep.finish();
  lane.trace.done = std::max(lane.trace.submitted, queue_.at(sweep.deviceDone));
  lane.trace.decoded = queue_.now();
  lane.trace.stages = sweep.stats.stages;
  // A lost device retires the worker; so does a lack of memory, unless it is the last worker or the chunk has run out
  // of memory on another device, too. Any other failure makes the chunk's queries invalid.
  if (sweep.failure) {
    const bool forMemory = gpu::isOutOfMemory(*sweep.failure);
    const bool ofQueries = forMemory && (lane.chunk.outOfMemory || !queue_.leave(number_));
    lane.chunk.outOfMemory = lane.chunk.outOfMemory || forMemory;
    if (sweep.failure->result == VK_ERROR_DEVICE_LOST || (forMemory && !ofQueries)) throw Error(*sweep.failure);
  }
  // The first use of a pipeline may take a hundred times as long and is no measure of the device's speed.
  bool& warm = lane.warm[static_cast<size_t>(lane.chunk.queries()[0].mode)];
  const bool usedDevice = sweep.stats.submissions != 0;
  const double deviceMs = warm || !usedDevice ? lane.trace.done - std::max(lane.trace.begun, lastDone_) : 0;
  warm = warm || usedDevice;
  lastDone_ = lane.trace.done;
  oldest_ = (oldest_ + 1) % kLanes;
  --inFlight_;
  queue_.deliver(std::exchange(lane.chunk, {}), sweep, std::move(lane.trace), deviceMs);
}

}  // namespace radar
