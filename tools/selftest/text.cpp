#include <cmath>

#include "report/print.h"
#include "selftest/selftest.h"

namespace radar::tools {

namespace {

unsigned long long number(uint64_t value) {
  return value;
}

std::string stateText(const PartReport& part) {
  std::string text = nameOf(part.state);
  if (part.state == PartState::running) text += " when this was written";
  if (!part.note.empty()) text += ": " + part.note;
  return part.seconds > 0 ? text + print(", %.1f s", part.seconds) : text;
}

std::string head(const DeviceTest& device, Part part) {
  return print("\n  %s: %s\n", nameOf(part), stateText(device[part]).c_str());
}

std::string arithmeticText(const DeviceTest& device) {
  std::string text = head(device, Part::arithmetic);
  for (const ArithmeticCheck& check : device.arithmetic) {
    text +=
        print("    %-48s %s %s\n", check.operation.c_str(), check.passed() ? "right:" : "WRONG:", check.found.c_str());
    text += "      ";
    if (!std::isnan(check.worst)) text += print("worst %.3g ulp; ", check.worst);
    if (!check.needed.empty()) text.append("needed: ").append(check.needed).append("; so ");
    text.append(check.consequence).append("\n");
  }
  return text;
}

std::string exactnessText(const DeviceTest& device) {
  std::string text = head(device, Part::exactness);
  if (device.exactness.empty()) return text;
  text += print("    %-14s %-8s %9s %9s %9s %9s %6s %12s %12s\n", "family", "doubles", "queries", "hit", "clear",
                "overlap", "wrong", "pairs", "by the CPU");
  for (const ExactnessRow& row : device.exactness) {
    const Tally& t = row.tally;
    text += print("    %-14s %-8s %9llu %9llu %9llu %9llu %6llu %12llu %12llu\n", row.family.c_str(),
                  row.doubles ? "with" : "without", number(t.queries), number(t.hits), number(t.clear),
                  number(t.overlaps), number(t.wrong), number(t.pairs), number(t.cpuPairs));
  }
  return text;
}

std::string throughputText(const DeviceTest& device) {
  std::string text = head(device, Part::throughput);
  if (device.throughput.empty()) return text;
  text += print("    %-9s %9s %14s %14s %14s %9s %8s\n", "workload", "batch", "device us", "CPU us", "device 1/s",
                "CPU/dev.", "differ");
  for (const ThroughputRow& row : device.throughput) {
    text += print("    %-9s %9llu %14.3f %14.3f %14.0f %9.2f %8llu\n", row.workload.c_str(), number(row.batch),
                  row.deviceUs, row.cpuUs, 1e6 / row.deviceUs, row.cpuUs / row.deviceUs, number(row.differ));
  }
  return text;
}

std::string stagesText(const std::vector<StageRow>& rows) {
  std::string text;
  for (const StageRow& row : rows) {
    text += print("    %-30s %-28s %10.3f us a query\n", row.workload.c_str(), row.stage.c_str(), row.us);
  }
  return text;
}

std::string lanesText(const std::vector<LaneRow>& rows) {
  std::string text;
  for (const LaneRow& row : rows) {
    text += print("    %-40s %10.3f us a query, %.2f times as fast as the first\n", row.way.c_str(), row.us, row.times);
  }
  return text;
}

}  // namespace

std::string factsOf(const DeviceTest& device) {
  const DeviceReport& facts = device.facts;
  std::string text = print("device %u: %s (%s), driver %s\n", device.number, facts.name.c_str(), facts.type.c_str(),
                           facts.driver.c_str());
  text += print("  Vulkan %s, %.1f GiB of its own, subgroups of %u, %s\n", facts.version.c_str(),
                static_cast<double>(facts.memory) / (1 << 30), facts.subgroup,
                !facts.doubles       ? "no doubles"
                : device.usesDoubles ? "doubles, which are used"
                                     : "doubles, which are not used");
  for (const std::string& reason : facts.reasons) text += "  not usable: " + reason + "\n";
  for (const std::string& reason : facts.sampledReasons) text += "  no mode sampled: " + reason + "\n";
  for (const DeviceLimit& limit : facts.limits) {
    text += print("  %-36s %12llu, needed %10llu for mode %s\n", limit.name.c_str(), number(limit.has),
                  number(limit.needed), limit.mode == Mode::contact ? "contact" : "sampled");
  }
  return text;
}

std::string textOf(const SelftestReport& report) {
  std::string text = "Cyber Radar selftest, commit " + report.commit + ", " + report.date + "\n" + report.command +
                     "\n" + report.processor + print("; %.1f of %.1f minutes\n", report.seconds / 60, report.minutes);
  for (const DeviceTest& device : report.devices) {
    text += "\n" + factsOf(device);
    if (!device.facts.usable()) continue;
    text += arithmeticText(device) + exactnessText(device) + throughputText(device);
    text += head(device, Part::stages) + stagesText(device.stages);
    text += head(device, Part::lanes) + lanesText(device.lanes);
    text += head(device, Part::passes) + stagesText(device.passes);
    text +=
        print("\n  device %u: %llu answers checked, %llu wrong: %s\n", device.number, number(device.checkedAnswers()),
              number(device.wrongAnswers()), device.right() ? "nothing is wrong" : "SOMETHING IS WRONG");
  }
  return text + "\nall devices together: " + stateText(report.togetherState) + "\n" + lanesText(report.together);
}

}  // namespace radar::tools
