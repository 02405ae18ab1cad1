// radar-lab chart, as a person runs it.
#include <filesystem>

#include "cli/program.h"
#include "support/catch.h"

using radar::test::checkRefused;
using radar::test::Contains;
using radar::test::Run;
using radar::test::runLab;
using radar::test::runProgram;
using radar::test::ScratchFolder;

TEST_CASE("chart leaves numbers, charts and tables, and draws them again from its numbers") {
  const ScratchFolder folder;
  REQUIRE(runProgram(folder, "workload table1 --boxes 200 --sensors 4 --out own").status == 0);
  std::filesystem::copy(folder.path() / "own/queries.json", folder.path() / "own/It's thin.json");
  folder.write("tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n");
  const std::string command =
      "chart --extent least --out c own/queries.json \"own/It's thin.json\" own/queries.json --mesh tetrahedron.obj";
  const Run first = runLab(folder, command);
  INFO(first.err);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.out, Contains("interlocking") && Contains("queries-2"));
  CHECK_THAT(folder.read("c/front.csv"), Contains("\nfront,interlocking,") && Contains("\nfront,meshes,"));
  CHECK_THAT(folder.read("c/table1.csv"), Contains("\ntable1,table1,30000,"));
  // Names of files for charts and links, and none twice.
  for (const char* file :
       {"c/front-thin.svg", "c/front-queries.svg", "c/front-queries-2.svg", "c/front-it-s-thin.svg", "c/table1.svg"}) {
    CHECK_THAT(folder.read(file), Contains("</svg>"));
  }
  CHECK_THAT(folder.read("c/front-it-s-thin.svg"), Contains("Queries of own/It's thin.json"));
  const std::string chart = folder.read("c/front-thin.svg"), table = folder.read("c/workloads.csv");
  CHECK_THAT(table, Contains("\nit-s-thin,4,"));
  std::filesystem::remove(folder.path() / "c/front-thin.svg");
  std::filesystem::remove(folder.path() / "c/workloads.csv");
  CHECK(runLab(folder, "chart --render --out c").status == 0);
  CHECK(folder.read("c/front-thin.svg") == chart);
  CHECK(folder.read("c/workloads.csv") == table);
}

TEST_CASE("chart measures only the sections that are named") {
  const ScratchFolder folder;
  const Run run = runLab(
      folder, "chart --extent least --section growth,contacts,edits,trees,recorded,clearances,turns,single --out c");
  INFO(run.err);
  CHECK(run.status == 0);
  CHECK_THAT(folder.read("c/growth.csv"), Contains("\nteapots-leaving-ignored,contact,64,"));
  for (const char* file : {"c/edits.csv", "c/recorded.csv"}) {
    const std::string csv = folder.read(file);
    CHECK_THAT(csv, Contains("nothing") && Contains("moved"));
    for (size_t end = csv.find('\n') + 1; (end = csv.find('\n', end)) != std::string::npos; ++end) {
      CHECK(csv.substr(end - 2, 2) == ",0");  // answers that differ
    }
  }
  CHECK_THAT(folder.read("c/trees.csv"), Contains("\n1000 triangles,") && Contains("\n1000 objects,"));
  CHECK_THAT(folder.read("c/clearances.csv"),
             Contains("\nball of radius 3,16,") && Contains("\n\"teapots, with clearances\",32,"));
  CHECK_THAT(folder.read("c/turns.csv"),
             Contains("\nboxes,turning by 30 degrees,64,") && Contains("arm, up to 1 rad a joint\",all,"));
  CHECK_THAT(folder.read("c/single.csv"),
             Contains("\nbox,CpuSweeper,16,") && Contains("\nellipsoid of 168 triangles,"));
  CHECK_THAT(folder.read("c/threads.csv"), Contains("\n16,1,"));
  CHECK_THAT(folder.read("c/growth-boxes.svg"), Contains("More of the scene"));
  CHECK_THAT(folder.read("c/growth.csv"), Contains("\ngrowth-sensors,contact,1,"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "c/front.csv"));
}

TEST_CASE("chart refuses what it cannot do with status 2 and the option's or file's name") {
  const ScratchFolder folder;
  folder.write("file", "");
  std::filesystem::create_directory(folder.path() / "broken");
  folder.write("broken/report.json", "{");
  folder.write("none.json", R"({"format": "cyber-radar-queries-1", "meshes": [], "scenes": [], "queries": []})");
  checkRefused(folder, "chart", "--out", runLab);
  checkRefused(folder, "chart --out file", "--out", runLab);
  checkRefused(folder, "chart --out c --render", "report.json", runLab);
  checkRefused(folder, "chart --out broken --render", "broken", runLab);
  checkRefused(folder, "chart --out c missing.json", "missing.json", runLab);
  checkRefused(folder, "chart --out c none.json", "queries", runLab);
  checkRefused(folder, "chart --out c --mesh missing.ply", "missing.ply", runLab);
  checkRefused(folder, "chart --out c --device 99", "99", runLab);
  checkRefused(folder, "chart --out c --extent huge", "--extent", runLab);
}

TEST_CASE("without gnuplot chart measures and says how to draw, which gives the charts later") {
  const ScratchFolder folder;
  const Run run = runLab(folder, "chart --extent least --section front --out c", "PATH=/nowhere");
  INFO(run.err);
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("interlocking") && !Contains(".svg"));
  CHECK_THAT(run.err, Contains("gnuplot") && Contains("apt install gnuplot-nox") &&
                          Contains("radar-lab chart --render --out " + (folder.path() / "c").string()));
  CHECK_FALSE(folder.read("c/workloads.csv").empty());
  CHECK_THAT(folder.read("c/index.html"), !Contains(".svg"));
  CHECK(runLab(folder, "chart --render --out c").status == 0);
  CHECK_THAT(folder.read("c/front-interlocking.svg"), Contains("</svg>"));
  CHECK_THAT(folder.read("c/index.html"), Contains("front-interlocking.svg"));
}

TEST_CASE("what needs gnuplot does nothing without it, and the error says what to install, with status 2") {
  const ScratchFolder folder;
  for (const Run& run : {runLab(folder, "chart --render --out c", "PATH=/nowhere"),
                         runProgram(folder, "scale --sensors 2 --out c", "PATH=/nowhere")}) {
    CHECK(run.status == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains("gnuplot") && Contains("apt install gnuplot-nox"));
    CHECK(folder.list().empty());
  }
}
