#include "selftest/selftest.h"

#include <algorithm>
#include <optional>

#include "radar/pool.h"
#include "selftest/measure.h"

namespace radar::tools {

namespace {

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
  const Stopwatch stopwatch;
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

// A device under test.
struct Test {
  Json& report;
  std::optional<Device> device{};
  bool failed = false;  ///< it could not be opened; the part that tried says why

  void run(const SelftestPart& part, const Deadline& deadline, const std::function<void()>& onChange) {
    Json& partReport = report["parts"][part.name];
    if (part.sampled && !report["sampled_reasons"].empty()) {
      partReport["state"] = "impossible";
      partReport["note"] = report["sampled_reasons"].front();
    } else if (!failed) {
      const auto work = [&](Json& rows) {
        const uint32_t number = report["number"];
        if (!device) device.emplace(Device::open({.index = number}));
        report["uses_doubles"] = device->doubles();
        return part.measure(*device, number, deadline, rows);
      };
      tools::run(partReport, work, onChange);
      failed = !device;
    }
  }
};

// The parts that take a share each. What one does not use is left to the next.
void measure(Test& test, double seconds, const std::function<void()>& onChange) {
  const Deadline end(seconds);
  double weights = 0;
  for (const SelftestPart& part : selftestParts()) weights += part.weight;
  for (const SelftestPart& part : selftestParts()) {
    if (part.weight == 0) continue;
    test.run(part, Deadline(end.left() * part.weight / weights), onChange);
    weights -= part.weight;
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
  Json report{{"verdict", ""},        {"command", ""},   {"commit", ""},
              {"date", ""},           {"processor", ""}, {"minutes", 0.0},
              {"seconds", 0.0},       {"right", false},  {"devices", Json::array()},
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
  std::vector<Test> tests;
  std::vector<uint32_t> numbers;
  for (Json& device : report["devices"]) {
    if (!device["usable"]) continue;
    tests.push_back({device});
    numbers.push_back(device["number"]);
  }
  // In the end, random queries take all that is left.
  const double all = 60 * minutes, forRest = 0.25 * all, forTogether = tests.size() > 1 ? 0.1 * all : 0;
  for (size_t i = 0; i < tests.size(); ++i) {
    measure(tests[i], (end.left() - forRest - forTogether) / static_cast<double>(tests.size() - i), tell);
  }
  Json& together = report["together"];
  if (tests.size() > 1) {
    const Deadline deadline(end.left() - forRest);
    run(
        together, [&](Json& rows) { return measureTogether(openDevices(numbers), numbers, deadline, rows); }, tell);
  } else {
    together["state"] = "impossible";
    together["note"] = "there is one usable device";
  }
  for (size_t i = 0; i < tests.size(); ++i) {
    const Deadline deadline(end.left() / static_cast<double>(tests.size() - i));
    for (const SelftestPart& part : selftestParts()) {
      if (part.weight == 0) tests[i].run(part, deadline, tell);
    }
  }
  tell();
}

}  // namespace radar::tools
