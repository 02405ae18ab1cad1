#include "pool/chunk_scheduler.h"

#include <algorithm>
#include <cmath>

namespace radar {

namespace {

// A device takes a third of its fair share of what is left: chunks are large at first, small at the end, and a guess of
// its speed that is wrong by less than three does not make the others wait.
constexpr double kShares = 3;
// A device whose speed is not known yet takes so little that a very slow one does not make the others wait.
constexpr double kFirstShares = 32;
// What a submission costs beside its work is below a tenth of this on every device seen, mostly far below.
constexpr double kLeastMs = 1;
// A device that is alone waits for nobody: it only has to have a chunk to encode while it works on another.
constexpr double kLeastMsAlone = 10;
// Speeds change (first use of a pipeline, other work on the machine): the newest chunk counts half.
constexpr double kNewest = 0.5;
// A device 30 times slower is tried again once in eight batches, one that was only slow once soon takes part again.
constexpr double kPassed = 1.5;

}  // namespace

void ChunkScheduler::finished(size_t worker, size_t queries, double ms) {
  if (queries == 0 || ms <= 0) return;
  const double rate = static_cast<double>(queries) / ms;
  double& known = workers_[worker].rate;
  // Times are averaged, not rates: one chunk that was free must not make a device look fast for long.
  known = known == 0 ? rate : 1 / (kNewest / rate + (1 - kNewest) / known);
}

void ChunkScheduler::passed(size_t worker) {
  workers_[worker].rate *= kPassed;
}

size_t ChunkScheduler::alive() const {
  return std::count_if(workers_.begin(), workers_.end(), [](const Worker& w) { return w.alive; });
}

// Who is not known yet is taken for the mean of those who are.
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
    // Taking ahead is for the time when this device is done; by then the others may have done it all.
    if (inFlight > 0 && static_cast<double>(inFlight) / mine >= left / sum) return 0;
    // One query here may take longer than all that is left elsewhere. The fastest device never waits for another.
    if (inFlight == 0 && mine < fastest && 1 / mine > (left + 1) / (sum - mine)) return 0;
  }
  const double share = static_cast<double>(batch) * mine / sum / (known || alone ? kShares : kFirstShares);
  const double wanted =
      std::max({std::ceil(share), known ? std::floor(mine * (alone ? kLeastMsAlone : kLeastMs)) : 0.0, 1.0});
  return static_cast<size_t>(std::min(wanted, static_cast<double>(batch)));
}

}  // namespace radar
