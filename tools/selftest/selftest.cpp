#include "selftest/selftest.h"

#include <algorithm>
#include <optional>

#include "radar/pool.h"
#include "selftest/measure.h"

namespace radar::tools {

const char* nameOf(Part part) {
  constexpr std::array kNames{"arithmetic", "exactness", "throughput", "stages", "lanes", "passes"};
  static_assert(kNames.size() == kParts.size());
  return kNames[static_cast<size_t>(part)];
}

const char* nameOf(PartState state) {
  constexpr std::array kNames{"not begun", "running", "done", "cut short: the time was up", "failed", "impossible"};
  return kNames[static_cast<size_t>(state)];
}

uint64_t DeviceTest::wrongAnswers() const {
  uint64_t wrong = 0;
  for (const ExactnessRow& row : exactness) wrong += row.tally.wrong;
  for (const ThroughputRow& row : throughput) wrong += row.differ;
  return wrong;
}

uint64_t DeviceTest::checkedAnswers() const {
  uint64_t checked = 0;
  for (const ExactnessRow& row : exactness) checked += row.tally.queries;
  for (const ThroughputRow& row : throughput) checked += row.batch;
  return checked;
}

bool DeviceTest::right() const {
  const bool failed =
      std::any_of(parts.begin(), parts.end(), [](const PartReport& part) { return part.state == PartState::failed; });
  return wrongAnswers() == 0 && !failed;
}

bool SelftestReport::right() const {
  return togetherState.state != PartState::failed &&
         std::all_of(devices.begin(), devices.end(), [](const DeviceTest& device) { return device.right(); });
}

void lookAtDevices(const SelftestSettings& settings, SelftestReport& report) {
  report.minutes = settings.minutes;
  const std::vector<DeviceReport> all = listDevices();
  std::vector<uint32_t> numbers = settings.devices;
  if (numbers.empty()) {
    for (uint32_t i = 0; i < all.size(); ++i) numbers.push_back(i);
  }
  std::vector<std::string> reasons;
  bool isSomeUsable = false;
  for (const uint32_t number : numbers) {
    if (std::count(numbers.begin(), numbers.end(), number) > 1) {
      throw Error("device " + std::to_string(number) + " is named twice");
    }
    if (number >= all.size()) {
      throw Error("device " + std::to_string(number) + " does not exist: there are " + std::to_string(all.size()));
    }
    DeviceTest& device = report.devices.emplace_back();
    device.number = number;
    device.facts = all[number];
    isSomeUsable = isSomeUsable || device.facts.usable();
    for (const std::string& reason : device.facts.reasons) {
      reasons.push_back("device " + std::to_string(number) + ", " + device.facts.name + ": " + reason);
    }
  }
  if (!isSomeUsable) throw Error("no usable Vulkan device", VK_SUCCESS, reasons);
}

namespace {

struct Step {
  Part part;
  double weight;  // share of the device's time that is left
  bool (*measure)(const Device& device, const Deadline& deadline, DeviceTest& test);
};

constexpr Step kSteps[] = {
    {Part::arithmetic, 0.02, measureArithmetic}, {Part::exactness, 0.3, measureExactness},
    {Part::throughput, 0.45, measureThroughput}, {Part::stages, 0.05, measureStages},
    {Part::lanes, 0.08, measureLanes},           {Part::passes, 0.1, measurePasses},
};

// Runs one part, and keeps its state.
void run(PartReport& part, const std::function<bool()>& work, const std::function<void()>& onChange) {
  part.state = PartState::running;
  onChange();
  const bench::Stopwatch stopwatch;
  try {
    part.state = work() ? PartState::done : PartState::cut;
  } catch (const Error& error) {
    part.state = PartState::failed;
    part.note = error.what();
    for (const std::string& reason : error.reasons) part.note += "; " + reason;
  } catch (const std::exception& error) {
    part.state = PartState::failed;
    part.note = error.what();
  }
  part.seconds = stopwatch.lap().wall;
  onChange();
}

void testDevice(DeviceTest& test, double seconds, const std::function<void()>& onChange) {
  const Deadline end(seconds);
  std::optional<Device> device;
  double weights = 1;
  for (const auto& [part, weight, measure] : kSteps) {
    const Deadline deadline(end.left() * weight / weights);
    weights -= weight;
    if (part == Part::passes && !test.facts.sampledReasons.empty()) {
      test[part] = {PartState::impossible, test.facts.sampledReasons.front(), 0};
      continue;
    }
    const auto work = [&, measure = measure] {
      if (!device) device.emplace(Device::open({.index = test.number}));
      test.usesDoubles = device->doubles();
      return measure(*device, deadline, test);
    };
    run(test[part], work, onChange);
    if (!device) return;  // it could not be opened; the part says why
  }
}

}  // namespace

void runSelftest(SelftestReport& report, const std::function<void()>& onChange) {
  const bench::Stopwatch stopwatch;
  const Deadline end(60 * report.minutes);
  const auto tell = [&] {
    report.seconds = stopwatch.lap().wall;
    onChange();
  };
  tell();
  std::vector<DeviceTest*> usable;
  for (DeviceTest& device : report.devices) {
    if (device.facts.usable()) usable.push_back(&device);
  }
  const double forTogether = usable.size() > 1 ? 0.1 * 60 * report.minutes : 0;
  for (size_t i = 0; i < usable.size(); ++i) {
    testDevice(*usable[i], (end.left() - forTogether) / static_cast<double>(usable.size() - i), tell);
  }
  if (usable.size() < 2) {
    report.togetherState = {PartState::impossible, "there is one usable device", 0};
    return tell();
  }
  run(
      report.togetherState,
      [&] {
        std::vector<uint32_t> numbers;
        numbers.reserve(usable.size());
        for (const DeviceTest* device : usable) numbers.push_back(device->number);
        return measureTogether(openDevices(numbers), numbers, end, report.together);
      },
      tell);
}

}  // namespace radar::tools
