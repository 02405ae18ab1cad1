#include "measure/judge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "workloads/workload.h"

namespace radar::tools {

namespace {

bool same(double x, double y) {
  return x == y || (std::isnan(x) && std::isnan(y));
}

bool same(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  return same(x[0], y[0]) && same(x[1], y[1]) && same(x[2], y[2]);
}

/// An answer that tells whether there is a contact, and nothing else of it.
void judgeDecision(const Result& result, Verdict& verdict) {
  verdict.set(Fault::wrongStatus, result.status == Status::overlap);
  verdict.set(Fault::late, result.t != result.hi || result.fraction != (result.hi > 0 ? 1 : 0));
  verdict.set(Fault::wrongPair, result.object != kNone || result.triA != kNone || result.triB != kNone);
  verdict.set(Fault::wrongPair, result.featureA != Feature::none || result.featureB != Feature::none);
  verdict.set(Fault::point, !std::isnan(result.point[0]));
  verdict.set(Fault::normal, !std::isnan(result.normal[0]));
}

void judgeSampled(const Result& result, const Result& exact, Verdict& verdict) {
  if (result.status == Status::clear) return;
  verdict.set(Fault::bracket, result.lo != 0);
  if (!meets(result)) return verdict.set(Fault::bracket, result.hi != INFINITY);
  verdict.set(Fault::wrongStatus, result.status == Status::overlap && exact.status != Status::overlap);
  verdict.set(Fault::bracket, result.t != result.hi);
}

Verdict judgeByBits(const Result& result, const Result& exact) {
  Verdict verdict;
  verdict.found = meets(exact) && meets(result);
  verdict.set(Fault::missed, meets(exact) && result.status == Status::clear);
  verdict.set(Fault::falseHit, exact.status == Status::clear && meets(result));
  verdict.set(Fault::unanswered, result.status == Status::invalid);
  verdict.set(Fault::wrongStatus, result.status != exact.status || result.detected != exact.detected);
  verdict.set(Fault::bracket, !same(result.lo, exact.lo) || !same(result.hi, exact.hi));
  verdict.set(Fault::late, !same(result.t, exact.t) || !same(result.fraction, exact.fraction));
  verdict.set(Fault::wrongPair, result.object != exact.object || result.triB != exact.triB ||
                                    result.triA != exact.triA || result.featureA != exact.featureA ||
                                    result.featureB != exact.featureB || result.resolution != 0);
  verdict.set(Fault::point, !same(result.point, exact.point) || !same(result.gap, exact.gap));
  verdict.set(Fault::normal, !same(result.normal, exact.normal));
  return verdict;
}

}  // namespace

bool meets(const Result& result) {
  return result.status == Status::hit || result.status == Status::overlap;
}

const char* nameOf(Fault fault) {
  constexpr std::array<const char*, kFaults> kNames{"missed",     "false hit",  "not answered", "wrong status",
                                                    "wrong pair", "wrong list", "bracket",      "late",
                                                    "point",      "normal"};
  return kNames[static_cast<size_t>(fault)];
}

std::string Verdict::words() const {
  std::string list;
  for (size_t i = 0; i < kFaults; ++i) {
    if (faults_[i]) list.append(list.empty() ? "" : ", ").append(nameOf(static_cast<Fault>(i)));
  }
  return list;
}

Verdict judge(const Result& result, const Result& exact, double unit) {
  if (result.status == Status::invalid) throw Error("a query was not answered");
  Verdict verdict;
  const bool contact = meets(exact);
  verdict.set(Fault::missed, contact && result.status == Status::clear);
  verdict.set(Fault::falseHit, !contact && meets(result));
  verdict.unseen = contact && result.status == Status::undecided;
  verdict.found = contact && meets(result);
  if (!verdict.found) return verdict;
  verdict.set(Fault::bracket, result.lo > exact.hi || result.hi < exact.lo);
  if (result.t != exact.t && !std::isnan(result.t)) verdict.error = (result.t - exact.t) / unit;
  return verdict;
}

double unitOf(const Scene& scene, const Query& query, const Result& exact) {
  return std::max(sensorSize(scene, query), meets(exact) ? exact.t : 0);
}

Verdict judge(const Scene& scene, const Query& query, Mode mode, const Result& result, const Result& exact) {
  if (mode != Mode::sampled) return judgeByBits(result, exact);
  Verdict verdict;
  if (result.status == Status::invalid) {
    verdict.set(Fault::unanswered);
    return verdict;
  }
  verdict = judge(result, exact, unitOf(scene, query, exact));
  if (query.anyHit) verdict.error = 0;  // nobody looked for the first contact
  if (verdict.found) {
    // No bound may be absent or beyond D.
    verdict.set(Fault::bracket, !(result.lo <= exact.hi && exact.lo <= result.hi && result.hi <= query.distance));
    verdict.set(Fault::wrongStatus, result.detected != Detected::yes);
    if (query.anyHit) judgeDecision(result, verdict);
  }
  judgeSampled(result, exact, verdict);
  return verdict;
}

void Tally::add(const Verdict& verdict, const Result& exact) {
  ++queries;
  hits += exact.status == Status::hit;
  clear += exact.status == Status::clear;
  overlaps += exact.status == Status::overlap;
  unseen += verdict.unseen;
  wrong += !verdict.right();
  for (size_t i = 0; i < kFaults; ++i) faults[i] += verdict[static_cast<Fault>(i)];
  late = std::max(late, verdict.error);
  early = std::max(early, -verdict.error);
}

void Tally::add(const Tally& other) {
  for (uint64_t Tally::*number : {&Tally::queries, &Tally::hits, &Tally::clear, &Tally::overlaps, &Tally::unseen,
                                  &Tally::wrong, &Tally::pairs, &Tally::cpuPairs}) {
    this->*number += other.*number;
  }
  for (size_t i = 0; i < kFaults; ++i) faults[i] += other.faults[i];
  late = std::max(late, other.late);
  early = std::max(early, other.early);
  deviceSeconds += other.deviceSeconds;
  cpuSeconds += other.cpuSeconds;
}

}  // namespace radar::tools
