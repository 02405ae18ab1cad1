#include <algorithm>
#include <filesystem>
#include <iostream>

#include "batch/atomic_file.h"
#include "commit/commit.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/failure_pictures.h"
#include "cyber_radar/progress.h"
#include "stability/measure.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar stability --cases 2000 --resolution 16,64     under a minute
  cyber-radar stability --out docs/stability                tables of every family, and pictures of how sampling fails
  cyber-radar stability --family thin --first 17 --cases 1  one case again

Needles and plates edge-on, steep faces, exact touching, gaps of one rounding, 10^7 units from the origin, rings on
pegs, bodies at rest and the like: every tier is asked that offers what the query asks for, and each answer is compared
with the exact one. Then the answers are followed in tiny steps of the pose, and through changes that leave the contact
where it is. Exit status 1 if a promise is broken.)";

struct Options {
  StabilitySettings settings;
  std::string out;
  uint32_t device = kNone;
  bool partly() const { return !settings.families.empty() || settings.first != 0; }
};

/// The rounding of t is far below this; a step or change beyond it is a broken promise.
constexpr double kRounding = 1e-12;

struct Findings {
  std::vector<StabilityRow> rows;
  std::vector<StepRow> steps;
  std::vector<ChangeRow> changes;
};

bool isRight(const StepRow& row) {
  return row.asked.resolution > 0 || (row.flips == 0 && row.excess <= kRounding);
}

bool isRight(const Findings& findings) {
  const auto all = [](const auto& rows, const auto& test) { return std::all_of(rows.begin(), rows.end(), test); };
  return all(findings.rows, [](const StabilityRow& row) { return row.right(); }) &&
         all(findings.steps, [](const StepRow& row) { return isRight(row); }) &&
         all(findings.changes, [](const ChangeRow& row) { return row.broken == 0; });
}

Findings measureAll(const Device& device, const Options& options) {
  const StabilitySettings& settings = options.settings;
  const uint64_t families = settings.families.empty() ? hardFamilies().size() : settings.families.size();
  const uint64_t each = (settings.cases + families - 1) / families;
  StepSettings steps{.seed = settings.seed};
  steps.cases = static_cast<uint32_t>(std::min<uint64_t>(steps.cases, each));
  ChangeSettings changes{.seed = settings.seed};
  changes.cases = static_cast<uint32_t>(std::min<uint64_t>(changes.cases, settings.cases));
  const auto onWrong = [](const std::string& words) { std::cout << "WRONG: " << words << "\n"; };
  Progress progress("cases", families * each + (options.partly() ? 0 : families * steps.cases + changes.cases));
  const auto onProgress = [&](uint64_t done) { progress.add(done); };
  Findings findings;
  findings.rows = measureStability(device, settings, onWrong, onProgress);
  if (options.partly()) return findings;
  findings.steps = measureSteps(device, steps, onProgress);
  findings.changes = measureChanges(device, changes, onWrong, onProgress);
  return findings;
}

void writeFiles(const std::filesystem::path& folder, const Device& device, const Findings& findings) {
  writeAtomically(folder / "table.csv", csvOf(tableOf(findings.rows)));
  writeAtomically(folder / "steps.csv", csvOf(tableOf(findings.steps)));
  writeAtomically(folder / "changes.csv", csvOf(tableOf(findings.changes)));
  writeAtomically(folder / "families.csv", csvOf(tableOf(hardFamilies())));
  drawFailures(device, folder);
  std::cout << "\nTables and pictures in " << std::filesystem::absolute(folder).string() << "\n";
}

int stability(const Options& options) {
  if (!options.out.empty()) makeFolder("--out", options.out);
  const Device device = Device::open({.index = options.device});
  std::cout << "device " << device.name() << ", driver " << device.driver() << ", commit " << commit() << "\n";
  const Findings findings = measureAll(device, options);
  std::cout << textOf(tableOf(overFamilies(findings.rows)));
  if (!findings.steps.empty()) std::cout << "\n" << textOf(tableOf(overFamilies(findings.steps)));
  for (const StepRow& row : findings.steps) {
    if (isRight(row)) continue;
    std::cout << "WRONG: steps of " << row.family << ": " << row.flips << " flips, excess " << row.excess << "\n";
  }
  if (!findings.changes.empty()) std::cout << "\n" << textOf(tableOf(findings.changes));
  if (!options.out.empty()) writeFiles(options.out, device, findings);
  return isRight(findings) ? 0 : 1;
}

std::vector<std::string> familyNames() {
  std::vector<std::string> names;
  for (const HardFamily& family : hardFamilies()) names.push_back(family.name);
  return names;
}

}  // namespace

void addStabilityCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "stability", "Holds every tier against the exact answer where collision queries are known to fail");
  command->footer(kExamples);
  auto options = std::make_shared<Options>();
  StabilitySettings& settings = options->settings;
  command->add_option("--cases", settings.cases, "In all, over the families alike")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1'000'000'000}))
      ->capture_default_str();
  command->add_option("--seed", settings.seed, "Another seed, other cases")->capture_default_str();
  command->add_option("--resolution", settings.resolutions, "Pixels of the scopes' longer side, with commas between")
      ->delimiter(',')
      ->check(CLI::Range(1u, kMaxResolution))
      ->type_name("N,...")
      ->capture_default_str();
  CLI::Option* out =
      command->add_option("--out", options->out, "Folder for tables of every family and pictures of failures");
  out->type_name("DIR");
  command->add_option("--family", settings.families, "Only these")->check(CLI::IsMember(familyNames()))->excludes(out);
  command->add_option("--first", settings.first, "Number of each family's first case")->excludes(out);
  command->add_option("--device", options->device, "Number of the device, as cyber-radar devices lists them")
      ->type_name("I");
  command->callback([options, &status] { status = stability(*options); });
}

}  // namespace radar::tools
