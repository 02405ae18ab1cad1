// The exact searches beside each other: on the device, on the processor with one thread and with all, and what mode
// contact makes of both.
#include <algorithm>
#include <map>
#include <memory>
#include <thread>

#include "bench/benchmarks.h"
#include "import/mesh_import.h"
#include "radar/cpu_sweeper.h"
#include "workloads/drop_cutter.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace radar::bench {

namespace {

/// A workload, made when it is its turn: some take seconds and gigabytes. Where it has several scenes they are the
/// steps of a motion, each a batch.
struct Case {
  std::string name;
  std::function<tools::Workload(uint32_t sensors)> make;
  std::vector<uint32_t> batches;
};

std::vector<Case> allCases() {
  const std::vector<uint32_t> sizes{1, 64, 1024, 16'384, 131'072}, heavy{1, 64, 1024};
  const auto table1 = [](tools::SensorShape shape) {
    return [shape](uint32_t n) {
      return tools::makeWorkload(tools::Table1{.boxes = 30'000, .sensors = n, .shape = shape});
    };
  };
  const auto city = [](uint32_t triangles, tools::SensorShape shape) {
    return [=](uint32_t n) {
      return tools::makeWorkload(tools::OneMesh{.triangles = triangles, .sensors = n, .shape = shape});
    };
  };
  const auto grown = [](uint32_t boxes) {
    return [boxes](uint32_t n) {
      return tools::makeWorkload(tools::Scale{.boxes = boxes, .sensors = n, .shape = tools::SensorShape::box});
    };
  };
  using tools::SensorShape;
  std::vector<Case> cases{
      {"table1-boxes", table1(SensorShape::box), sizes},
      {"table1-teapots", table1(SensorShape::teapot), sizes},
      {"figure7", [](uint32_t) { return tools::makeWorkload(tools::Figure7{.teapots = 30}); }, {30}},
      {"mesh-1M-boxes", city(1'000'000, SensorShape::box), sizes},
      {"mesh-10M-boxes", city(10'000'000, SensorShape::box), {1, 64, 1024, 16'384}},
      {"city-teapots", city(1'000'000, SensorShape::teapot), {1, 64, 1024, 16'384}},
  };
  for (const tools::Interlocking kind : tools::kInterlocking) {
    cases.push_back(
        {std::string("interlocking-") + tools::nameOf(kind),
         [kind](uint32_t n) { return tools::makeWorkload(tools::InterlockingPairs{.kind = kind, .sensors = n}); },
         {1, 64, 256}});
  }
  cases.push_back({"real-meshes",
                   [](uint32_t n) {
                     std::vector<tools::MeshData> meshes;
                     std::vector<std::string> warnings;
                     for (const char* name : {"elephant", "knot1", "eight", "anchor", "hand"}) {
                       meshes.push_back(
                           tools::readMesh(RADAR_CGAL_MESHES + ("/" + std::string(name)) + ".off", warnings));
                     }
                     return tools::makeWorkload(tools::RandomPoses{.meshes = meshes, .sensors = n});
                   },
                   heavy});
  cases.push_back(
      {"drop-cutter", [](uint32_t) { return tools::makeWorkload(tools::DropCutter()); }, {1, 64, 1024, 42'000}});
  for (const uint32_t boxes : {1'000u, 10'000u, 100'000u, 1'000'000u}) {
    cases.push_back({"growth-" + std::to_string(boxes), grown(boxes), {16'384}});
  }
  return cases;
}

struct Settings {
  std::vector<std::string> cases;
  std::vector<uint32_t> batches;
  double seconds = 1;
  unsigned threads = std::thread::hardware_concurrency();
};

// Of small batches many, each its own, so that no one query stands for all.
std::vector<Batch> cut(const Batch& all, uint32_t size) {
  const size_t enough = size == 1 ? 48 : size < 64 ? 8 : 1;
  std::vector<Batch> parts(std::min(all.queries.size() / size, enough));
  auto next = all.queries.begin();
  for (Batch& part : parts) {
    part.scene = all.scene;
    part.queries.assign(next, next + size);
    next += size;
  }
  return parts;
}

/// The sweepers of one workload.
struct Searches {
  Sweeper contact, onDevice;
  CpuSweeper cpu, oneThread;
  Searches(const Device& device, const Scene& scene, unsigned threads)
      : contact(device, scene), onDevice(device, scene, {.cpuBatch = 0}), cpu(scene, threads), oneThread(scene, 1) {
    for (Sweeper* sweeper : {&contact, &onDevice}) sweeper->sync();
  }
};

template <class AnySweeper>
Method plain(const char* name, AnySweeper& sweeper) {
  return {name, [&](auto queries) { return sweeper.run(queries).results; }};
}

/// Asks each query changed by `change`, once and for all before the passes that count.
template <class AnySweeper, class Change>
Method changed(const char* name, AnySweeper& sweeper, const Change& change) {
  auto kept = std::make_shared<std::map<const Query*, std::vector<Query>>>();
  return {name, [&sweeper, change, kept](std::span<const Query> queries) {
            std::vector<Query>& asked = (*kept)[queries.data()];
            if (asked.empty()) {
              asked.assign(queries.begin(), queries.end());
              for (Query& query : asked) change(query);
            }
            return sweeper.run(asked).results;
          }};
}

std::vector<Method> exactSearches(Searches& by) {
  return {plain("cpu", by.cpu), plain("cpu 1 thread", by.oneThread), plain("contact", by.contact),
          plain("device", by.onDevice)};
}

// What counts as a contact, and how many are listed. Where nothing touches at the start, the answers are the same.
std::vector<Method> kindsOfContact(Searches& by) {
  const auto leaving = [](Query& query) { query.ignoreLeaving = true; };
  return {plain("cpu 1 thread", by.oneThread), changed("leaving ignored", by.oneThread, leaving),
          changed("all hits", by.oneThread, [](Query& query) { query.hits = kAllHits; }), plain("device", by.onDevice),
          changed("device, leaving ignored", by.onDevice, leaving)};
}

// Where there are several scenes they are the steps of a motion: the trees and the device's copy follow the scene
// within the time measured.
void run(const Device& device, const Case& one, const Settings& settings, std::vector<Method> methodsOf(Searches&),
         int& status) {
  const std::vector<uint32_t>& sizes = settings.batches.empty() ? one.batches : settings.batches;
  const tools::Workload workload = one.make(*std::max_element(sizes.begin(), sizes.end()));
  const std::vector<Batch> batches = tools::batchesOf(workload.queries);
  tools::ScenePlayer player(workload);
  const auto show = [&](uint32_t scene) { player.show(scene); };
  show(batches[0].scene);
  Searches searches(device, player.scene(), settings.threads);
  std::vector<Method> methods = methodsOf(searches);
  for (Method& method : methods) method.show = show;
  const Repetition repetition{.seconds = settings.seconds};
  if (batches.size() > 1) {
    printRows(one.name, methods, batches, repetition, status);
    return;
  }
  for (const uint32_t size : sizes) {
    if (size > batches[0].queries.size()) continue;
    printRows(one.name, methods, cut(batches[0], size), repetition, status);
  }
}

}  // namespace

namespace {

void add(CLI::App& app, const char* name, const char* about, std::vector<Method> methodsOf(Searches&), int& status) {
  std::vector<std::string> names;
  for (const Case& one : allCases()) names.push_back(one.name);
  CLI::App* command = app.add_subcommand(name, about);
  auto settings = std::make_shared<Settings>();
  command->add_option("workload", settings->cases, "Which; all, where none is named")->check(CLI::IsMember(names));
  command
      ->add_option("--batch", settings->batches, "Queries in a batch; each workload's own sizes, where none is given")
      ->check(CLI::Range(1u, 1u << 20));
  command->add_option("--seconds", settings->seconds, "For each batch size, once there are 3 rounds")
      ->capture_default_str();
  command->add_option("--threads", settings->threads, "Of the processor's search")->capture_default_str();
  command->callback([settings, methodsOf, &status] {
    const Device device = Device::open();
    printHead({&device, 1});
    for (const Case& one : allCases()) {
      const auto& wanted = settings->cases;
      if (!wanted.empty() && std::count(wanted.begin(), wanted.end(), one.name) == 0) continue;
      run(device, one, *settings, methodsOf, status);
    }
  });
}

}  // namespace

void addSearch(CLI::App& app, int& status) {
  add(app, "search", "The exact searches, on the device and on the processor", exactSearches, status);
  add(app, "contacts", "What counts as a contact, and lists of contacts, against the first contact", kindsOfContact,
      status);
}

}  // namespace radar::bench
