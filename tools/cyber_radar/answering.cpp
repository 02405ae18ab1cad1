#include "cyber_radar/answering.h"

#include <algorithm>

#include "measure/clock.h"

namespace radar::tools {

namespace {

void addStage(std::vector<StageTime>& stages, const StageTime& stage) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.name == stage.name; });
  if (found == stages.end()) {
    stages.push_back(stage);
  } else {
    found->ms += stage.ms;
  }
}

}  // namespace

Answering::Answering(const Workload& world, const ModesAsked& asked, const AnsweringOptions& options)
    : options_(options), world_(world), player_(world), answerer_(player_.scene(), options) {
  if (options.mode == AnswerMode::sampled && !asked.exactOnly.empty()) {
    throw InputError("--mode", "", "expected contact or reference, as " + asked.exactOnly + " needs, got sampled");
  }
  for (const AnswerMode mode : {AnswerMode::sampled, AnswerMode::contact, AnswerMode::reference}) {
    if (asked.asks(mode, options.mode)) modes_.push_back(mode);
  }
}

void Answering::open() {
  for (const AnswerMode mode : modes_) answerer_.open(mode);
}

void Answering::show(uint32_t scene) {
  answerer_.edit([&] { player_.show(scene); });
}

double Answering::setUp(uint32_t scene) {
  open();
  const double start = now();
  show(scene);
  answerer_.sync();
  return 1e3 * (now() - start);
}

void Answering::check(const Batch& batch, std::span<const QuerySpec> queries) const {
  const Mode mode = batch.mode == AnswerMode::sampled ? Mode::sampled : Mode::contact;
  for (size_t i = 0; i < batch.queries.size(); ++i) {
    const std::string wrong = inKeys(validate(batch.queries[i], player_.scene(), mode));
    if (!wrong.empty()) throw RefusedQuery(batch.numbers[i], queries[batch.numbers[i]].id, wrong);
  }
}

void Answering::check(std::span<const QuerySpec> queries) {
  for (const Batch& batch : batchesOf(queries, options_.resolution, options_.mode)) {
    show(batch.scene);
    check(batch, queries);
  }
}

Answers Answering::answersOf(const Batch& batch, std::span<const QuerySpec> queries) {
  try {
    return answerer_.run(batch.queries, batch.mode);
  } catch (const Error& error) {
    // The engine names the query by its place in the batch.
    if (error.kind == Error::Kind::call) check(batch, queries);
    throw;
  }
}

Answers Answering::movesOf(const Batch& batch, std::vector<Answer>& to) {
  auto found = chains_.find(*batch.chain);
  if (found == chains_.end()) {
    ChainSweeper made(player_.scene(), world_.chains[*batch.chain], options_.threads);
    found = chains_.emplace(*batch.chain, std::move(made)).first;
  }
  Answers answers;
  const std::vector<ChainResult> moves = found->second.run(batch.moves);
  for (size_t i = 0; i < moves.size(); ++i) {
    const auto& [contact, link, mesh, otherLink, otherMesh] = moves[i];
    answers.results.push_back(contact);
    to[batch.numbers[i]].links = {link, mesh, otherLink, otherMesh};
  }
  return answers;
}

std::vector<Answer> Answering::run(std::span<const QuerySpec> queries, Progress& progress) {
  std::vector<Answer> answers(queries.size());
  const std::vector<Batch> batches = batchesOf(queries, options_.resolution, options_.mode);
  const double start = now();
  for (const Batch& batch : batches) {
    show(batch.scene);
    const double begun = now(), computed = threadSeconds();
    Answers found = batch.chain ? movesOf(batch, answers) : answersOf(batch, queries);
    stats_.hostSeconds += threadSeconds() - computed;
    if (batch.mode == AnswerMode::reference) found.stats.stages = {{"reference", 1e3 * (now() - begun)}};
    for (size_t i = 0; i < found.results.size(); ++i) {
      const Result& result = found.results[i];
      answers[batch.numbers[i]].result = result;
      answers[batch.numbers[i]].mode = batch.mode;
      ++stats_.statuses[static_cast<size_t>(result.status)];
      if (result.resolution == 0) continue;
      stats_.leastResolution = std::min(stats_.leastResolution, result.resolution);
      stats_.mostResolution = std::max(stats_.mostResolution, result.resolution);
    }
    for (size_t i = 0; i < found.lists.size(); ++i) answers[batch.numbers[i]].listed = std::move(found.lists[i]);
    for (const auto& [i, reason] : found.reasons) answers[batch.numbers[i]].reason = reason;
    stats_.pairs += found.stats.pairs;
    stats_.cpuPairs += found.stats.cpuPairs;
    stats_.cpuQueries += found.stats.cpuQueries;
    for (const StageTime& stage : found.stats.stages) addStage(stats_.stages, stage);
    progress.add(found.results.size());
  }
  stats_.batches += batches.size();
  stats_.ms += 1e3 * (now() - start);
  return answers;
}

std::vector<Answer> answersTo(const Workload& workload, Answering& answering, const std::string& label) {
  Progress progress(label, workload.queries.size());
  if (!workload.queries.empty()) answering.setUp(workload.queries[0].scene);
  return answering.run(workload.queries, progress);
}

bool someInvalid(std::span<const Answer> answers) {
  return std::ranges::any_of(answers, [](const Answer& a) { return a.result.status == Status::invalid; });
}

}  // namespace radar::tools
