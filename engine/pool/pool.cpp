#include "radar/pool.h"

#include <algorithm>
#include <system_error>

#include "math/float_environment.h"
#include "pool/worker.h"

namespace radar {

std::vector<Device> openDevices(std::span<const uint32_t> indices, const DeviceOptions& options) {
  std::vector<uint32_t> wanted(indices.begin(), indices.end());
  for (const uint32_t index : wanted) {
    if (std::count(wanted.begin(), wanted.end(), index) > 1) {
      throw Error("device " + std::to_string(index) + " is named twice");
    }
  }
  if (wanted.empty()) {
    const std::vector<DeviceReport> reports = listDevices();
    std::vector<std::string> lines;
    for (uint32_t i = 0; i < reports.size(); ++i) {
      if (reports[i].usable()) wanted.push_back(i);
      for (const std::string& reason : reports[i].reasons) {
        lines.push_back("device " + std::to_string(i) + ", " + reports[i].name + ": " + reason);
      }
    }
    if (wanted.empty()) throw Error(Error::Kind::device, "no usable Vulkan device", VK_SUCCESS, lines);
  }
  std::vector<Device> devices;
  devices.reserve(wanted.size());
  for (const uint32_t index : wanted) {
    DeviceOptions own = options;
    own.index = index;
    devices.push_back(Device::open(own));
  }
  return devices;
}

struct Pool::Impl {
  Impl(std::span<const Device> devices, const Scene& ownScene, const SweeperOptions& options)
      : scene(ownScene), workQueue(reportsOf(devices)) {
    try {
      workers.reserve(devices.size());  // a thread that has begun must not end before the queue is closed
      for (uint32_t i = 0; i < devices.size(); ++i) {
        if (!devices[i].supports(Mode::sampled)) withoutSampled = &devices[i].impl();
        workers.push_back(std::make_unique<Worker>(i, devices[i], scene, options, workQueue));
      }
    } catch (const std::system_error& error) {
      workQueue.close();
      throw Error(Error::Kind::device,
                  std::string("Pool: expected to start a thread for each device, got: ") + error.what());
    } catch (...) {
      workQueue.close();
      throw;
    }
  }
  ~Impl() { workQueue.close(); }

  static std::vector<PoolDevice> reportsOf(std::span<const Device> devices) {
    if (devices.empty()) throw Error("Pool: expected at least one device, got none");
    std::vector<PoolDevice> reports;
    for (size_t i = 0; i < devices.size(); ++i) {
      devices[i].impl().requireQueue("a Pool");
      for (size_t k = 0; k < i; ++k) {
        if (devices[i].handles().queue != devices[k].handles().queue) continue;
        throw Error("Pool: devices " + std::to_string(k) + " and " + std::to_string(i) + " share a queue");
      }
      reports.push_back({.name = devices[i].name(), .driver = devices[i].driver()});
    }
    return reports;
  }

  const Scene& scene;
  const Device::Impl* withoutSampled = nullptr;  // a device that does not support mode sampled
  WorkQueue workQueue;
  std::vector<std::unique_ptr<Worker>> workers;  // declared last, so that their threads end before the queue does
};

Pool::Pool(std::span<const Device> devices, const Scene& scene, const SweeperOptions& options)
    : impl_(std::make_unique<Impl>(devices, scene, options)) {}
Pool::~Pool() = default;

std::future<PoolAnswers> Pool::submit(std::vector<Query> queries, Mode mode, std::stop_token stop) {
  const FloatEnvironment floats;
  // Any device may get any query.
  if (mode == Mode::sampled && impl_->withoutSampled != nullptr) impl_->withoutSampled->requireSampled("submit()");
  return impl_->workQueue.post(std::move(queries), mode, std::move(stop), impl_->scene);
}

void Pool::edit(const std::function<void()>& change) {
  impl_->workQueue.edit(change);
}

std::vector<PoolDevice> Pool::devices() const {
  return impl_->workQueue.devices();
}

}  // namespace radar
