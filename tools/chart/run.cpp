#include "chart/run.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>

#include "report/tables.h"

namespace radar::tools {

namespace {

// Values without padding.
template <class... Values>
void append(std::string& bytes, const Values&... values) {
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
}

template <class Value>
void appendAll(std::string& bytes, const std::vector<Value>& values) {
  append(bytes, values.size());
  for (const Value& value : values) append(bytes, value);
}

void appendWorkload(std::string& bytes, const Workload& workload) {
  for (const MeshData& mesh : workload.meshes) {
    appendAll(bytes, mesh.positions);
    appendAll(bytes, mesh.indices);
  }
  for (const SceneSpec& scene : workload.scenes) {
    append(bytes, scene.base.value_or(kNone));
    for (const Instance& instance : scene.instances) append(bytes, instance.mesh, instance.worldFromMesh.m);
    appendAll(bytes, scene.masks);
  }
  for (const QuerySpec& query : workload.queries) {
    append(bytes, query.scene, query.batch, query.sensor.mesh, query.sensor.worldFromMesh.m, query.direction,
           query.distance, query.mask);
    appendAll(bytes, query.exclude);
  }
}

// A full run measures all sizes, on one thread and on all; others three sizes, on all where the library can.
std::vector<Method> peerMethods(const BaselineRow& row, const std::string& section, const RunSettings& settings) {
  const auto has = [](const auto& values, const auto& value) {
    return std::find(values.begin(), values.end(), value) != values.end();
  };
  const bool full = settings.extent == Extent::full;
  if (!has(row.sections, section) || (section == "growth" && !full)) return {};
  std::vector<uint32_t> sizes = row.sizes;
  if (section != "front") {
    sizes = {has(sizes, kGrowthSize) ? kGrowthSize : sizes.front()};
  } else if (!full && sizes.size() > 1) {
    sizes = {16, 64, 256};
  }
  if (settings.extent == Extent::least) sizes.resize(1);
  std::vector<Method> methods;
  for (const uint32_t size : sizes) {
    const uint32_t most = row.threads ? settings.threads : 1;
    if (full || most == 1) methods.push_back({row.family, size, 1});
    if (most > 1) methods.push_back({row.family, size, most});
  }
  return methods;
}

bench::Repetition repetitionOf(Extent extent) {
  if (extent == Extent::full) return {.least = 5, .most = kNone, .seconds = 0.2};
  if (extent == Extent::quick) return {.least = 3, .most = kNone, .seconds = 0.03};
  return {.least = 1, .most = 1};
}

}  // namespace

std::string fingerprintOf(const RunSettings& settings, const std::string& origin) {
  // Where a dynamic linker was asked to run the program, this file is the linker: then `origin` tells programs apart.
  std::ifstream program("/proc/self/exe", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(program), {}};
  bytes += origin + print("/%d/%u", int(settings.extent), settings.threads);
  for (const Case& which : settings.cases) {
    bytes += which.section + "/" + which.name;
    appendWorkload(bytes, which.workload);
  }
  return print("%016zx", std::hash<std::string>()(bytes));
}

std::vector<Planned> planOf(const RunSettings& settings, const std::vector<BaselineRow>& rows) {
  std::vector<Planned> plan;
  for (const Case& which : settings.cases) {
    for (Method& method : ownMethods(which.section, settings.extent, settings.threads)) {
      plan.push_back({&which, std::move(method), nullptr});
    }
    for (const BaselineRow& row : rows) {
      for (Method& method : peerMethods(row, which.section, settings))
        plan.push_back({&which, std::move(method), &row});
    }
  }
  return plan;
}

Record measureAll(const RunSettings& settings, const std::vector<Planned>& plan, Record record, const Device& device,
                  const std::filesystem::path& folder, const std::function<void()>& step) {
  std::optional<Record> before = readRecord(folder);
  if (before && before->values("run") == record.values("run")) record.cells = std::move(before->cells);
  std::unique_ptr<Bench> bench;
  for (size_t i = 0; i < plan.size(); ++i) {
    const Planned& planned = plan[i];
    step();
    if (i < record.cells.size()) continue;
    if (!bench || &bench->which() != planned.which) {
      bench = std::make_unique<Bench>(*planned.which, device, repetitionOf(settings.extent));
    }
    record.cells.push_back(bench->measure(planned.method, planned.row));
    writeRecord(folder, record);
  }
  return record;
}

}  // namespace radar::tools
