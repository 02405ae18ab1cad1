#include "python/casting_scene.h"

#include <unistd.h>

#include <mutex>
#include <utility>

namespace radar::python {

namespace {

std::mutex mutex;
std::vector<std::string> messages;

void onValidation(const std::string& message) {
  const std::lock_guard lock(mutex);
  messages.push_back(message);
}

}  // namespace

std::vector<std::string> takeValidationMessages() {
  const std::lock_guard lock(mutex);
  return std::exchange(messages, {});
}

struct CastingScene::Answerers {
  pid_t process = getpid();
  std::vector<Device> devices;
  std::optional<Sweeper> sweeper;
  std::optional<Pool> pool;
  std::optional<CpuSweeper> cpu;
};

CastingScene::CastingScene(DeviceChoice choice) : choice_(std::move(choice)) {}

CastingScene::~CastingScene() {
  leaveForked();
}

// The threads and devices of a process that forked are not here: nothing of them can be used, nor ended.
void CastingScene::leaveForked() {
  if (!answerers_ || answerers_->process == getpid()) return;
  [[maybe_unused]] Answerers* left = answerers_.release();
}

CastingScene::Answerers& CastingScene::answerers() {
  leaveForked();
  if (!answerers_) answerers_ = std::make_unique<Answerers>();
  return *answerers_;
}

bool CastingScene::moves() const {
  for (ObjectId id = 0; id < scene_.objectLimit(); ++id) {
    if (scene_.hasObject(id) && scene_.object(id).motion != std::array<double, 3>{}) return true;
  }
  return false;
}

void CastingScene::edit(const std::function<void(Scene&)>& change) {
  Answerers& by = answerers();
  if (by.pool) {
    by.pool->edit([&] { change(scene_); });
  } else {
    change(scene_);
  }
}

Answers CastingScene::answer(const std::vector<Query>& queries, Mode mode, bool onCpu) {
  Answerers& by = answerers();
  if (onCpu) {
    if (!by.cpu) by.cpu.emplace(scene_, choice_.threads);
    return by.cpu->run(queries);
  }
  const SweeperOptions options{.cpuBatch = choice_.cpuBatch, .cpuThreads = choice_.threads};
  if (choice_.pool) {
    if (by.devices.empty()) by.devices = openDevices(*choice_.pool, onValidation);
    if (!by.pool) by.pool.emplace(by.devices, scene_, options);
    return by.pool->submit(queries, mode).get();
  }
  if (by.devices.empty()) {
    by.devices.push_back(Device::open({.index = choice_.device, .onValidation = onValidation}));
  }
  if (!by.sweeper) by.sweeper.emplace(by.devices[0], scene_, options);
  return by.sweeper->run(queries, mode);
}

std::span<const Device> CastingScene::devices() const {
  return answerers_ ? answerers_->devices : std::span<const Device>();
}

}  // namespace radar::python
