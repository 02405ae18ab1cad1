#include "pool/worker.h"

#ifdef __linux__
#include <pthread.h>
#endif

#include <algorithm>
#include <new>

#include "gpu/api.h"
#include "math/float_environment.h"

namespace radar {

namespace {

constexpr uint32_t kAnyBatch = kNone - 1;  // no batch is as large; kNone is the default

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
  const FloatEnvironment floats;  // the host's thread that made the pool may have had another
  nameThread(number_);
  for (bool goesOn = true; goesOn;) {
    try {
      goesOn = serve();
    } catch (const std::bad_alloc&) {
      abandon(std::current_exception());
    } catch (const std::exception& error) {
      goesOn = false;
      endLanes();
      try {
        queue_.retire(number_, error.what(), chunksInFlight());
      } catch (const std::bad_alloc&) {
        abandon(std::current_exception());
        queue_.retire(number_, "out of memory", {});
      }
    }
  }
}

// Waits for the device. Before a lane's chunk goes to another worker, the work of the other lane must have ended, too.
void Worker::endLanes() {
  for (Lane& lane : lanes_) {
    if (lane.flight) lane.sweep->abandon(*lane.flight);
  }
}

// Gives up the batches in hand, and whatever an exception may have left half done.
void Worker::abandon(const std::exception_ptr& exception) {
  endLanes();
  for (Lane& lane : lanes_) {
    if (lane.chunk.job) queue_.abandon(lane.chunk, exception);
    lane = {};
  }
  copy_.reset();
  oldest_ = inFlight_ = 0;
  seenVersion_ = 0;
  isSynced_ = true;
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

void Worker::makeSweep(Lane& lane) {
  try {
    lane.sweep = std::make_unique<Sweeper::Impl>(device_.impl(), scene_, options_, copy_);
    for (const Lane& other : lanes_) {  // what one learns, both know
      if (other.sweep && other.sweep->router) lane.sweep->router = other.sweep->router;
    }
  } catch (const Error& error) {
    if (!gpu::isOutOfMemory(error) || queue_.leave(number_)) throw;
    SweeperOptions onCpu = options_;
    onCpu.cpuBatch = kAnyBatch;
    lane.sweep = std::make_unique<Sweeper::Impl>(device_.impl(), scene_, onCpu, copy_, SearchTuning{}, false);
    lane.isMakeshift = true;
  }
}

void Worker::begin(Lane& lane, Chunk chunk) {
  lane.chunk = std::move(chunk);
  ++inFlight_;
  lane.trace = {.device = number_, .queries = static_cast<uint32_t>(lane.chunk.count), .begun = queue_.now()};
  if (!copy_) copy_ = std::make_shared<GpuScene>(device_.impl());
  if (!lane.sweep) makeSweep(lane);
  // The scene changes only while nothing is in flight, so the copy that both lanes use may be written now.
  if (const uint64_t version = scene_.version(); version != seenVersion_) {
    const std::optional<Error> error = lane.sweep->sync();
    if (error && queue_.leave(number_)) throw Error(*error);
    isSynced_ = !error;
    if (isSynced_) seenVersion_ = version;
  }
  lane.flight.emplace(lane.chunk.queries(), options_.timestamps, lane.chunk.job->stop);
  for (Lane& each : lanes_) {
    if (inFlight_ > 1) each.flight->isAlone = false;
  }
  lane.sweep->begin(*lane.flight, lane.chunk.job->mode);
  lane.trace.submitted = queue_.now();
}

void Worker::finish(Lane& lane) {
  Flight& flight = *lane.flight;
  lane.trace.awaited = queue_.now();
  lane.sweep->finish(flight);
  lane.trace.done = std::max(lane.trace.submitted, queue_.at(flight.deviceDone));
  lane.trace.decoded = queue_.now();
  lane.trace.stages = flight.answers.stats.stages;
  // A lost device retires the worker, unless it is the last; so does a lack of memory, unless the chunk has run out of
  // memory on another device, too. Any other failure makes the chunk's queries invalid.
  if (flight.failure) {
    const bool isLost = gpu::isLost(*flight.failure), forMemory = gpu::isOutOfMemory(*flight.failure);
    const bool mayLeave = isLost || (forMemory && !lane.chunk.outOfMemory);
    if (mayLeave && queue_.leave(number_)) throw Error(*flight.failure);
    lane.chunk.outOfMemory = lane.chunk.outOfMemory || forMemory;
    if (isLost) queue_.giveUp(number_, flight.failure->what());
  }
  // The first use of a pipeline may take a hundred times as long and is no measure of the device's speed.
  bool& warm = lane.warm[static_cast<size_t>(lane.chunk.job->mode)];
  const bool usedDevice = flight.answers.stats.submissions != 0;
  const bool isMeasure = (warm || !usedDevice) && !flight.stop.stop_requested();
  const double deviceMs = isMeasure ? lane.trace.done - std::max(lane.trace.begun, lastDone_) : 0;
  warm = warm || usedDevice;
  lastDone_ = lane.trace.done;
  if (std::exchange(lane.isMakeshift, false)) lane.sweep.reset();
  oldest_ = (oldest_ + 1) % kLanes;
  --inFlight_;
  queue_.deliver(std::exchange(lane.chunk, {}), std::move(flight.answers), std::move(lane.trace), deviceMs);
}

}  // namespace radar
