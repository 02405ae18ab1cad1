#include "selftest/selftest.h"

#include <algorithm>
#include <optional>

#include "bench/clock.h"
#include "radar/pool.h"
#include "selftest/measure.h"

namespace radar::tools {

namespace {

using bench::Deadline;

Json newPart() {
  return {{"state", "not begun"}, {"note", ""}, {"seconds", 0.0}, {"rows", Json::array()}};
}

// All keys are there from the start, so that no reference to a value becomes invalid.
Json newDevice(uint32_t number, const DeviceReport& report) {
  Json device = factsOf(number, report);
  device.update({{"uses_doubles", false},
                 {"answers_checked", 0},
                 {"answers_wrong", 0},
                 {"parts_ended", 0},
                 {"right", false},
                 {"parts", Json::object()}});
  for (const SelftestPart& part : selftestParts()) device["parts"][part.name] = newPart();
  return device;
}

// Runs one part, and keeps its state.
void run(Json& part, const std::function<bool(Json&)>& work, const std::function<void()>& onChange) {
  part["state"] = "running";
  onChange();
  const bench::Stopwatch stopwatch;
  try {
    part["state"] = work(part["rows"]) ? "done" : "cut short: the time was up";
  } catch (const std::exception& error) {
    std::string note = error.what();
    if (const auto* own = dynamic_cast<const Error*>(&error)) {
      for (const std::string& reason : own->reasons) note += "; " + reason;
    }
    part["state"] = "failed";
    part["note"] = note;
  }
  part["seconds"] = stopwatch.lap().wall;
  onChange();
}

void testDevice(Json& test, double seconds, const std::function<void()>& onChange) {
  const Deadline end(seconds);
  std::optional<Device> device;
  double weights = 1;
  for (const SelftestPart& part : selftestParts()) {
    const Deadline deadline(end.left() * part.weight / weights);
    weights -= part.weight;
    Json& report = test["parts"][part.name];
    if (part.sampled && !test["sampled_reasons"].empty()) {
      report["state"] = "impossible";
      report["note"] = test["sampled_reasons"].front();
      continue;
    }
    const auto work = [&](Json& rows) {
      const uint32_t number = test["number"];
      if (!device) device.emplace(Device::open({.index = number}));
      test["uses_doubles"] = device->doubles();
      return part.measure(*device, number, deadline, rows);
    };
    run(report, work, onChange);
    if (!device) return;  // it could not be opened; the part says why
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
  Json report{{"command", ""},        {"commit", ""},   {"date", ""},     {"processor", ""},
              {"minutes", 0.0},       {"seconds", 0.0}, {"right", false}, {"devices", Json::array()},
              {"together", newPart()}};
  std::vector<std::string> reasons;
  for (const uint32_t number : numbers) {
    if (std::count(numbers.begin(), numbers.end(), number) > 1) {
      throw Error("device " + std::to_string(number) + " is named twice");
    }
    if (number >= all.size()) {
      throw Error("device " + std::to_string(number) + " does not exist: there are " + std::to_string(all.size()));
    }
    report["devices"].push_back(newDevice(number, all[number]));
    for (const std::string& reason : all[number].reasons) {
      reasons.push_back("device " + std::to_string(number) + ", " + all[number].name + ": " + reason);
    }
  }
  const Json& devices = report["devices"];
  if (std::none_of(devices.begin(), devices.end(), [](const Json& device) { return device["usable"].get<bool>(); })) {
    throw Error("no usable Vulkan device", VK_SUCCESS, reasons);
  }
  return report;
}

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
}

void runSelftest(Json& report, double minutes, const std::function<void()>& onChange) {
  report["minutes"] = minutes;
  const bench::Stopwatch stopwatch;
  const Deadline end(60 * minutes);
  const auto tell = [&] {
    report["seconds"] = stopwatch.lap().wall;
    conclude(report);
    onChange();
  };
  tell();
  std::vector<Json*> usable;
  std::vector<uint32_t> numbers;
  for (Json& device : report["devices"]) {
    if (!device["usable"]) continue;
    usable.push_back(&device);
    numbers.push_back(device["number"]);
  }
  const double forTogether = usable.size() > 1 ? 0.1 * 60 * minutes : 0;
  for (size_t i = 0; i < usable.size(); ++i) {
    testDevice(*usable[i], (end.left() - forTogether) / static_cast<double>(usable.size() - i), tell);
  }
  Json& together = report["together"];
  if (usable.size() < 2) {
    together["state"] = "impossible";
    together["note"] = "there is one usable device";
    return tell();
  }
  run(
      together, [&](Json& rows) { return measureTogether(openDevices(numbers), numbers, end, rows); }, tell);
}

}  // namespace radar::tools
