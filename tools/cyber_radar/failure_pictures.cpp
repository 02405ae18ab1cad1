#include "cyber_radar/failure_pictures.h"

#include "cyber_radar/scope_picture.h"
#include "cyber_radar/words.h"
#include "radar/cpu_sweeper.h"
#include "workloads/hard_cases.h"

namespace radar::tools {

namespace {

constexpr uint32_t kResolution = 64;

/// Cases of seed 1 that show a failure well.
struct Shown {
  const char* file;
  const char* family;
  uint64_t number;
};
constexpr Shown kShown[]{{"thin.png", "thin", 2},          {"edge-on.png", "edge-on", 0},
                         {"slope.png", "slope", 308},      {"ball-in-cup.png", "interlocking", 213},
                         {"hook.png", "interlocking", 16}, {"depth.png", "depth", 40}};

void draw(const Device& device, const Shown& shown, const std::filesystem::path& folder) {
  const HardFamily& family = hardFamily(shown.family);
  const Workload workload = hardScene(family, 1, shown.number, 1, Company::isolated);
  Scene scene;
  replaceBy(workload, 0, scene);
  Sweeper sweeper(device, scene);
  const Query query = queriesOf(workload.queries, kResolution).front();
  const Scopes scopes = sweeper.scopes(query);
  const Result exact = CpuSweeper(scene).run({&query, 1}).results[0];
  const double value = family.values[shown.number % family.values.size()];
  const std::string numbers = "case " + std::to_string(shown.number) + " of \"" + family.name + "\" (" +
                              inDigits(value) + "):  D = " + inDigits(query.distance) +
                              ",  exact t = " + (exact.status == Status::clear ? "none" : inDigits(exact.t)) +
                              ",  min(L) = " + leastFreeDistance(scopes);
  writeScopePicture(folder / shown.file, numbers, scopes);
}

}  // namespace

void drawFailures(const Device& device, const std::filesystem::path& folder) {
  for (const Shown& shown : kShown) draw(device, shown, folder);
}

}  // namespace radar::tools
