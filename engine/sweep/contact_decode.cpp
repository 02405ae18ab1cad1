#include "sweep/contact_decode.h"

#include <algorithm>

#include "sweep/exact_pairs.h"

namespace radar {

namespace {

// Within D or not.
void tellDecision(Result& result, double distance) {
  result.status = Status::hit;
  result.detected = Detected::yes;
  result.lo = 0;
  result.hi = distance;
}

}  // namespace

Result decodeContact(const Found& found, const Query& query, uint64_t& cpuPairs) {
  const Error lost("the contact search lost what it met", VK_ERROR_UNKNOWN);
  if (found.result.status == Status::invalid) throw lost;
  if ((found.result.flags & kFlagOpen) == 0) return found.result;
  ExactPairs exact(query);
  for (const gpu::OpenContender* open : found.open) {
    exact.consider({open->object, open->triB, open->triA}, placedPair(*open, query));
    ++cpuPairs;
    if (query.decide && exact.found()) break;
  }
  Result result;
  result.tier = Tier::contact;
  result.status = Status::clear;
  if (!exact.found()) {
    if (found.result.detected == Detected::yes) throw lost;
  } else if (query.decide) {
    tellDecision(result, query.distance);
  } else {
    exact.tell(result);
  }
  return result;
}

}  // namespace radar
