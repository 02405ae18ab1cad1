#include "pool/chunk_scheduler.h"

#include <algorithm>
#include <cmath>

namespace radar {

namespace {

// A device takes a third of its fair share of the remaining queries. So chunks are large at first and small at the end,
// and overestimating its speed by less than three does not make the others wait.
constexpr double kShares = 3;
// A device of unknown speed takes so little that even a very slow one does not make the others wait.
constexpr double kFirstShares = 32;
// Least duration of a chunk. The overhead of a submission was below a tenth of this on every device measured.
constexpr double kLeastMs = 1;
// The same for a single device, which needs chunks only to encode one while it works on another.
constexpr double kLeastMsAlone = 10;
// Weight of the newest chunk: speeds change with the first use of a pipeline and other work on the machine.
constexpr double kNewest = 0.5;
// Growth of the estimated speed of a device that was passed over: one that is 30 times slower is tried again once in
// eight batches; one that was slow only once takes part again soon.
constexpr double kPassed = 1.5;

}  // namespace

void ChunkScheduler::finished(size_t worker, size_t queries, double ms) {
  if (queries == 0 || ms <= 0) return;
  const double rate = static_cast<double>(queries) / ms;
  double& known = workers_[worker].rate;
  // Times are averaged, not rates, so that one chunk without work does not make a device look fast for long.
  known = known == 0 ? rate : 1 / (kNewest / rate + (1 - kNewest) / known);
}

void ChunkScheduler::passed(size_t worker) {
  workers_[worker].rate *= kPassed;
}

size_t ChunkScheduler::alive() const {
  return std::count_if(workers_.begin(), workers_.end(), [](const Worker& w) { return w.alive; });
}

// A worker of unknown speed counts as the mean of the others.
double ChunkScheduler::rateOf(size_t worker) const {
  if (workers_[worker].rate > 0) return workers_[worker].rate;
  double sum = 0, count = 0;
  for (const Worker& other : workers_) {
    if (!other.alive || other.rate == 0) continue;
    sum += other.rate;
    ++count;
  }
  return count > 0 ? sum / count : 1;
}

size_t ChunkScheduler::take(size_t worker, size_t batch, size_t all, size_t inFlight) const {
  const double mine = rateOf(worker);
  double sum = 0, fastest = 0;
  for (size_t i = 0; i < workers_.size(); ++i) {
    if (!workers_[i].alive) continue;
    sum += rateOf(i);
    fastest = std::max(fastest, rateOf(i));
  }
  const double left = static_cast<double>(all);
  const bool known = workers_[worker].rate > 0, alone = alive() == 1;
  if (!alone) {
    if (inFlight > 0 && !known) return 0;
    // A chunk taken ahead starts when this device is done with those in flight; by then the others may have done all.
    if (inFlight > 0 && static_cast<double>(inFlight) / mine >= left / sum) return 0;
    // One query here may take longer than all that is left elsewhere. This never applies to the fastest device.
    if (inFlight == 0 && mine < fastest && 1 / mine > (left + 1) / (sum - mine)) return 0;
  }
  const double share = static_cast<double>(batch) * mine / sum / (known || alone ? kShares : kFirstShares);
  const double wanted =
      std::max({std::ceil(share), known ? std::floor(mine * (alone ? kLeastMsAlone : kLeastMs)) : 0.0, 1.0});
  return static_cast<size_t>(std::min(wanted, static_cast<double>(batch)));
}

}  // namespace radar
