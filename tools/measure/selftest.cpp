#include "measure/selftest.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace radar::tools {

namespace {

// Who is faster, by the table of part throughput.
struct Race {
  uint32_t device = 0;     ///< its number
  double times = 0;        ///< the CPU's time over the device's in the largest batches, in the mean of the workloads
  uint64_t from = 0;       ///< the device is faster in batches of this size and in larger ones; beyond all: in none
  bool atAnySize = false;  ///< the smallest that was tried is one
};

// That of the device that is fastest.
std::optional<Race> raceOf(const Json& throughput) {
  std::map<uint32_t, std::map<uint64_t, std::vector<double>>> logarithms;  // by device, by size of batch
  for (const Json& row : throughput) {
    logarithms[row["device"]][row["batch"]].push_back(std::log(row["cpu_over_device"].get<double>()));
  }
  const auto timesIn = [](const std::vector<double>& all) {
    double sum = 0;
    for (const double one : all) sum += one;
    return std::exp(sum / static_cast<double>(all.size()));
  };
  std::optional<Race> best;
  for (const auto& [device, sizes] : logarithms) {
    Race race{device, timesIn(sizes.rbegin()->second), UINT64_MAX};
    for (auto size = sizes.rbegin(); size != sizes.rend() && timesIn(size->second) > 1; ++size) race.from = size->first;
    race.atAnySize = race.from == sizes.begin()->first;
    if (!best || race.times > best->times) best = race;
  }
  return best;
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

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

std::string wordsOf(const std::exception& error) {
  std::string words = error.what();
  if (const auto* own = dynamic_cast<const Error*>(&error)) {
    for (const std::string& reason : own->reasons) words += "; " + reason;
  }
  return words;
}

// A device under test.
struct Tested {
  uint32_t number;
  bool sampled;
};

// Opens the usable devices of the report.
void open(Json& report, std::vector<Device>& devices, std::vector<Tested>& tested) {
  Json& part = partOf(report, "devices");
  for (const Json& row : part["rows"]) {
    if (!row["usable"]) continue;
    try {
      devices.push_back(Device::open({.index = row["number"]}));
      tested.push_back({row["number"], row["sampled_reasons"] == ""});
    } catch (const std::exception& error) {
      part["state"] = "failed";
      part["note"] = "device " + row["number"].dump() + ": " + wordsOf(error);
    }
  }
}

}  // namespace

Json factsOf(uint32_t number, const DeviceReport& report) {
  Json facts{{"number", number},
             {"name", report.name},
             {"type", report.type},
             {"driver", report.driver},
             {"vulkan", report.version},
             {"memory_bytes", report.memory},
             {"subgroup", report.subgroup},
             {"has_doubles", report.doubles},
             {"usable", report.usable()},
             {"reasons", report.reasons},
             {"sampled_reasons", report.sampledReasons},
             {"limits", Json::array()}};
  for (const DeviceLimit& limit : report.limits) {
    facts["limits"].push_back({{"limit", limit.name},
                               {"has", limit.has},
                               {"needed", limit.needed},
                               {"mode", limit.mode == Mode::contact ? "contact" : "sampled"}});
  }
  return facts;
}

Json lookAtDevices(const std::vector<uint32_t>& asked) {
  const std::vector<DeviceReport> all = listDevices();
  std::vector<uint32_t> numbers = asked;
  if (numbers.empty()) {
    for (uint32_t i = 0; i < all.size(); ++i) numbers.push_back(i);
  }
  Json devices = Json::array(), limits = Json::array();
  std::vector<std::string> reasons;
  size_t usable = 0;
  for (const uint32_t number : numbers) {
    const std::string name = "device " + std::to_string(number);
    if (std::count(numbers.begin(), numbers.end(), number) > 1) throw Error(name + " is named twice");
    if (number >= all.size()) throw Error(name + " does not exist: there are " + std::to_string(all.size()));
    const DeviceReport& device = all[number];
    Json facts = factsOf(number, device);
    for (const Json& limit : facts["limits"]) limits.emplace_back(Json{{"device", number}}).update(limit);
    facts.erase("limits");
    facts["reasons"] = joined(device.reasons);
    facts["sampled_reasons"] = joined(device.sampledReasons);
    devices.push_back(std::move(facts));
    for (const std::string& reason : device.reasons) reasons.push_back(name + ", " + device.name + ": " + reason);
    usable += device.usable();
  }
  if (usable == 0) throw Error("no usable Vulkan device", VK_SUCCESS, reasons);
  Json report =
      newReport("Cyber Radar: selftest",
                {{"minutes", 0.0}, {"seconds", 0.0}, {"right", false}, {"answers_checked", 0}, {"answers_wrong", 0}});
  setRows(report, "devices", "What the devices are", devices);
  setRows(report, "limits", "Their limits", limits);
  for (const SelftestPart& part : selftestParts()) {
    if (part.asks != SelftestPart::together || usable > 1) partOf(report, part.name, part.title);
  }
  return report;
}

void runSelftest(Json& report, double minutes, const std::function<void()>& onChange) {
  report["minutes"] = minutes;
  const Stopwatch stopwatch;
  const Deadline end(60 * minutes);
  const auto tell = [&] {
    report["seconds"] = stopwatch.lap().wall;
    conclude(report);
    onChange();
  };
  tell();
  std::vector<Device> devices;
  std::vector<Tested> tested;
  open(report, devices, tested);
  std::vector<uint32_t> numbers;
  for (const Tested& one : tested) numbers.push_back(one.number);
  double weights = 0;
  for (const SelftestPart& one : selftestParts()) weights += one.weight;
  for (const SelftestPart& one : selftestParts()) {
    const bool together = one.asks == SelftestPart::together;
    const Deadline deadline(end.left() * one.weight / weights);
    weights -= one.weight;
    if (together && devices.size() < 2) continue;
    Json& part = partOf(report, one.name);
    part["state"] = "running";
    tell();
    const Stopwatch own;
    bool whole = true, failed = false;
    const auto ask = [&](size_t first, size_t count, const Deadline& until) {
      Json rows = Json::array();
      try {
        whole &= one.measure(std::span(devices).subspan(first, count), std::span(numbers).subspan(first, count), until,
                             rows);
      } catch (const std::exception& error) {
        failed = true;
        part["note"] = "device " + std::to_string(numbers[first]) + ": " + wordsOf(error);
      }
      for (const Json& row : rows) {
        Json& added = part["rows"].emplace_back(Json::object());
        if (!together) added["device"] = numbers[first];
        added.update(row);
      }
    };
    if (together) {
      ask(0, devices.size(), deadline);
    } else {
      for (size_t i = 0; i < devices.size(); ++i) {
        if (one.asks == SelftestPart::eachSampled && !tested[i].sampled) continue;
        ask(i, 1, Deadline(deadline.left() / static_cast<double>(devices.size() - i)));
      }
    }
    part["state"] = failed ? "failed" : whole ? "done" : "cut short: the time was up";
    part["seconds"] = own.lap().wall;
    tell();
  }
}

void conclude(Json& report) {
  uint64_t checked = 0, wrong = 0;
  bool ended = true;
  std::string failed;
  for (const Json& part : report["parts"]) {
    ended = ended && part["state"] != "not begun" && part["state"] != "running";
    if (part["state"] == "failed" && failed.empty()) failed = ", part " + part["name"].get<std::string>() + " failed";
    for (const Json& row : part["rows"]) {
      checked += row.value("queries", uint64_t{0}) + row.value("batch", uint64_t{0});
      wrong += row.value("wrong", uint64_t{0}) + row.value("differ", uint64_t{0});
    }
  }
  const bool isWrong = wrong > 0 || !failed.empty();
  const std::optional<Race> best = raceOf(partOf(report, "throughput")["rows"]);
  report["answers_checked"] = checked;
  report["answers_wrong"] = wrong;
  report["right"] = ended && !isWrong;
  report["verdict"] = print("%s (%zu answers, %zu wrong%s)",
                            isWrong ? "WRONG"
                            : ended ? "RIGHT"
                                    : "UNFINISHED",
                            size_t{checked}, size_t{wrong}, failed.c_str()) +
                      (best && !isWrong ? speedText(*best) : "");
}

}  // namespace radar::tools
