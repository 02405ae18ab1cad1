// radar-lab host, as a person runs it.
#include <sstream>

#include "cli/program.h"
#include "support/catch.h"

using radar::test::checkRefused;
using radar::test::Contains;
using radar::test::Run;
using radar::test::runLab;
using radar::test::ScratchFolder;
using radar::test::StartsWith;

TEST_CASE("the cost of a call is told for each workload, batch and number of threads, and adds up") {
  const ScratchFolder folder;
  const Run run = runLab(folder, "host --queries 1,300 --threads 1,2 --repeat 1 --out h");
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, StartsWith("device ") && Contains("host_us"));
  std::istringstream table(folder.read("h/host.csv"));
  std::string line;
  std::getline(table, line);
  CHECK_THAT(line, StartsWith("workload,batch,threads,call_us,host_us,plan_us,submit_us,decode_us,device_us,"));
  size_t rows = 0;
  for (; std::getline(table, line); ++rows) {
    CAPTURE(line);
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 3; ++i) std::getline(cells, cell, ',');
    double call = 0, host = 0, part = 0, parts = 0;
    char comma = 0;
    cells >> call >> comma >> host >> comma;
    for (int i = 0; i < 3; ++i) {
      cells >> part >> comma;
      CHECK(part > 0);
      parts += part;
    }
    CHECK((host > 0 && call >= host && call >= parts));
  }
  CHECK(rows == 8);
  checkRefused(folder, "host --queries 0", "--queries", runLab);
  checkRefused(folder, "host --device 99", "99", runLab);
}
