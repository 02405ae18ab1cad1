#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "selftest/selftest.h"

namespace radar::tools {

namespace {

// The single values, a line each.
std::string fieldsText(const Json& object, const std::string& indent) {
  std::string text;
  for (const auto& [name, value] : object.items()) {
    if (name == "verdict" || value.is_object() || (value.is_string() && value.get<std::string>().empty())) continue;
    const Json values = value.is_array() ? value : Json::array({value});
    for (const Json& one : values) {
      if (one.is_object()) continue;
      text += indent + name + ": " + cellText(one) + "\n";
    }
  }
  return text;
}

std::string titleOf(const Json& device) {
  return "device " + device["number"].dump() + ": " + device["name"].get<std::string>();
}

std::string stateText(const Json& part) {
  const std::string state = part["state"], note = part["note"];
  return print("%s, %.1f s", state.c_str(), part["seconds"].get<double>()) + (note.empty() ? "" : ": " + note);
}

// Before its end, a report is read only if the selftest was interrupted.
std::string verdictText(const Json& device) {
  const Json& parts = device["parts"];
  const std::string counts =
      device["answers_checked"].dump() + " answers checked, " + device["answers_wrong"].dump() + " wrong: ";
  if (device["right"]) return counts + "nothing is wrong";
  const bool failed =
      std::any_of(parts.begin(), parts.end(), [](const Json& part) { return part["state"] == "failed"; });
  if (failed || device["answers_wrong"] > 0) return counts + "SOMETHING IS WRONG";
  return counts + "interrupted when " + device["parts_ended"].dump() + " of " + std::to_string(parts.size()) +
         " parts had ended";
}

std::string partText(const std::string& name, const Json& part) {
  return "\n  " + name + ": " + stateText(part) + "\n" + textOf(part["rows"], "    ");
}

void addRows(Json& table, const Json& device, const char* part, const Json& before = Json::object()) {
  for (const Json& row : device["parts"][part]["rows"]) {
    Json& added = table.emplace_back(Json{{"device", device["number"]}});
    added.update(before);
    added.update(row);
  }
}

constexpr const char* kPageHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Cyber Radar selftest</title><style>
body{max-width:1200px;margin:24px auto;padding:0 16px;font:16px/1.5 system-ui,sans-serif}
table{display:block;overflow-x:auto;border-collapse:collapse;font-size:.92rem;font-variant-numeric:tabular-nums}
th,td{padding:3px 14px 3px 4px;text-align:left;border-bottom:1px solid #ddd}
.bar{min-width:14em;background:linear-gradient(90deg,#9ecae9 var(--share),transparent var(--share))}
</style></head><body>
<h1>Cyber Radar: selftest</h1>
)";

struct Section {
  const char *part, *title;
  std::string_view bars;  // columns whose names end so have bars behind their numbers
};

constexpr Section kSections[] = {
    {"arithmetic", "Arithmetic, on which the bounds rest", {}},
    {"answers", "Known queries of every kind, those of a renderer's frames among them", {}},
    {"exactness", "Random queries of every family, compared with the CPU's answers", {}},
    {"throughput", "Throughput of the device, and of all cores of the CPU, in queries per second", "_per_second"},
    {"stages", "Stages of mode contact, batches of 16,384", "us_per_query"},
    {"lanes", "Batches in flight", "times_as_fast"},
    {"passes", "Passes of mode sampled", "us_per_query"},
    {"together", "All devices together", "times_as_fast"}};

std::string element(const std::string& tag, const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return "<" + tag + ">" + escaped + "</" + tag + ">\n";
}

// `bars`: as Section::bars. The longest bar of each workload fills its cell.
std::string tableElement(const Json& table, std::string_view bars = {}) {
  if (table.empty()) return "";
  const auto hasBar = [&](std::string_view column, const Json& value) {
    return !bars.empty() && column.ends_with(bars) && value.is_number() && std::isfinite(value.get<double>());
  };
  std::map<std::string, double> greatest;
  for (const Json& row : table) {
    double& most = greatest[row.value("workload", "")];
    for (const auto& [name, value] : row.items()) {
      if (hasBar(name, value)) most = std::max(most, value.get<double>());
    }
  }
  std::string text = "<table><tr>\n";
  for (const auto& item : table.front().items()) {
    std::string name = item.key();
    std::replace(name.begin(), name.end(), '_', ' ');
    text += element("th", name);
  }
  for (const Json& row : table) {
    text += "<tr>\n";
    for (const auto& [name, value] : row.items()) {
      const double most = greatest[row.value("workload", "")];
      const std::string share = hasBar(name, value) ? print("%.1f%%", 100 * value.get<double>() / most) : "";
      text += share.empty() ? element("td", cellText(value))
                            : "<td class=\"bar\" style=\"--share:" + share + "\">" + cellText(value) + "</td>\n";
    }
  }
  return text + "</table>\n";
}

std::string folded(const std::string& title, const std::string& content) {
  return "<details>" + element("summary", title) + content + "</details>\n";
}

// Bars of rates can be compared over all sizes of batches; those of microseconds would vanish beside the batch of one.
Json ratesOf(const Json& throughput) {
  Json rates = Json::array();
  const auto perSecond = [](const Json& us) { return 1e6 / us.get<double>(); };
  for (const Json& row : throughput) {
    rates.push_back({{"workload", row["workload"]},
                     {"batch", row["batch"]},
                     {"device_per_second", perSecond(row["device_us_per_query"])},
                     {"cpu_per_second", perSecond(row["cpu_us_per_query"])},
                     {"cpu_over_device", row["cpu_over_device"]},
                     {"differ", row["differ"]}});
  }
  return rates;
}

std::string sectionElement(const std::string& name, const Json& part) {
  const auto section =
      std::find_if(std::begin(kSections), std::end(kSections), [&](const Section& one) { return one.part == name; });
  if (section == std::end(kSections)) throw std::logic_error("the page has no section for the part " + name);
  return folded(section->title + (": " + stateText(part)),
                tableElement(name == "throughput" ? ratesOf(part["rows"]) : part["rows"], section->bars));
}

std::string selftestPage(const Json& report) {
  std::string text = kPageHead + element("p", report["verdict"]) + element("pre", fieldsText(report, ""));
  for (const Json& device : report["devices"]) {
    text += element("h2", titleOf(device)) + (device["usable"] ? element("b", verdictText(device)) : "") +
            folded("What it is", element("pre", fieldsText(device, "")) + tableElement(device["limits"]));
    if (!device["usable"]) continue;
    for (const auto& [name, part] : device["parts"].items()) text += sectionElement(name, part);
  }
  return text + sectionElement("together", report["together"]) + "</body></html>\n";
}

}  // namespace

std::string selftestSummary(const Json& report) {
  std::string text = report["verdict"].get<std::string>() + "\n";
  for (const Json& device : report["devices"]) {
    text += "\n" + titleOf(device) + (device["usable"] ? "\n  " + verdictText(device) : ": not usable") + "\n";
    if (!device["usable"]) continue;
    for (const auto& [name, part] : device["parts"].items()) text += "  " + name + ": " + stateText(part) + "\n";
  }
  if (report["together"]["state"] == "impossible") return text;
  return text + "\nall devices together: " + stateText(report["together"]) + "\n";
}

std::string selftestText(const Json& report) {
  std::string text = selftestSummary(report) + "\n" + fieldsText(report, "");
  for (const Json& device : report["devices"]) {
    text += "\n" + titleOf(device) + "\n" + fieldsText(device, "  ") + textOf(device["limits"], "    ");
    if (!device["usable"]) continue;
    for (const auto& [name, part] : device["parts"].items()) text += partText(name, part);
  }
  return text + partText("all devices together", report["together"]);
}

std::map<std::string, std::string> selftestFiles(const Json& report) {
  std::map<std::string, Json> tables;
  for (const Json& device : report["devices"]) {
    for (const char* part : {"arithmetic", "answers", "exactness", "throughput"}) addRows(tables[part], device, part);
    addRows(tables["stages"], device, "stages", {{"mode", "contact"}});
    addRows(tables["stages"], device, "passes", {{"mode", "sampled"}});
  }
  std::map<std::string, std::string> files{{"index.html", selftestPage(report)},
                                           {"report.json", report.dump(2) + "\n"},
                                           {"report.txt", selftestText(report)}};
  for (const auto& [name, table] : tables) files[name + ".csv"] = csvOf(table);
  return files;
}

}  // namespace radar::tools
