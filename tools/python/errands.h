// A thread that works while its owner looks around.
#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <stop_token>
#include <thread>

namespace radar::python {

/// Sleeps between errands: a thread for each would double the time of a short cast. For one thread at a time.
class Errands {
 public:
  Errands();
  /// Of this process; made by the first call, also after a fork. Never ended, as one may exit within an errand.
  static Errands& shared();

  /// Does `work` on the other thread. Until it is done, calls `look` on this one, about every 50 ms. Rethrows what
  /// `work` throws; `look` must not throw.
  void run(const std::function<void()>& work, const std::function<void()>& look);

 private:
  void serve(const std::stop_token& end);

  std::mutex mutex_;
  std::condition_variable_any given_;
  std::packaged_task<void()> errand_;
  std::jthread thread_;  // declared last, so that it begins last
};

/// Does `work`. If there is a `look`, it is called meanwhile, as by Errands::run(), on this thread, which must be the
/// one that uses Errands::shared(); what it throws requests the stop of the work, and is rethrown when that has ended.
void runUnless(const std::function<void()>& look, const std::function<void(const std::stop_token&)>& work);

}  // namespace radar::python
