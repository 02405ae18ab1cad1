#include "sweep/query_batch.h"

#include "gpu/check.h"
#include "gpu/submission.h"

namespace radar {

void QueryBatch::fail(size_t query, const Error& error) {
  if (error.vulkan == VK_SUCCESS) throw error;
  if (!failure) failure = error;
  answers.results[query] = Result();
  answers.reasons[query] = error.what();
}

bool QueryBatch::survives(const Error& error) {
  if (!gpu::isOutOfMemory(error)) return false;
  if (!failure) failure = error;
  return true;
}

void QueryBatch::addCpuTime(const char* name, double ms) {
  if (timestamps) gpu::addStageTime(answers.stats.stages, name, ms);
}

}  // namespace radar
