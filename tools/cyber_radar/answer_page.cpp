#include "cyber_radar/answer_page.h"

#include <cmath>
#include <cstdio>

#include "batch/atomic_file.h"
#include "cyber_radar/words.h"
#include "view/page.h"

namespace radar::tools {

namespace {

std::string exactInWords(const Result& exact) {
  switch (exact.status) {
    case Status::hit:
      return "An exact search: free for " + inDigits(exact.t) + ", then it touches object " +
             std::to_string(exact.object) + ".";
    case Status::overlap:
      return "An exact search: it touches object " + std::to_string(exact.object) + " where it starts.";
    case Status::clear:
      return "An exact search: nothing is in its way.";
    default:
      return "";
  }
}

std::string sampledInWords(const Result& sampled, const Result& exact) {
  std::string text = std::string("The paper's method, from pictures: ") + nameOf(sampled.status);
  if (sampled.status == Status::hit) text += " at " + inDigits(sampled.t);
  if (sampled.t > exact.t && std::isfinite(sampled.t)) {
    char late[16];
    std::snprintf(late, sizeof late, "%.1e", sampled.t - exact.t);
    text += std::string(", late by ") + late;
  }
  return text + ".";
}

/// What mode sampled says of the queries that it answered.
void addSampled(PageContent& content, const Workload& workload, std::span<const Answer> answers,
                const PageOptions& options) {
  constexpr size_t kMostPixels = 1'400'000;  // three numbers each
  const std::span<const Answer> all = options.sampled.empty() ? answers : options.sampled;
  ScenePlayer player(workload);
  CpuSweeper exact(player.scene());
  std::optional<Sweeper> sampled;
  size_t pixels = 0;
  for (uint32_t i = 0; i < all.size(); ++i) {
    const Result& result = all[i].result;
    if (all[i].mode != AnswerMode::sampled || result.status == Status::invalid) continue;
    player.show(workload.queries[i].scene);
    Query query = workload.queries[i];
    const bool isOwn = options.sampled.empty(), isAny = query.anyHit;
    query.anyHit = false;
    if (isOwn) {
      const Result found = exact.run({&query, 1}).results[0];
      content.others[i] = {exactInWords(found), found};
    } else {
      content.others[i] = {sampledInWords(result, answers[i].result), result};
    }
    if (!options.device || isAny || pixels >= kMostPixels || result.resolution == 0) continue;
    if (!sampled) sampled.emplace(*options.device, player.scene());
    query.resolution = result.resolution;
    Scopes scopes = sampled->scopes(query);
    pixels += scopes.R.size();
    content.scopes[i] = std::move(scopes);
  }
}

}  // namespace

std::vector<Result> resultsOf(std::span<const Answer> answers) {
  std::vector<Result> results;
  for (const Answer& answer : answers) results.push_back(answer.result);
  return results;
}

LeftOut leftOutOf(std::span<const Answer> answers) {
  LeftOut left;
  for (uint32_t i = 0; i < answers.size(); ++i) {
    if (!answers[i].listed.overlapping.empty()) left[i] = answers[i].listed.overlapping;
  }
  return left;
}

void writePage(const std::filesystem::path& file, const std::string& title, const Workload& workload,
               std::span<const Answer> answers, const PageOptions& options) {
  PageContent content;
  content.title = title;
  content.tour = options.tour;
  content.left = leftOutOf(answers);
  for (uint32_t i = 0; i < answers.size(); ++i) {
    if (!answers[i].reason.empty()) content.reasons[i] = answers[i].reason;
    if (auto moments = momentsOf(answers[i].listed); !moments.empty()) content.moments[i] = std::move(moments);
    if (!workload.chains.empty()) content.links.push_back(answers[i].links);
  }
  addSampled(content, workload, answers, options);
  writeAtomically(file, pageOf(workload, resultsOf(answers), content));
}

}  // namespace radar::tools
