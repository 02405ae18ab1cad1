#include "chart/run.h"

#include <algorithm>
#include <fstream>
#include <iterator>

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
    append(bytes, query.scene, query.batch, query.mesh, query.worldFromMesh.m, query.direction, query.distance,
           query.mask);
    appendAll(bytes, query.exclude);
  }
}

// Pixels, rays or steps outside of section front.
constexpr uint32_t kGrowthSize = 64;

std::vector<uint32_t> resolutions(Extent extent) {
  if (extent == Extent::full) return {16, 32, 64, 128, 256, 512, 1024};
  if (extent == Extent::quick) return {16, 64, 256};
  return {64, 256};
}

std::vector<ChartMethod> ownMethods(const std::string& section, Extent extent, uint32_t threads) {
  std::vector<ChartMethod> methods;
  if (section == "front") {
    for (const uint32_t resolution : resolutions(extent)) methods.push_back({"sampled", resolution});
  } else {
    if (section == "table1") methods.push_back({"drawing all", kGrowthSize});
    methods.push_back({"sampled", kGrowthSize});
  }
  methods.push_back({"contact"});
  methods.push_back({"contact on device"});
  methods.push_back({"reference", 0, 1});
  if (threads > 1) methods.push_back({"reference", 0, threads});
  return methods;
}

template <class Values, class Value>
bool has(const Values& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

std::vector<uint32_t> sizesOf(const BaselineRow& row, const std::string& section, bool full) {
  if (section != "front") return {has(row.sizes, kGrowthSize) ? kGrowthSize : row.sizes.front()};
  if (!full && row.sizes.size() > 1) return {16, 64, 256};
  return row.sizes;
}

// A full run measures all sizes, on one thread and on all; others three sizes, on all where the library can.
std::vector<ChartMethod> peerMethods(const BaselineRow& row, const std::string& section, const RunSettings& settings) {
  const bool full = settings.extent == Extent::full;
  if (!has(row.sections, section) || (section == "growth" && !full)) return {};
  std::vector<uint32_t> sizes = sizesOf(row, section, full);
  if (settings.extent == Extent::least) sizes.resize(1);
  std::vector<ChartMethod> methods;
  for (const uint32_t size : sizes) {
    const uint32_t most = row.threads ? settings.threads : 1;
    if (full || most == 1) methods.push_back({row.family, size, 1, &row});
    if (most > 1) methods.push_back({row.family, size, most, &row});
  }
  return methods;
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

std::vector<ChartMethod> methodsOf(const std::string& section, const RunSettings& settings) {
  std::vector<ChartMethod> methods = ownMethods(section, settings.extent, settings.threads);
  for (const BaselineRow& row : settings.baselines) {
    for (ChartMethod& method : peerMethods(row, section, settings)) methods.push_back(std::move(method));
  }
  return methods;
}

}  // namespace radar::tools
