#include "sweep/asked.h"

#include "gpu/submission.h"

namespace radar {

void Asked::giveUp(size_t query, const Error& error) {
  if (error.result == VK_SUCCESS) throw error;
  if (!failure) failure = error;
  answers[query] = Result();
  reasons[query] = error.what();
}

void Asked::addCpuTime(const char* name, double ms) {
  if (timestamps) gpu::addStageTime(stats.stages, name, ms);
}

}  // namespace radar
