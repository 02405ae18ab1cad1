#include "measure/selftest.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace radar::tools {

namespace {

// Batches of sizes that follow each other, of one workload, in which the same side is faster.
struct Run {
  bool isDevices;
  uint64_t least, most;     ///< sizes
  double slowest, fastest;  ///< how many times as fast as the other side
  double crossover;         ///< the size from which on it is; 0: for all that is known
};

// Where the line through both, in logarithms, has the ratio 1.
double crossoverOf(const std::pair<const uint64_t, double>& before, const std::pair<const uint64_t, double>& after) {
  const double way = std::log(before.second) / std::log(before.second / after.second);
  const double from = std::log(static_cast<double>(before.first)), to = std::log(static_cast<double>(after.first));
  return std::exp(from + way * (to - from));
}

std::vector<Run> runsOf(const std::map<uint64_t, double>& times) {
  std::vector<Run> runs;
  for (auto it = times.begin(); it != times.end(); ++it) {
    const auto& [size, cpuOverDevice] = *it;
    const bool isDevices = cpuOverDevice > 1;
    const double factor = isDevices ? cpuOverDevice : 1 / cpuOverDevice;
    if (runs.empty() || runs.back().isDevices != isDevices) {
      runs.push_back({isDevices, size, size, factor, factor, runs.empty() ? 0 : crossoverOf(*std::prev(it), *it)});
    }
    Run& run = runs.back();
    run.most = size;
    run.slowest = std::min(run.slowest, factor);
    run.fastest = std::max(run.fastest, factor);
  }
  return runs;
}

// Who is faster in batches of which size, and where that changes, by the table of part throughput: a line for each run.
Json raceLines(const Json& throughput) {
  std::map<std::pair<uint32_t, std::string>, std::map<uint64_t, double>> races;
  for (const Json& row : throughput) races[{row["device"], row["workload"]}][row["batch"]] = row["cpu_over_device"];
  Json lines = Json::array();
  for (const auto& [race, times] : races) {
    const std::vector<Run> runs = runsOf(times);
    for (const Run& run : runs) {
      std::string line =
          "device " + std::to_string(race.first) + ", " + race.second + ", batches of " + std::to_string(run.least);
      if (run.most != run.least) line += " to " + std::to_string(run.most);
      line += std::string(": the ") + (run.isDevices ? "device" : "CPU") + " is " + print("%.3g", run.slowest);
      if (run.most != run.least) line += " to " + print("%.3g", run.fastest);
      line += " times as fast";
      if (run.crossover > 0) line += print(", from some %.0f on", run.crossover);
      lines.push_back(line);
    }
  }
  return lines;
}

// What is wrong, a line for each row that tells of any.
Json faultLines(const Json& report) {
  Json lines = Json::array();
  for (const Json& part : report["parts"]) {
    for (const Json& row : part["rows"]) {
      const uint64_t wrong = row.value("wrong", uint64_t{0}) + row.value("differ", uint64_t{0});
      if (wrong == 0) continue;
      std::string line = part["name"].get<std::string>() + ", device " + row["device"].dump();
      for (const char* name : {"kind", "family", "workload"}) {
        if (row.contains(name)) line += ", " + row[name].get<std::string>();
      }
      line += ": " + std::to_string(wrong) + " answers differ from the CPU's";
      if (row.contains("stage")) line += ", in " + row["stage"].get<std::string>();
      if (row.contains("first_wrong")) line += "; " + row["first_wrong"].get<std::string>();
      lines.push_back(line);
    }
  }
  return lines;
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
  report["answers_checked"] = checked;
  report["answers_wrong"] = wrong;
  report["right"] = ended && !isWrong;
  report["verdict"] = print("%s (%zu answers, %zu wrong%s)",
                            isWrong ? "WRONG"
                            : ended ? "RIGHT"
                                    : "UNFINISHED",
                            size_t{checked}, size_t{wrong}, failed.c_str());
  report["findings"] = isWrong ? faultLines(report) : raceLines(partOf(report, "throughput")["rows"]);
}

}  // namespace radar::tools
