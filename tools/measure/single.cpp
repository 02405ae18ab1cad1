#include "measure/single.h"

#include <algorithm>
#include <thread>

#include "measure/try_out.h"
#include "radar/cpu_sweeper.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr int kPasses = 3;
const char* const kSection = "single";

Workload boxesAmongBoxes(Extent extent, uint32_t sensors) {
  return makeWorkload(
      Table1{.boxes = extent == Extent::full ? 30'000u : 300u, .sensors = sensors, .shape = SensorShape::box});
}

/// Of the same sizes, in the same places.
Workload withSensor(Workload workload, MeshData mesh) {
  for (QuerySpec& query : workload.queries) query.mesh = static_cast<uint32_t>(workload.meshes.size());
  workload.meshes.push_back(std::move(mesh));
  return workload;
}

void castOneByOne(const std::string& sensor, const Workload& workload, Extent extent,
                  std::span<const BaselineRow> libraries, Json& report) {
  const std::vector<Query> queries = queriesOf(workload.queries);
  const Truth truth = truthOf(workload);
  Scene scene;
  replaceBy(workload, 0, scene);
  CpuSweeper sweeper(scene);
  std::vector<std::string> names{"CpuSweeper"};
  std::vector<std::vector<Result>> answers(1);
  std::vector<Ask> ways{[&, own = Answers()](const Query& query) mutable {
    sweeper.run({&query, 1}, own);
    answers[0].push_back(own.results[0]);
  }};
  for (const Method& method : others(libraries, kSection, extent, 1)) {
    names.push_back(method.name());
    const Session session = method.open(workload);
    session.show(0);
    ways.push_back([&, session, way = ways.size()](const Query& query) {
      answers[way].push_back(session.answer({&query, 1}).front());
    });
  }
  answers.resize(ways.size());
  const std::vector<std::vector<double>> seconds = secondsAlone(queries, ways);
  for (size_t way = 0; way < ways.size(); ++way) {
    const Accuracy accuracy = accuracyOf(std::span(answers[way]).first(queries.size()), truth, way == 0);
    Json row{{"sensor", sensor}, {"method", names[way]}};
    row.update(latencies(seconds[way]));
    row["contacts"] = accuracy.contacts;
    row["wrong"] = accuracy.misses + accuracy.falseHits;
    row["worst_error"] = accuracy.errorWorst;
    partOf(report, kSection, "Section single, microseconds a query, each asked alone")["rows"].push_back(row);
  }
}

void castOnThreads(Extent extent, Json& report) {
  const bool isFull = extent == Extent::full;
  const uint32_t cores = std::max(1u, std::thread::hardware_concurrency());
  const std::vector<uint32_t> sizes =
      isFull ? std::vector<uint32_t>{1, 16, 256, 4'096, 65'536} : std::vector<uint32_t>{1, 16};
  const Workload workload = boxesAmongBoxes(extent, sizes.back());
  Scene scene;
  replaceBy(workload, 0, scene);
  const std::vector<Query> all = queriesOf(workload.queries);
  std::vector<CpuSweeper> sweepers;
  std::vector<uint32_t> threads;
  for (uint32_t count = 1; count <= cores; count = count < cores ? std::min(2 * count, cores) : cores + 1) {
    threads.push_back(count);
    sweepers.emplace_back(scene, count);
  }
  // Of small batches many.
  const auto queriesFor = [&](uint32_t size) { return std::span(all).first(std::max(size, sizes.back() / 16)); };
  const size_t ways = sweepers.size();
  std::vector<std::vector<Lap>> laps(sizes.size() * ways);
  Answers answers;
  const uint32_t passes = isFull ? 9 : 1;
  inTurns({.least = passes, .most = passes}, laps.size(), [&](size_t turn, bool counts) {
    const uint32_t size = sizes[turn / ways];
    const std::span<const Query> queries = queriesFor(size);
    const Lap lap = lapOf([&] {
      for (size_t at = 0; at < queries.size(); at += size)
        sweepers[turn % ways].run(queries.subspan(at, size), answers);
    });
    if (counts) laps[turn].push_back(lap);
  });
  for (size_t turn = 0; turn < laps.size(); ++turn) {
    const uint32_t size = sizes[turn / ways];
    const auto least = [&](size_t which, double Lap::*clock) {
      return 1e6 * std::ranges::min(secondsOf(laps[which], clock)) / static_cast<double>(queriesFor(size).size());
    };
    const double us = least(turn, &Lap::wall);
    partOf(report, "threads", "Section single, microseconds a query of a batch")["rows"].push_back(
        {{"batch", size},
         {"threads", threads[turn % ways]},
         {"us", us},
         {"cpu_us", least(turn, &Lap::process)},
         {"efficiency", least(turn - turn % ways, &Lap::wall) / us / threads[turn % ways]}});
  }
}

}  // namespace

std::vector<std::vector<double>> secondsAlone(std::span<const Query> queries, std::span<const Ask> ways) {
  std::vector<std::vector<double>> seconds(ways.size(), std::vector<double>(queries.size(), INFINITY));
  inTurns({.least = kPasses, .most = kPasses}, ways.size(), [&](size_t way, bool counts) {
    for (size_t i = 0; i < queries.size(); ++i) {
      const double each = lapOf([&] { ways[way](queries[i]); }).wall;
      if (counts) seconds[way][i] = std::min(seconds[way][i], each);
    }
  });
  return seconds;
}

Json latencies(std::span<const double> seconds) {
  const std::vector<double> all(seconds.begin(), seconds.end());
  double sum = 0;
  for (const double each : all) sum += each;
  return {{"queries", all.size()},
          {"mean", 1e6 * sum / static_cast<double>(all.size())},
          {"median", 1e6 * median(all)},
          {"99_percent", 1e6 * quantile(all, 0.99)},
          {"slowest", 1e6 * quantile(all, 1)}};
}

void measureSingle(Extent extent, std::span<const BaselineRow> libraries, Json& report) {
  const Workload boxes = boxesAmongBoxes(extent, extent == Extent::full ? 3'000 : 16);
  castOneByOne("box", boxes, extent, libraries, report);
  const Workload balls = withSensor(boxes, resized(makeUvSphere(8, 12), 0.5));
  castOneByOne(print("ellipsoid of %u triangles", balls.meshes.back().triangleCount()), balls, extent, libraries,
               report);
  castOnThreads(extent, report);
  for (const char* part : {kSection, "threads"}) partOf(report, part)["state"] = "done";
}

}  // namespace radar::tools
