#include <cmath>
#include <cstdio>
#include <thread>

#include "bench/benchmarks.h"
#include "commit/commit.h"
#include "measure/report.h"

namespace radar::bench {

namespace {

double hundredths(double value) {
  return std::round(100 * value) / 100;
}

}  // namespace

void printHead(std::span<const Device> devices) {
  for (const Device& device : devices) std::printf("# %s, %s\n", device.name().c_str(), device.driver().c_str());
  std::printf("# %u cores, commit %s\n", std::thread::hardware_concurrency(), tools::commit());
  std::printf("workload,batch,method,prepare us,answer us,host us,times the first,differ\n");
}

void printRows(const std::string& workload, const std::vector<Method>& methods, std::span<const Batch> batches,
               const Repetition& repetition, int& status) {
  const std::vector<Series> all = measure(methods, batches, repetition);
  double first = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    const double perQuery = 1e6 / static_cast<double>(all[i].answers.size());
    const double prepare = perQuery * tools::median(secondsOf(all[i].show));
    const double host = perQuery * tools::median(secondsOf(all[i].answer, &Lap::thread));
    const double answer = perQuery * tools::median(secondsOf(all[i].answer));
    if (i == 0) first = prepare + answer;
    const std::string line =
        tools::csvLine({workload, batches[0].queries.size(), methods[i].name, hundredths(prepare), hundredths(answer),
                        hundredths(host), hundredths((prepare + answer) / first), all[i].differ});
    std::fputs(line.c_str(), stdout);
    std::fflush(stdout);
    if (all[i].differ > 0) status = 1;
  }
}

}  // namespace radar::bench

int main(int argc, char** argv) try {
  CLI::App app("Benchmarks: microseconds a query. Compare figures of one run only.");
  app.require_subcommand(1);
  int status = 0;
  radar::bench::addSearch(app, status);
  radar::bench::addRecorded(app, status);
  radar::bench::addChanges(app, status);
  radar::bench::addDeform(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return status;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_bench: %s\n", error.what());
  return 2;
}
