#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "selftest/selftest.h"

namespace radar::tools {

namespace {

// Who is faster, by the table of part throughput.
struct Race {
  uint32_t device = 0;     ///< its number
  double times = 0;        ///< the CPU's time over the device's in the largest batches, in the mean of the workloads
  uint64_t from = 0;       ///< the device is faster in batches of this size and in larger ones; beyond all: in none
  bool atAnySize = false;  ///< the smallest that was tried is one
};

std::optional<Race> raceOf(const Json& device) {
  std::map<uint64_t, std::vector<double>> logarithms;  // by size of batch
  for (const Json& row : device["parts"]["throughput"]["rows"]) {
    logarithms[row["batch"]].push_back(std::log(row["cpu_over_device"].get<double>()));
  }
  if (logarithms.empty()) return {};
  const auto timesIn = [](const std::vector<double>& all) {
    double sum = 0;
    for (const double one : all) sum += one;
    return std::exp(sum / static_cast<double>(all.size()));
  };
  Race race{device["number"], timesIn(logarithms.rbegin()->second), UINT64_MAX};
  for (auto size = logarithms.rbegin(); size != logarithms.rend() && timesIn(size->second) > 1; ++size) {
    race.from = size->first;
  }
  race.atAnySize = race.from == logarithms.begin()->first;
  return race;
}

std::string speedText(const Race& race) {
  const std::string device = "device " + std::to_string(race.device);
  if (race.times <= 1) {
    return "; the CPU is " + print("%.3g", 1 / race.times) + " times as fast as " + device + ": set --mode reference";
  }
  return "; " + device + " is " + print("%.3g", race.times) + " times as fast as the CPU, " +
         (race.atAnySize
              ? "whatever the batch: set --cpu-batch 0"
              : "from batches of " + std::to_string(race.from) + " on: set --cpu-batch " + std::to_string(race.from));
}

// Right or not, and who is faster by how much.
std::string verdictOn(const Json& report) {
  uint64_t checked = 0, wrong = 0;
  std::string failed;
  std::optional<Race> best;
  const auto lookAt = [&](const std::string& whose, const Json& part) {
    if (part["state"] == "failed" && failed.empty()) failed = ", " + whose + " failed";
  };
  for (const Json& device : report["devices"]) {
    checked += device["answers_checked"].get<uint64_t>();
    wrong += device["answers_wrong"].get<uint64_t>();
    for (const auto& [name, part] : device["parts"].items()) {
      lookAt("part " + name + " of device " + device["number"].dump(), part);
    }
    const std::optional<Race> race = raceOf(device);
    if (race && (!best || race->times > best->times)) best = race;
  }
  lookAt("all devices together", report["together"]);
  const bool isWrong = wrong > 0 || !failed.empty();
  return (isWrong           ? "WRONG ("
          : report["right"] ? "RIGHT ("
                            : "UNFINISHED (") +
         std::to_string(checked) + " answers, " + std::to_string(wrong) + " wrong" + failed + ")" +
         (best && !isWrong ? speedText(*best) : "");
}

}  // namespace

void conclude(Json& report) {
  const auto hasEnded = [](const Json& part) { return part["state"] != "not begun" && part["state"] != "running"; };
  bool allRight = hasEnded(report["together"]) && report["together"]["state"] != "failed";
  for (Json& device : report["devices"]) {
    uint64_t checked = 0, wrong = 0;
    size_t ended = 0;
    bool failed = false;
    for (const Json& part : device["parts"]) {
      failed = failed || part["state"] == "failed";
      ended += hasEnded(part);
      for (const Json& row : part["rows"]) {
        checked += row.value("queries", uint64_t{0}) + row.value("batch", uint64_t{0});
        wrong += row.value("wrong", uint64_t{0}) + row.value("differ", uint64_t{0});
      }
    }
    device["answers_checked"] = checked;
    device["answers_wrong"] = wrong;
    device["parts_ended"] = ended;
    device["right"] = wrong == 0 && !failed && (ended == device["parts"].size() || !device["usable"]);
    allRight = allRight && device["right"];
  }
  report["right"] = allRight;
  report["verdict"] = verdictOn(report);
}

}  // namespace radar::tools
