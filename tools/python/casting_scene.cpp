#include "python/casting_scene.h"

#include <unistd.h>

#include <mutex>
#include <utility>

namespace radar::python {

namespace {

std::mutex mutex;
std::vector<std::string> messages;

}  // namespace

std::vector<std::string> takeValidationMessages() {
  const std::lock_guard lock(mutex);
  return std::exchange(messages, {});
}

CastingScene::CastingScene(tools::AnswererOptions options) : options_(std::move(options)) {
  options_.onValidation = [](const std::string& message) {
    const std::lock_guard lock(mutex);
    messages.push_back(message);
  };
  options_.onLost = [this](const std::string& how) { losses_.push_back(how); };
}

CastingScene::~CastingScene() {
  leaveForked();
}

// The threads and devices of a process that forked are not here: nothing of them can be used, nor ended.
void CastingScene::leaveForked() {
  if (!answerer_ || process_ == getpid()) return;
  [[maybe_unused]] tools::Answerer* left = answerer_.release();
}

tools::Answerer& CastingScene::answerer() {
  leaveForked();
  if (!answerer_) {
    process_ = getpid();
    answerer_ = std::make_unique<tools::Answerer>(scene(), options_);
  }
  return *answerer_;
}

bool CastingScene::moves() const {
  for (ObjectId id = 0; id < scene().objectLimit(); ++id) {
    if (scene().hasObject(id) && scene().object(id).motion != std::array<double, 3>{}) return true;
  }
  return false;
}

void CastingScene::edit(const std::function<void(BasedScene&)>& change) {
  answerer().edit([&] { change(based_); });
}

std::span<const Device> CastingScene::devices() const {
  return answerer_ ? answerer_->devices() : std::span<const Device>();
}

}  // namespace radar::python
