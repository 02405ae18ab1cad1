#include <algorithm>
#include <filesystem>
#include <iostream>

#include "batch/atomic_file.h"
#include "commit/commit.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/failure_pictures.h"
#include "cyber_radar/origin.h"
#include "cyber_radar/progress.h"
#include "import/input_error.h"
#include "stability/page.h"
#include "stability/table.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar stability --cases 2000 --resolution 16,64     under a minute
  cyber-radar stability --out docs                          docs/stability.md; tables and pictures in docs/stability
  cyber-radar stability --family thin --first 17 --cases 1  one case again

Needles and plates edge-on, steep faces, exact touching, gaps of one rounding, 10^7 units from the origin, rings on
pegs and the like: each tier is asked, and held against the exact answer. Then answers are followed in tiny steps of the
pose, and through changes that leave the contact where it is. Exit status 1 if a promise is broken.)";

struct Options {
  StabilitySettings settings;
  std::string out;
  uint32_t device = kNone;
  bool partly() const { return !settings.families.empty() || settings.first != 0; }
};

/// The rounding of t is far below this; a step or change beyond it is a broken promise.
constexpr double kRounding = 1e-12;

bool right(const StabilityFindings& findings) {
  const bool steps = std::all_of(findings.steps.begin(), findings.steps.end(), [](const StepRow& row) {
    return row.method != Method::contact || (row.flips == 0 && row.excess <= kRounding);
  });
  const bool changes = std::all_of(findings.changes.begin(), findings.changes.end(),
                                   [](const ChangeRow& row) { return row.broken == 0; });
  return steps && changes && findings.report.right();
}

StabilityFindings measureAll(const Device& device, const Options& options) {
  const StabilitySettings& settings = options.settings;
  const uint64_t families = settings.families.empty() ? stabilityFamilies().size() : settings.families.size();
  const uint64_t each = (settings.cases + families - 1) / families;
  StepSettings steps{.seed = settings.seed};
  steps.cases = static_cast<uint32_t>(std::min<uint64_t>(steps.cases, each));
  ChangeSettings changes{.seed = settings.seed};
  changes.cases = static_cast<uint32_t>(std::min<uint64_t>(changes.cases, settings.cases));
  const auto onWrong = [](const std::string& words) { std::cout << "WRONG: " << words << "\n"; };
  Progress progress("cases", families * each + (options.partly() ? 0 : families * steps.cases + changes.cases));
  const auto onProgress = [&](uint64_t done) { progress.add(done); };
  StabilityFindings findings;
  findings.report = measureStability(device, settings, onWrong, onProgress);
  if (options.partly()) return findings;
  findings.steps = measureSteps(device, steps, onProgress);
  findings.changes = measureChanges(device, changes, onWrong, onProgress);
  return findings;
}

void writeFiles(const Options& options, const Device& device, StabilityFindings& findings) {
  const std::filesystem::path folder = options.out;
  std::string command = "cyber-radar stability --cases " + std::to_string(options.settings.cases) + " --seed " +
                        std::to_string(options.settings.seed) + " --resolution ";
  for (size_t i = 0; i < options.settings.resolutions.size(); ++i) {
    command += (i == 0 ? "" : ",") + std::to_string(options.settings.resolutions[i]);
  }
  findings.pictures = drawFailures(device, findings.report, options.settings.seed, folder);
  const std::filesystem::path tables = folder / "stability";
  writeAtomically(tables / "table.csv", csvOf(findings.report.rows));
  writeAtomically(tables / "steps.csv", csvOf(findings.steps));
  writeAtomically(tables / "changes.csv", csvOf(findings.changes));
  writeAtomically(tables / "families.csv", csvOf(stabilityFamilies()));
  writeAtomically(folder / "stability.md",
                  pageOf(findings, {command + " --out DIR", commit(), today(), device.name(), device.driver()}));
  std::cout << "\nIn " << std::filesystem::absolute(folder).string() << ": stability.md, stability/\n";
}

int stability(const Options& options) {
  if (!options.out.empty()) {
    std::error_code error;
    std::filesystem::create_directories(std::filesystem::path(options.out) / "stability", error);
    if (error) throw InputError("--out", options.out, "expected a folder, or a place for one");
  }
  const Device device = Device::open({.index = options.device});
  std::cout << "device " << device.name() << ", driver " << device.driver() << "\n";
  StabilityFindings findings = measureAll(device, options);
  std::cout << tableOf(overFamilies(findings.report.rows));
  for (const StepRow& row : findings.steps) {
    if (row.method == Method::contact && (row.flips != 0 || row.excess > kRounding)) {
      std::cout << "WRONG: steps of " << row.family << ": " << row.flips << " flips, excess " << row.excess << "\n";
    }
  }
  if (!options.out.empty()) writeFiles(options, device, findings);
  return right(findings) ? 0 : 1;
}

std::vector<std::string> familyNames() {
  std::vector<std::string> names;
  for (const StabilityFamily& family : stabilityFamilies()) names.push_back(family.name);
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
  CLI::Option* out = command->add_option("--out", options->out, "Folder for stability.md and what it shows");
  out->type_name("DIR");
  command->add_option("--family", settings.families, "Only these")->check(CLI::IsMember(familyNames()))->excludes(out);
  command->add_option("--first", settings.first, "Number of each family's first case")->excludes(out);
  command->add_option("--device", options->device, "Number of the device, as cyber-radar devices lists them")
      ->type_name("I");
  command->callback([options, &status] { status = stability(*options); });
}

}  // namespace radar::tools
