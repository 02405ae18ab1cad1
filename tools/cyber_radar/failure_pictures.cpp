#include "cyber_radar/failure_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cyber_radar/scope_picture.h"
#include "cyber_radar/words.h"
#include "radar/cpu_sweeper.h"
#include "workloads/stability.h"

namespace radar::tools {

namespace {

struct Kind {
  const char* family;
  Method method;
  Failure failure;
  const char *file, *title, *why;
};

constexpr std::array kKinds{
    Kind{"thin", Method::paper, Failure::missed, "thin", "A rod is not seen",
         "It is thinner than a pixel and lies between the pixels' centres, so R does not contain it. More pixels "
         "only move the limit."},
    Kind{"edge-on", Method::paper, Failure::missed, "edge-on", "A plate is not seen",
         "It is edge-on, so it has no area and covers no pixel's centre at any resolution."},
    Kind{"slope", Method::paper, Failure::late, "slope", "Too late on a steep face",
         "Within one pixel, its depth changes by many times the pixel's side. The contact lies between two centres, "
         "but L "
         "holds the gap only at the centres."},
    Kind{"ball in cup", Method::paper, Failure::early, "ball-in-cup", "Too early in a concavity",
         "R and M hold one layer each: the scene's first surface beyond the sensor's back plane, and the sensor's "
         "front. "
         "Where the sensor is already past that surface, L is negative, and min(L) claims a contact now."},
    Kind{"hook behind bar", Method::paper, Failure::falseHit, "hook", "A contact that does not exist",
         "A hook and a bar have passed each other. L is negative in the pixels they share, but they will never meet."},
    Kind{
        "depth", Method::sampled, Failure::missed, "depth", "An overlap at the start is not seen",
        "Where surfaces already cross, L is negative. That does not prove a contact (see the concavity above), so mode "
        "sampled answers undecided."}};

StabilityPicture draw(const Device& device, const Kind& kind, const TellingCase& telling, uint64_t seed,
                      const std::filesystem::path& folder) {
  const auto& families = stabilityFamilies();
  const auto family = std::find_if(families.begin(), families.end(), [&](auto& f) { return f.name == kind.family; });
  const Workload workload = workloadOf({stabilityCase(*family, telling.number, seed)});
  Scene scene;
  replaceBy(workload, 0, scene);
  Sweeper sweeper(device, scene);
  const Query query = toQuery(workload.queries[0], Mode::sampled, kTellingResolution);
  const Scopes scopes = sweeper.scopes(query);
  const Result exact = CpuSweeper(scene).run({&query, 1})[0];
  const bool contact = exact.status != Status::clear;
  const double value = family->values[telling.number % family->values.size()];
  const std::string numbers =
      "case " + std::to_string(telling.number) + " of \"" + kind.family + "\" (" + inDigits(value) +
      "):  D = " + inDigits(query.distance) + ",  exact t = " + (contact ? inDigits(exact.t) : "none") +
      ",  min(L) = " + (std::isnan(scopes.result.paperMinL) ? "none" : inDigits(scopes.result.paperMinL));
  const std::string file = std::string("stability/") + kind.file + ".png";
  writeScopePicture(folder / file, numbers, scopes, panelsOf(scopes));
  return {file, kind.title, kind.why};
}

}  // namespace

std::vector<StabilityPicture> drawFailures(const Device& device, const StabilityReport& report, uint64_t seed,
                                           const std::filesystem::path& folder) {
  std::vector<StabilityPicture> pictures;
  for (const Kind& kind : kKinds) {
    const auto found = std::find_if(report.telling.begin(), report.telling.end(), [&](const TellingCase& telling) {
      return telling.family == kind.family && telling.method == kind.method && telling.failure == kind.failure;
    });
    if (found != report.telling.end()) pictures.push_back(draw(device, kind, *found, seed, folder));
  }
  return pictures;
}

}  // namespace radar::tools
