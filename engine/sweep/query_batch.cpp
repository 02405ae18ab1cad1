#include "sweep/query_batch.h"

#include "gpu/submission.h"

namespace radar {

void QueryBatch::fail(size_t query, const Error& error) {
  if (error.result == VK_SUCCESS) throw error;
  if (!failure) failure = error;
  answers[query] = Result();
  reasons[query] = error.what();
}

void QueryBatch::addCpuTime(const char* name, double ms) {
  if (timestamps) gpu::addStageTime(stats.stages, name, ms);
}

}  // namespace radar
