#include "python/errands.h"

#include <sys/types.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <utility>

namespace radar::python {

Errands::Errands() : thread_([this](const std::stop_token& end) { serve(end); }) {}

Errands& Errands::shared() {
  static pid_t process = 0;
  static Errands* errands = nullptr;
  if (!errands || process != getpid()) errands = new Errands;
  process = getpid();
  return *errands;
}

void Errands::serve(const std::stop_token& end) {
  std::unique_lock lock(mutex_);
  while (given_.wait(lock, end, [&] { return errand_.valid(); })) {
    std::packaged_task<void()> errand = std::move(errand_);
    lock.unlock();
    errand();
    lock.lock();
  }
}

void Errands::run(const std::function<void()>& work, const std::function<void()>& look) {
  std::packaged_task<void()> errand(work);
  std::future<void> done = errand.get_future();
  {
    const std::lock_guard lock(mutex_);
    errand_ = std::move(errand);
  }
  given_.notify_one();
  while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) look();
  done.get();
}

void runUnless(const std::function<void()>& look, const std::function<void(const std::stop_token&)>& work) {
  if (!look) return work({});
  std::stop_source stop;
  std::exception_ptr thrown;
  Errands::shared().run([&] { work(stop.get_token()); },
                        [&] {
                          if (thrown) return;
                          try {
                            look();
                          } catch (...) {
                            thrown = std::current_exception();
                            stop.request_stop();
                          }
                        });
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace radar::python
