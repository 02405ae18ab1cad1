#include "sampled/decode.h"

#include "radar/error.h"

namespace radar {

Result decodeClear() {
  Result result(Status::clear);
  result.tier = Tier::select;
  result.detected = Detected::no;
  return result;
}

Result decodeSampled(const gpu::Answer& answer, const Result& contact, const Query& query, uint32_t resolution) {
  if (contact.status == Status::invalid) throw Error(Error::Kind::internal, "mode sampled lost a certain contact");
  Result result = contact;
  // That no proposed pair meets proves nothing.
  if (result.status == Status::clear) result = Result(Status::undecided);
  result.lo = 0;
  if (result.status == Status::hit && !query.anyHit) {
    result.t = result.hi;
    result.fraction = query.distance > 0 ? result.t / query.distance : 0;
  }
  result.tier = Tier::sampled;
  result.resolution = resolution;
  result.detected = (answer.flags & gpu::kAnswerDetected) != 0 ? Detected::yes : Detected::no;
  if ((answer.flags & gpu::kAnswerHasL) != 0) result.paperMinL = answer.minL;
  return result;
}

}  // namespace radar
