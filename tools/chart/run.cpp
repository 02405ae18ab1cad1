#include "chart/run.h"

namespace radar::tools {

namespace {

Repetition repetitionOf(Extent extent) {
  if (extent == Extent::full) return {.least = 5, .most = kNone, .seconds = 0.2};
  if (extent == Extent::quick) return {.least = 3, .most = kNone, .seconds = 0.03};
  return {.least = 1, .most = 1};
}

}  // namespace

Record measureAll(const RunSettings& settings, Record record, const std::filesystem::path& folder,
                  const std::function<void()>& step) {
  for (const Case& which : settings.cases) {
    const Truth truth = truthOf(which.workload);
    for (const Method& method : settings.methods(which.section)) {
      step();
      record.cells.push_back(tryOut(which, method, truth, repetitionOf(settings.extent)));
      writeRecord(folder, record);
    }
  }
  return record;
}

}  // namespace radar::tools
