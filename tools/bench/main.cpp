#include <cstdio>
#include <thread>

#include "bench/benchmarks.h"
#include "bench/statistics.h"
#include "commit/commit.h"

namespace radar::bench {

void printOrigin(const Device& device) {
  std::printf("device %s, driver %s, %u cores, commit %s\n", device.name().c_str(), device.driver().c_str(),
              std::thread::hardware_concurrency(), tools::commit());
}

double medianMs(const std::vector<Lap>& laps, double Lap::*clock) {
  return 1e3 * tools::median(secondsOf(laps, clock));
}

}  // namespace radar::bench

int main(int argc, char** argv) {
  CLI::App app("Benchmarks: compare figures within one run only.");
  app.require_subcommand(1);
  int status = 0;
  radar::bench::addSearch(app, status);
  radar::bench::addRecorded(app, status);
  radar::bench::addPool(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "radar_bench: %s\n", error.what());
    return 2;
  }
  return status;
}
