// The exact searches beside each other: on the device, on the processor with one thread and with all, and what mode
// contact makes of both. All ways take turns within one run; medians after a warm-up, without validation layers.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include "commit/commit.h"
#include "import/mesh_import.h"
#include "radar/cpu_sweeper.h"
#include "report/median.h"
#include "workloads/drop_cutter.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"
#include "workloads/same_answer.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

constexpr uint32_t kOnDevice = 0;  // SweeperOptions::cpuBatch: every batch goes to the device

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
  cases.push_back({"sheets", [](uint32_t n) { return tools::makeWorkload(tools::Sheets{.sensors = n}); }, {1, 4}});
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
  std::string csv;
  double seconds = 1;
  unsigned threads = std::thread::hardware_concurrency();
};

double secondsOf(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Way {
  const char* name;
  std::function<std::vector<Result>(std::span<const Query>)> run;
  std::vector<double> us = {};      ///< a query
  std::vector<double> hostUs = {};  ///< of which the calling thread computed
  std::vector<Result> answers = {};
};

struct Measured {
  double us, hostUs;
};

class Bench {
 public:
  Bench(const Device& device, const Settings& settings) : device_(device), settings_(settings) {
    if (settings.csv.empty()) return;
    csv_.open(settings.csv);
    if (!csv_) throw Error(settings.csv + ": cannot be written");
    csv_ << "workload,batch,contact us,device us,device host us,cpu us,cpu 1 thread us,device / cpu,contact / "
            "cpu,differ\n";
  }

  void run(const Case& one) {
    std::vector<uint32_t> batches = settings_.batches.empty() ? one.batches : settings_.batches;
    const tools::Workload workload = one.make(*std::max_element(batches.begin(), batches.end()));
    if (workload.scenes.size() > 1) return steps(one.name, workload);
    tools::ScenePlayer player(workload);
    player.show(0);
    std::vector<Query> queries;
    for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, Mode::contact));
    Ways ways(device_, player.scene(), settings_.threads);
    for (const uint32_t batch : batches) {
      if (batch > queries.size()) continue;
      // Of small batches many, each its own, so that no one query stands for all.
      const size_t least = batch == 1 ? 48 : batch < 64 ? 8 : 1;
      const size_t count = std::max<size_t>(1, std::min(queries.size() / batch, least));
      std::vector<std::span<const Query>> all;
      for (size_t i = 0; i < count; ++i) all.push_back(std::span(queries).subspan(i * batch, batch));
      measure(
          one.name, batch, ways,
          [&](const auto& runBatch) {
            for (const auto& part : all) runBatch(part);
          },
          count * batch);
    }
  }

 private:
  struct Ways {
    Ways(const Device& device, const Scene& scene, unsigned threads)
        : contact(device, scene),
          onDevice(device, scene, {.cpuBatch = kOnDevice}),
          cpu(scene, threads),
          oneThread(scene, 1) {
      for (Sweeper* sweeper : {&contact, &onDevice}) sweeper->sync();
      list = {{"contact", [this](auto batch) { return contact.run(batch); }},
              {"device", [this](auto batch) { return onDevice.run(batch); }},
              {"cpu", [this](auto batch) { return cpu.run(batch); }},
              {"cpu, 1 thread", [this](auto batch) { return oneThread.run(batch); }}};
    }
    Sweeper contact, onDevice;
    CpuSweeper cpu, oneThread;
    std::vector<Way> list;
  };

  /// The scenes of a motion, each its batch; the trees and the device's copy follow the scene within the time measured.
  void steps(const std::string& name, const tools::Workload& workload) {
    const std::vector<tools::Batch> batches = tools::batchesOf(workload);
    tools::ScenePlayer player(workload);
    player.show(batches[0].scene);
    Ways ways(device_, player.scene(), settings_.threads);
    measure(
        name, static_cast<uint32_t>(batches[0].queries.size()), ways,
        [&](const auto& runBatch) {
          for (const tools::Batch& batch : batches) {
            player.show(batch.scene);
            std::vector<Query> queries;
            for (const uint32_t i : batch.queries)
              queries.push_back(tools::toQuery(workload.queries[i], Mode::contact));
            runBatch(queries);
          }
        },
        workload.queries.size());
  }

  /// `pass` hands its argument every batch once.
  template <class Pass>
  void measure(const std::string& name, uint32_t batch, Ways& ways, const Pass& pass, size_t queries) {
    for (Way& way : ways.list) way.us.clear(), way.hostUs.clear();
    const Clock::time_point begun = Clock::now();
    for (int round = -1; round < 3 || (round < 15 && secondsSince(begun) < settings_.seconds); ++round) {
      for (Way& way : ways.list) {
        way.answers.clear();
        double seconds = 0, host = 0;
        pass([&](std::span<const Query> part) {
          const double hostBefore = secondsOf(CLOCK_THREAD_CPUTIME_ID);
          const Clock::time_point start = Clock::now();
          const std::vector<Result> found = way.run(part);
          seconds += secondsSince(start);
          host += secondsOf(CLOCK_THREAD_CPUTIME_ID) - hostBefore;
          way.answers.insert(way.answers.end(), found.begin(), found.end());
        });
        if (round < 0) continue;  // a warm-up
        way.us.push_back(1e6 * seconds / static_cast<double>(queries));
        way.hostUs.push_back(1e6 * host / static_cast<double>(queries));
      }
    }
    print(name, batch, ways.list);
  }

  void print(const std::string& name, uint32_t batch, const std::vector<Way>& ways) {
    const Way &contact = ways[0], &device = ways[1], &cpu = ways[2], &one = ways[3];
    size_t differ = 0;
    for (const Way& way : ways) {
      for (size_t i = 0; i < one.answers.size(); ++i) differ += !tools::sameAnswer(way.answers[i], one.answers[i]);
    }
    const double ofContact = tools::median(contact.us), ofDevice = tools::median(device.us),
                 host = tools::median(device.hostUs), ofCpu = tools::median(cpu.us), ofOne = tools::median(one.us);
    std::printf("%-27s %7u %10.2f %10.2f %8.2f %10.2f %10.2f %9.2f %9.2f %7zu\n", name.c_str(), batch, ofContact,
                ofDevice, host, ofCpu, ofOne, ofDevice / ofCpu, ofContact / ofCpu, differ);
    std::fflush(stdout);
    if (csv_.is_open()) {
      csv_ << name << ',' << batch << ',' << ofContact << ',' << ofDevice << ',' << host << ',' << ofCpu << ',' << ofOne
           << ',' << ofDevice / ofCpu << ',' << ofContact / ofCpu << ',' << differ << std::endl;
    }
    differed_ = differed_ || differ != 0;
  }

  static double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

 public:
  bool differed() const { return differed_; }

 private:
  const Device& device_;
  const Settings& settings_;
  std::ofstream csv_;
  bool differed_ = false;
};

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<Case> cases = allCases();
  std::vector<std::string> names;
  for (const Case& one : cases) names.push_back(one.name);
  Settings settings;
  CLI::App app("The exact searches, on the device and beside it: microseconds a query, in one run.");
  app.add_option("workload", settings.cases, "Which; all, where none is named")->check(CLI::IsMember(names));
  app.add_option("--batch", settings.batches, "Queries in a batch; each workload's own sizes, where none is given")
      ->check(CLI::Range(1u, 1u << 20));
  app.add_option("--csv", settings.csv, "Also write a table there");
  app.add_option("--seconds", settings.seconds, "For each row, once there are 3 rounds")->capture_default_str();
  app.add_option("--threads", settings.threads, "Of the processor's search")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const Device device = Device::open();
  std::printf("device %s, driver %s, %u cores, commit %s\n", device.name().c_str(), device.driver().c_str(),
              std::thread::hardware_concurrency(), tools::commit());
  std::printf("microseconds a query; host: what the calling thread computed of the device's\n");
  std::printf("%-27s %7s %10s %10s %8s %10s %10s %9s %9s %7s\n", "workload", "batch", "contact", "device", "host",
              "cpu", "cpu,1 thr", "dev/cpu", "cont/cpu", "differ");
  Bench bench(device, settings);
  for (const Case& one : cases) {
    const bool wanted =
        settings.cases.empty() || std::count(settings.cases.begin(), settings.cases.end(), one.name) > 0;
    if (wanted) bench.run(one);
  }
  return bench.differed() ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_bench_search: %s\n", error.what());
  return 2;
}
