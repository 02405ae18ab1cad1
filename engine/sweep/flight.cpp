#include "sweep/flight.h"

#include <algorithm>
#include <utility>

#include "gpu/api.h"
#include "gpu/submission.h"
#include "query/hits.h"

namespace radar {

Flight::Flight(std::span<const Query> asked, bool timestamps, std::stop_token wanted, Answers memory)
    : queries(asked),
      answers(std::move(memory)),
      deviceDone(Clock::now()),
      measures(timestamps),
      stop(std::move(wanted)) {
  clearFor(asked, 1, answers);
}

Flight::Flight(std::span<const Query> asked, std::span<const SearchNeeds> known, bool timestamps,
               std::stop_token wanted, Answers memory)
    : queries(asked),
      answers(std::move(memory)),
      deviceDone(Clock::now()),
      measures(timestamps),
      stop(std::move(wanted)),
      needs(known) {
  makeRoom(asked.size(), std::ranges::any_of(known, &SearchNeeds::lists), answers);
}

void Flight::fail(size_t query, const Error& error) {
  if (error.vulkan == VK_SUCCESS && error.kind != Error::Kind::internal) throw error;
  if (!failure) failure = error;
  answers.results[query] = Result();
  answers.reasons[query] = error.what();
}

bool Flight::survives(const Error& error) {
  if (!gpu::isOutOfMemory(error) && !gpu::isLost(error)) return false;
  if (!failure) failure = error;
  return true;
}

void Flight::addCpuTime(const char* name, double ms) {
  if (measures) gpu::addStageTime(answers.stats.stages, name, ms);
}

}  // namespace radar
