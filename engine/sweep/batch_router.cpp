#include "sweep/batch_router.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cpu/search.h"

namespace radar {

namespace {

// What is expected where nothing is known. An NVIDIA H200 took 1.5 ms for 1,024 boxes among 30,000 and 50 ms for
// 131,072, with the host's part on 16 threads; these took 10 us of a query (26 November 2026).
constexpr double kDeviceFixed = 1.1e-3, kDeviceEach = 0.37e-6, kCpuEach = 10e-6;
// Of the latest batches, whose mean a figure is: scenes change, and so do queries.
constexpr uint32_t kRemembered = 4;
// A batch weighs as if it had taken so many times what was expected, at most: machines stall.
constexpr double kMostSurprise = 8;
// Tries that have lost in a row count up to this.
constexpr uint8_t kMostLost = 31;

}  // namespace

uint32_t BatchTimes::powerOf(size_t queries) {
  const auto floor = static_cast<uint32_t>(std::bit_width(queries)) - 1;
  const bool isNearerToNext = floor > 0 && (queries >> (floor - 1)) == 3;
  return std::min(floor + (isNearerToNext ? 1 : 0), kPowers - 1);
}

BatchTimes BatchTimes::with(unsigned threads) const {
  BatchTimes other = *this;
  other.threads_ = threads;
  return other;
}

double BatchTimes::curve(Side side, size_t queries) const {
  const auto count = static_cast<double>(queries);
  if (side == Side::device) return kDeviceFixed + kDeviceEach * count;
  const double work = kCpuEach * count;
  return std::min(work, cpu::kWorthThread + work / threads_);
}

uint32_t BatchTimes::nearestKnown(const Figures& figures, uint32_t power) {
  for (uint32_t away = 0; away < kPowers; ++away) {
    if (away <= power && figures[power - away].batches > 0) return power - away;
    if (power + away < kPowers && figures[power + away].batches > 0) return power + away;
  }
  return kPowers;
}

double BatchTimes::expected(Side side, BatchKind kind, size_t queries) const {
  const Figures& figures = of(side, kind);
  const uint32_t known = nearestKnown(figures, powerOf(queries));
  return curve(side, queries) * (known == kPowers ? 1 : double{figures[known].factor});
}

uint32_t BatchTimes::distance(Side side, BatchKind kind, size_t queries) const {
  const uint32_t power = powerOf(queries), known = nearestKnown(of(side, kind), power);
  return known == kPowers ? kUnknown : std::min(known > power ? known - power : power - known, kUnknown);
}

void BatchTimes::took(Side side, BatchKind kind, size_t queries, double seconds) {
  const double before = expected(side, kind, queries);
  const double surprise = std::clamp(seconds / before, 1e-6, kMostSurprise);
  Figure& figure = figures_[static_cast<size_t>(side)][static_cast<size_t>(kind)][powerOf(queries)];
  figure.batches = std::min(figure.batches + 1, kRemembered);
  figure.factor = static_cast<float>(before / curve(side, queries) * std::pow(surprise, 1.0 / figure.batches));
}

BatchRouter::Choice BatchRouter::choose(BatchKind kind, size_t queries) {
  const double onCpu = times_.expected(Side::cpu, kind, queries);
  const double onDevice = times_.expected(Side::device, kind, queries);
  const bool isDevices = onDevice < onCpu;
  const Side sooner = isDevices ? Side::device : Side::cpu, later = isDevices ? Side::cpu : Side::device;
  const double least = std::min(onCpu, onDevice), most = std::max(onCpu, onDevice), loss = most - least;
  const uint32_t doubts = times_.distance(later, kind, queries) +
                          lost_[static_cast<size_t>(later)][static_cast<size_t>(kind)][BatchTimes::powerOf(queries)];
  const double price = loss * (1 + doubts);
  if (sinceTry_++ < kBetween || price >= saved_ || (most > kMostTimes * least && loss > kMostExtra)) {
    return {.side = sooner, .kind = kind, .queries = queries, .otherwise = most};
  }
  saved_ -= price;
  sinceTry_ = 0;
  return {.side = later, .kind = kind, .queries = queries, .otherwise = least, .price = price};
}

void BatchRouter::took(const Choice& choice, double seconds) {
  const auto& [side, kind, queries, otherwise, price] = choice;
  const uint32_t power = BatchTimes::powerOf(queries);
  // The first batches that are as large make room on the device: they are no measure, unless they are fast anyway.
  uint32_t& roomFor = roomFor_[static_cast<size_t>(kind)];
  const bool makesRoom = side == Side::device && power >= roomFor;
  if (makesRoom) roomFor = power + 1;
  const bool isMeasure = !makesRoom || seconds < times_.expected(side, kind, queries);
  if (isMeasure) times_.took(side, kind, queries, seconds);
  hasLearnt_ = hasLearnt_ || isMeasure;
  saved_ += kTriesShare * seconds;
  if (price == 0) return;
  saved_ -= std::max(0.0, seconds - otherwise - price);
  uint8_t& lost = lost_[static_cast<size_t>(side)][static_cast<size_t>(kind)][power];
  if (seconds < otherwise) {
    lost = 0;
  } else if (isMeasure && lost < kMostLost) {
    ++lost;
  }
}

}  // namespace radar
