// The report for programs: JSON, and tables of comma-separated values.
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/csv.h"
#include "selftest/selftest.h"

namespace radar::tools {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinities.
Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json jsonOf(const PartReport& part) {
  return {{"state", nameOf(part.state)}, {"note", part.note}, {"seconds", part.seconds}};
}

Json jsonOf(const std::vector<StageRow>& rows) {
  Json all = Json::array();
  for (const StageRow& row : rows) {
    all.push_back({{"workload", row.workload}, {"stage", row.stage}, {"us_per_query", row.us}});
  }
  return all;
}

Json jsonOf(const std::vector<LaneRow>& rows) {
  Json all = Json::array();
  for (const LaneRow& row : rows) {
    all.push_back({{"way", row.way}, {"us_per_query", row.us}, {"times_as_fast", row.times}});
  }
  return all;
}

Json jsonOf(const DeviceTest& device) {
  const DeviceReport& facts = device.facts;
  Json json{{"number", device.number},
            {"name", facts.name},
            {"type", facts.type},
            {"driver", facts.driver},
            {"vulkan", facts.version},
            {"memory_bytes", facts.memory},
            {"subgroup", facts.subgroup},
            {"has_doubles", facts.doubles},
            {"uses_doubles", device.usesDoubles},
            {"reasons", facts.reasons},
            {"sampled_reasons", facts.sampledReasons},
            {"right", device.right()},
            {"answers_checked", device.checkedAnswers()},
            {"answers_wrong", device.wrongAnswers()}};
  for (const DeviceLimit& limit : facts.limits) {
    json["limits"].push_back({{"name", limit.name},
                              {"needed", limit.needed},
                              {"has", limit.has},
                              {"mode", limit.mode == Mode::contact ? "contact" : "sampled"}});
  }
  for (const Part part : kParts) json["parts"][nameOf(part)] = jsonOf(device[part]);
  json["arithmetic"] = Json::array();
  for (const ArithmeticCheck& check : device.arithmetic) {
    json["arithmetic"].push_back({{"operation", check.operation},
                                  {"tried", check.tried},
                                  {"wrong", check.wrong},
                                  {"worst_ulps", finite(check.worst)},
                                  {"found", check.found},
                                  {"needed", check.needed},
                                  {"consequence", check.consequence}});
  }
  json["exactness"] = Json::array();
  for (const ExactnessRow& row : device.exactness) {
    const Tally& t = row.tally;
    json["exactness"].push_back({{"family", row.family},
                                 {"doubles", row.doubles},
                                 {"queries", t.queries},
                                 {"hits", t.hits},
                                 {"clear", t.clear},
                                 {"overlaps", t.overlaps},
                                 {"wrong", t.wrong},
                                 {"pairs", t.pairs},
                                 {"cpu_pairs", t.cpuPairs}});
  }
  json["throughput"] = Json::array();
  for (const ThroughputRow& row : device.throughput) {
    json["throughput"].push_back({{"workload", row.workload},
                                  {"batch", row.batch},
                                  {"device_us_per_query", row.deviceUs},
                                  {"cpu_us_per_query", row.cpuUs},
                                  {"differ", row.differ}});
  }
  json["stages"] = jsonOf(device.stages);
  json["lanes"] = jsonOf(device.lanes);
  json["passes"] = jsonOf(device.passes);
  return json;
}

std::string cellOf(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return bench::csvCell(value.get<bool>());
  if (value.is_number_float()) return bench::csvCell(value.get<double>());
  return value.dump();
}

// A line for each row of a part, as in the JSON: the device, `before`, the row's values.
std::string linesOf(const SelftestReport& report, Part part, const std::vector<std::string>& before = {}) {
  std::string text;
  for (const DeviceTest& device : report.devices) {
    const Json json = jsonOf(device);
    for (const Json& row : json[nameOf(part)]) {
      std::vector<std::string> cells{std::to_string(device.number)};
      cells.insert(cells.end(), before.begin(), before.end());
      for (const Json& value : row) cells.push_back(cellOf(value));
      text += bench::csvLine(cells);
    }
  }
  return text;
}

}  // namespace

std::string jsonOf(const SelftestReport& report) {
  Json json{{"command", report.command},     {"commit", report.commit},   {"date", report.date},
            {"processor", report.processor}, {"minutes", report.minutes}, {"seconds", report.seconds},
            {"right", report.right()},       {"devices", Json::array()}};
  for (const DeviceTest& device : report.devices) json["devices"].push_back(jsonOf(device));
  json["together"] = {{"part", jsonOf(report.togetherState)}, {"rows", jsonOf(report.together)}};
  return json.dump(2) + "\n";
}

std::string arithmeticCsv(const SelftestReport& report) {
  return "device,operation,tried,wrong,worst ulps,found,needed,consequence\n" + linesOf(report, Part::arithmetic);
}

std::string exactnessCsv(const SelftestReport& report) {
  return "device,family,doubles,queries,hits,clear,overlaps,wrong,pairs,cpu pairs\n" + linesOf(report, Part::exactness);
}

std::string throughputCsv(const SelftestReport& report) {
  return "device,workload,batch,device us,cpu us,differ\n" + linesOf(report, Part::throughput);
}

std::string stagesCsv(const SelftestReport& report) {
  return "device,mode,workload,stage,us\n" + linesOf(report, Part::stages, {"contact"}) +
         linesOf(report, Part::passes, {"sampled"});
}

}  // namespace radar::tools
