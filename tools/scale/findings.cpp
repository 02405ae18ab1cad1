#include "scale/findings.h"

#include <algorithm>

#include "report/print.h"

namespace radar::tools {

namespace {

// Smaller shares are not worth a sentence.
constexpr double kWorthWords = 0.02;

double percent(double share) {
  return 100 * share;
}

bool isOfDevice(const std::string& stage) {
  return stage != "select" && stage != "encode" && stage != "decode";
}

// Of the time of the stages on the device.
double shareOf(const ScaleRun& run, std::initializer_list<const char*> names) {
  double sum = 0, all = 0;
  for (const StageTime& stage : run.stages) {
    if (!isOfDevice(stage.name)) continue;
    all += stage.ms;
    if (std::find(names.begin(), names.end(), stage.name) != names.end()) sum += stage.ms;
  }
  return all > 0 ? sum / all : 0;
}

std::string onSlower(const ScaleReport& report, const ScaleRun& run, double share) {
  std::string text = print("%.0f%% goes because each device takes longer for a query than alone: ", percent(share));
  const double own = run.cores / report.processors, others = run.machine - own;
  if (others > 0.1) {
    text += print(
        "other programs took %.0f%% of the machine's %u processor cores, so this run says little of the devices; ",
        percent(others), report.processors);
  }
  if (std::max(own, run.machine) > 0.9) {
    return text + print("the %u cores were %.0f%% in use, so devices and the threads that feed them share them.",
                        report.processors, percent(std::max(own, run.machine)));
  }
  return text + print(
                    "%.1f of %u processor cores were in use, so not cores but what else the devices share (memory, "
                    "bus, power) or the smaller chunks slow them.",
                    run.cores, report.processors);
}

std::string onTail(const ScaleReport& report, const ScaleRun& run, double share) {
  uint32_t least = ~0u;
  for (const DeviceShare& device : run.shares) {
    if (device.chunks > 0) least = std::min(least, device.leastChunk);
  }
  const double perBatch =
      static_cast<double>(report.queries[run.point]) / static_cast<double>(report.batches[run.point]);
  return print(
      "%.0f%% is imbalance: a device waits for the last chunk of another. The smallest chunk held %u of a "
      "batch's %.0f queries; larger batches, or several submitted at once, waste less.",
      percent(share), least, perBatch);
}

}  // namespace

Losses lossesOf(const ScaleReport& report, const ScaleRun& run) {
  const double all = run.ms * static_cast<double>(run.devices.size());
  Losses losses;
  for (size_t i = 0; i < run.shares.size(); ++i) {
    const DeviceShare& share = run.shares[i];
    const DeviceShare& alone = report.alone(run.point, run.devices[i]).shares[0];
    const double useful = alone.queries > 0 ? alone.busy / alone.queries * share.queries : 0;
    losses.useful += useful / all;
    losses.slower += (share.busy - useful) / all;
    losses.start += share.start / all;
    losses.gap += share.gap / all;
    losses.tail += share.tail / all;
  }
  losses.scene = run.scene / run.ms;
  return losses;
}

double encodingShare(const ScaleRun& run) {
  double encode = 0, busy = 0;
  for (const DeviceShare& share : run.shares) {
    encode += share.encode;
    busy += share.busy;
  }
  return busy > 0 ? encode / busy : 0;
}

std::vector<std::string> findingsOf(const ScaleReport& report) {
  std::vector<std::string> findings;
  const size_t last = report.sensors.size() - 1, count = report.devices.size();
  const ScaleRun& run = report.run(last, count);
  if (count == 1) {
    findings.push_back("One device: nothing to compare. --device all, or 0,1, takes more.");
  } else {
    findings.push_back(
        print("With %.0f sensors, %zu devices take %.2f ms where device %u alone takes %.2f ms: %.2f "
              "times as fast, %.0f%% of what the devices can do together.",
              report.sensors[last], count, run.ms, report.numbers[0], report.run(last, 1).ms, report.speedUp(run),
              percent(report.efficiency(run))));
  }
  const Losses losses = lossesOf(report, run);
  std::vector<std::pair<double, std::string>> limits{
      {losses.slower, onSlower(report, run, losses.slower)},
      {losses.start,
       print("%.0f%% is submission: devices wait while the first chunk of a batch is encoded.", percent(losses.start))},
      {losses.gap, print("%.0f%% is between chunks: a device is done before the next chunk is encoded. Encoding takes "
                         "%.0f%% as long as the devices work.",
                         percent(losses.gap), percent(encodingShare(run)))},
      {losses.tail, onTail(report, run, losses.tail)},
      {losses.scene,
       print("%.0f%% is between batches: the scene is edited while no device works.", percent(losses.scene))}};
  const double transfers = shareOf(run, {"upload", "readback"});
  limits.emplace_back(transfers, print("%.0f%% of the devices' own time is upload and readback.", percent(transfers)));
  std::stable_sort(limits.begin(), limits.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (limits.front().first < kWorthWords) findings.push_back("Nothing that was measured limits it by 2% or more.");
  for (const auto& [share, sentence] : limits) {
    if (share >= kWorthWords) findings.push_back(sentence);
  }
  if (encodingShare(run) > 0.15) {
    findings.push_back(
        print("Encoding on the CPU takes %.0f%% as long as the devices work: where devices compute on "
              "the same cores, that much is not shared out.",
              percent(encodingShare(run))));
  }
  if (!report.sameBits) findings.push_back("The answers differ between sets of devices: the drivers are not alike.");
  return findings;
}

}  // namespace radar::tools
