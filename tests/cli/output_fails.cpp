// Output that cannot be written: a full disk, a folder that takes no files, a kill. The program says so with status 2
// and the file's name, and leaves nothing half-written.
#include <vector>

#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

const std::string kQuery = "query w/queries.json --mode reference ";
const std::string kScopes = "scopes w/mesh-0.ply w/mesh-1.ply --direction 1 0 0 --distance 5 --resolution 64 ";
const std::string kScale = "scale --sensors 2 --boxes 50 --steps 1 --repeat 1 --resolution 16 ";

void makeQueries(const ScratchFolder& folder) {
  succeed(folder, "workload figure7 --teapots 5 --boxes 60 --steps 12 --out w");
}

/// Runs the program where no file grows beyond `blocks` of 512 bytes, as on a full disk; `out` has all that it prints.
Run runOnFullDisk(const ScratchFolder& folder, const std::string& arguments, int blocks) {
  Run run = runCommand(folder, "( trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; '" RADAR_PROGRAM "' " +
                                   arguments + "; echo \"status $?\" ) 2>&1 | cat");
  const size_t status = run.out.rfind("status ");
  REQUIRE(status != std::string::npos);
  run.status = std::stoi(run.out.substr(status + 7));
  return run;
}

/// The files below the folder that are not whole. `whole`: a folder where the same command succeeded.
std::string halfWritten(const ScratchFolder& folder, const ScratchFolder& whole) {
  std::string names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (!entry.is_regular_file()) continue;
    const std::string name = std::filesystem::relative(entry.path(), folder.path());
    if (folder.read(name) != whole.read(name)) names += name + " ";
  }
  return names;
}

}  // namespace

TEST_CASE("on a full disk a command names the file, and nothing is left half-written") {
  struct Case {
    std::string arguments, named;
  };
  const auto& [arguments, named] = GENERATE(values<Case>({
      {kQuery + "--out a.jsonl", "a.jsonl"},
      {kQuery + "--out a.npy", "a.npy"},
      {kQuery + "--stats s.json", "s.json"},
      {"merge p0 p1 --out a.jsonl", "a.jsonl"},
      {"workload table1 --boxes 500 --out d", "d/mesh-"},
      {"workload table1 --boxes 500 --binary --out d", "d/"},
  }));
  const ScratchFolder whole, folder;
  for (const ScratchFolder* each : {&whole, &folder}) {
    makeQueries(*each);
    for (const std::string shard : {"0", "1"}) {
      succeed(*each, kQuery + "--shard " + shard + "/2 --out p" + shard);
    }
  }
  succeed(whole, arguments);
  for (const int blocks : {0, 1}) {
    if (blocks == 1 && named == "s.json") continue;  // it has room
    CAPTURE(arguments, blocks);
    const Run run = runOnFullDisk(folder, arguments, blocks);
    CAPTURE(run.out);
    CHECK(run.status == 2);
    CHECK_THAT(run.out, Contains(named) && Contains("expected a"));
    CHECK_THAT(run.out, Contains("File too large"));
    CHECK(halfWritten(folder, whole) == "");
  }
}

// Their drivers make files, too, so a limit would stop these before they write.
TEST_CASE("commands that draw or measure name the file for which there is no room, and leave no unfinished one") {
  struct Case {
    std::string arguments, named;
  };
  const auto& [arguments, named] = GENERATE(values<Case>({
      {kScopes + "--raw --out d", "d/R.f32"},
      {"demo --out d", "d/table.txt"},
      {"selftest --minutes 0.1 --device 0 --out d", "d/report.json"},
      {kScale + "--out d", "d/scale.csv"},
  }));
  const ScratchFolder folder;
  makeQueries(folder);
  std::filesystem::create_directory(folder.path() / "d");
  std::filesystem::create_symlink("/dev/full", folder.path() / named);
  const Run run = runProgram(folder, arguments);
  CAPTURE(arguments, run.err);
  CHECK(run.status == 2);
  CHECK_THAT(run.err, Contains(named) && Contains("expected a") && Contains("No space left on device"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    CAPTURE(entry.path());
    CHECK(entry.path().string().find(".unfinished-") == std::string::npos);
  }
}

TEST_CASE("a chart that gnuplot could not finish for lack of room is not taken for a whole one") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "bin");
  folder.write("bin/gnuplot", "#!/bin/sh\ntrap '' XFSZ\nulimit -f 4\nexec /usr/bin/gnuplot \"$@\"\n");
  std::filesystem::permissions(folder.path() / "bin/gnuplot", std::filesystem::perms::owner_all);
  const Run run = runProgram(folder, kScale + "--out d", "PATH=\"$PWD/bin:$PATH\" ");
  CAPTURE(run.err);
  CHECK(run.status == 2);
  CHECK_THAT(run.err, Contains("gnuplot, which draws the charts, left a picture unfinished"));
  CHECK(std::filesystem::exists(folder.path() / "d/scale.csv"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "d/scale.svg"));
}

TEST_CASE("a command whose standard output is full says so") {
  const ScratchFolder folder;
  makeQueries(folder);
  for (const std::string& arguments :
       std::vector<std::string>{std::string("devices"), std::string("--help"), std::string("query --help"), kQuery,
                                std::string("workload soup --objects 3 --sensors 2 --out v"),
                                std::string("sweep w/mesh-0.ply w/mesh-1.ply --direction 1 0 0 --distance 5 "
                                            "--mode reference")}) {
    CAPTURE(arguments);
    const Run run = runProgram(folder, arguments + " >/dev/full");
    CHECK(run.status == 2);
    CHECK_THAT(run.err, Contains("standard output: expected a place to write to"));
  }
}

TEST_CASE("a folder that takes no files is refused by name, whoever asks") {
  const ScratchFolder folder;
  makeQueries(folder);
  succeed(folder, kQuery + "--shard 0/1 --out p");
  // Below a file, and where not even root creates anything.
  for (const std::string out : {"w/queries.json/d", "/proc/d"}) {
    for (const std::string& arguments :
         std::vector<std::string>{kQuery + "--out " + out, kQuery + "--out " + out + ".npy", kQuery + "--stats " + out,
                                  "merge p --out " + out, "workload table1 --boxes 5 --out " + out,
                                  "workload table1 --boxes 5 --binary --out " + out, kScopes + "--out " + out,
                                  "scale --boxes 20 --out " + out, "demo --out " + out, "selftest --out " + out}) {
      CAPTURE(arguments);
      const Run run = runProgram(folder, arguments);
      CHECK(run.status == 2);
      CHECK_THAT(run.err, Contains(out) && Contains("expected a"));
      CHECK(folder.list() == "p w");
    }
  }
}

TEST_CASE("a run that could not even write its first line leaves nothing that hinders the next") {
  const ScratchFolder folder;
  makeQueries(folder);
  REQUIRE(runOnFullDisk(folder, kQuery + "--out a.jsonl", 0).status == 2);
  CHECK(folder.list() == "w");
  succeed(folder, kQuery + "--out a.jsonl");
}

TEST_CASE("a command that is killed while it writes leaves no half of a file under its name") {
  const std::string arguments =
      GENERATE(as<std::string>(), kQuery + "--out a.jsonl", "workload table1 --boxes 500 --out d",
               "workload table1 --boxes 500 --binary --out d", kScopes + "--raw --out d");
  const ScratchFolder whole, folder;
  for (const ScratchFolder* each : {&whole, &folder}) makeQueries(*each);
  succeed(whole, arguments);
  // The system ends the process when a file would grow beyond 4 blocks.
  CHECK(runProgram(folder, arguments, "ulimit -f 4; ").status != 0);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    const std::string name = std::filesystem::relative(entry.path(), folder.path());
    if (!entry.is_regular_file() || name.find(".unfinished-") != std::string::npos || name.ends_with(".partial"))
      continue;
    CAPTURE(name);
    CHECK(folder.read(name) == whole.read(name));
  }
}
