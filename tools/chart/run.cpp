#include "chart/run.h"

#include <link.h>

#include <algorithm>
#include <memory>
#include <span>

#include "report/print.h"

namespace radar::tools {

namespace {

// FNV-1a: G. Fowler, L. C. Noll, K.-P. Vo.
class Fingerprint {
 public:
  void add(const void* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) {
      value_ = (value_ ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001b3ull;
    }
  }
  void add(const std::string& text) { add(text.c_str(), text.size() + 1); }
  template <class Value>
  void addAll(const std::vector<Value>& values) {
    const size_t size = values.size();
    add(&size, sizeof size);
    add(values.data(), size * sizeof(Value));
  }
  void add(const Instance& instance) {
    add(&instance.mesh, sizeof instance.mesh);
    add(instance.worldFromMesh.m.data(), sizeof instance.worldFromMesh.m);
  }
  std::string text() const { return print("%016llx", static_cast<unsigned long long>(value_)); }

 private:
  uint64_t value_ = 0xcbf29ce484222325ull;
};

std::string fingerprintOf(const Workload& workload) {
  Fingerprint all;
  for (const MeshData& mesh : workload.meshes) {
    all.addAll(mesh.positions);
    all.addAll(mesh.indices);
  }
  for (const SceneSpec& scene : workload.scenes) {
    const uint32_t base = scene.base.value_or(kNone);
    all.add(&base, sizeof base);
    for (const Instance& instance : scene.instances) all.add(instance);
    for (const ObjectMask& mask : scene.masks) all.add(&mask, sizeof mask);
  }
  for (const QuerySpec& query : workload.queries) {
    all.add(&query.scene, sizeof query.scene);
    all.add(&query.batch, sizeof query.batch);
    all.add(query.sensor);
    all.addAll(query.exclude);
    all.add(query.direction.data(), sizeof query.direction);
    all.add(&query.distance, sizeof query.distance);
    all.add(&query.mask, sizeof query.mask);
  }
  return all.text();
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
    if (full || most == 1) methods.push_back({row.family, size, 1, row.product});
    if (most > 1) methods.push_back({row.family, size, most, row.product});
  }
  return methods;
}

Timing timingOf(Extent extent) {
  if (extent == Extent::full) return {5, 200};
  if (extent == Extent::quick) return {3, 30};
  return {1, 0};
}

}  // namespace

std::string programFingerprint() {
  // What is loaded of the program and cannot be written: /proc/self/exe is another program where a dynamic linker was
  // asked to run this one.
  Fingerprint fingerprint;
  const auto addProgram = [](dl_phdr_info* program, size_t, void* to) {
    for (const ElfW(Phdr) & segment : std::span(program->dlpi_phdr, program->dlpi_phnum)) {
      if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
      const void* bytes = reinterpret_cast<const void*>(program->dlpi_addr + segment.p_vaddr);  // NOLINT: a number
      static_cast<Fingerprint*>(to)->add(bytes, segment.p_filesz);
    }
    return 1;  // the libraries come after it
  };
  dl_iterate_phdr(addProgram, &fingerprint);
  return fingerprint.text();
}

std::vector<Planned> planOf(const RunSettings& settings, const std::vector<BaselineRow>& rows,
                            const std::string& origin) {
  std::vector<Planned> plan;
  for (const Case& which : settings.cases) {
    const size_t first = plan.size();
    for (Method& method : ownMethods(which.section, settings.extent, settings.threads)) {
      plan.push_back({&which, std::move(method), nullptr, ""});
    }
    for (const BaselineRow& row : rows) {
      for (Method& method : peerMethods(row, which.section, settings)) {
        plan.push_back({&which, std::move(method), &row, ""});
      }
    }
    const std::string workload = fingerprintOf(which.workload);
    for (size_t i = first; i < plan.size(); ++i) {
      Fingerprint key;
      key.add(origin);
      key.add(workload);
      key.add(which.section + "/" + which.name + print("/%.17g", which.x));
      key.add(plan[i].method.peer);
      key.add(plan[i].method.name() + print("/%u threads/%d", plan[i].method.threads, int(settings.extent)));
      plan[i].key = key.text();
    }
  }
  return plan;
}

Record measureAll(const RunSettings& settings, const std::vector<Planned>& plan, Record record, const Device& device,
                  const std::filesystem::path& folder, const std::function<void(const Planned&)>& step) {
  std::vector<std::optional<Cell>> cells(plan.size());
  if (const std::optional<Record> before = readRecord(folder)) {
    for (size_t i = 0; i < plan.size(); ++i) {
      if (const Cell* cell = before->find(plan[i].key)) cells[i] = *cell;
    }
  }
  const auto write = [&] {
    record.cells.clear();
    for (const std::optional<Cell>& cell : cells) {
      if (cell) record.cells.push_back(*cell);
    }
    writeRecord(folder, record);
  };
  std::unique_ptr<Bench> bench;
  for (size_t i = 0; i < plan.size(); ++i) {
    step(plan[i]);
    if (cells[i]) continue;
    if (!bench || &bench->which() != plan[i].which) {
      bench = std::make_unique<Bench>(*plan[i].which, device, timingOf(settings.extent));
    }
    cells[i] = bench->measure(plan[i].method, plan[i].row);
    cells[i]->key = plan[i].key;
    write();
  }
  write();
  return record;
}

}  // namespace radar::tools
