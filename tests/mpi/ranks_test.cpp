// cyber-radar-mpi on this machine, with more ranks than cores.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program.h"
#include "support/catch.h"

using radar::test::Contains;
using radar::test::Run;
using radar::test::runCommand;
using radar::test::runProgram;
using radar::test::ScratchFolder;

namespace {

// Open MPI wants to be told that root runs it, and that there are more ranks than cores (release 5 by other names than
// 4). Where a limit leaves no room for shared memory, messages go through the loopback. `limits`: the shell's commands
// in each rank before the program.
std::string mpirun(int ranks, const std::string& arguments, const std::string& limits = "true") {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
         "OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl_vader_single_copy_mechanism=none "
         "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe PRTE_MCA_hwloc_default_binding_policy=none "
         "OMPI_MCA_btl_tcp_if_include=lo '" RADAR_MPIEXEC "' -n " +
         std::to_string(ranks) + " sh -c \"" + limits + "; exec '" RADAR_MPI_PROGRAM "' query " + arguments + "\"";
}

Run runRanks(const ScratchFolder& folder, int ranks, const std::string& arguments) {
  return runCommand(folder, mpirun(ranks, arguments));
}

std::string withoutHead(const std::string& part) {
  return part.substr(part.find('\n') + 1);
}

void requireSame(const std::string& found, const std::string& expected) {
  REQUIRE(found.size() == expected.size());
  REQUIRE((found == expected));  // without printing megabytes
}

}  // namespace

TEST_CASE("1, 2 and 4 ranks or 4 shards give 100,000 answers with the bytes of one process") {
  const ScratchFolder folder;
  REQUIRE(runProgram(folder, "workload table1 --boxes 3000 --sensors 100000 --binary --out w").status == 0);
  for (const std::string format : {"lines", "npy"}) {
    CAPTURE(format);
    const std::string out = "a." + format;
    REQUIRE(runProgram(folder, "query w/queries.json --out whole." + format).status == 0);
    const std::string whole = folder.read("whole." + format);
    for (const int count : {1, 2, 4}) {
      if (format == "npy" && count < 4) continue;  // to the ranks, answers are bytes
      CAPTURE(count);
      const Run run = runRanks(folder, count, "w/queries.json --stats s.json --out " + out);
      INFO(run.err);
      REQUIRE(run.status == 0);
      requireSame(folder.read(out), whole);
      const auto stats = nlohmann::json::parse(folder.read("s.json"));
      REQUIRE(stats["ranks"].size() == static_cast<size_t>(count));
      uint64_t queries = 0;
      for (const auto& rank : stats["ranks"]) {
        CHECK(rank["queries"] > 0);
        queries += rank["queries"].get<uint64_t>();
      }
      CHECK(queries == 100'000);
    }

    std::string parts;
    for (const std::string shard : {"0", "1", "2", "3"}) {
      const std::string name = "part-" + shard + "." + format;
      REQUIRE(runProgram(folder, "query w/queries.json --shard " + shard + "/4 --out " + name).status == 0);
      parts += " " + name;
    }
    REQUIRE(runProgram(folder, "merge --out " + out + parts).status == 0);
    requireSame(folder.read(out), whole);
  }
}

TEST_CASE("all ranks see what changes between batches") {
  const ScratchFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  nlohmann::json file = {{"format", "cyber-radar-queries-1"}, {"meshes", {"a.obj", "a.obj"}}};
  const auto raised = [](double z) { return nlohmann::json{0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, z}; };
  file["scenes"].push_back({{"id", "base"}, {"instances", {raised(9)}}});
  for (int i = 1; i <= 12; ++i) {
    nlohmann::json scene = {{"id", std::to_string(i)}, {"base", 0}, {"instances", nlohmann::json::array()}};
    for (int k = 0; k < i % 4; ++k) scene["instances"].push_back(raised(3 + 0.25 * i + k));
    if (i % 2 == 0) scene["motions"] = {{0, 0, 0, -0.5 * i}};
    if (i % 4 == 1) scene["masks"] = {{1, 2}};
    if (i % 3 == 0) {
      const float z = 0.125f * static_cast<float>(i), positions[] = {0, 0, z, 4, 0, z, 0, 4, z};
      const std::string name = "deformed-" + std::to_string(i);
      folder.write(name, std::string(reinterpret_cast<const char*>(positions), sizeof positions));
      scene["deforms"] = {{1, name}};
    }
    file["scenes"].push_back(scene);
  }
  // Scene by scene, and then one query of each in turn.
  for (int i = 0; i < 4000; ++i) {
    const int scene = i < 2000 ? i * 13 / 2000 : i % 13;
    nlohmann::json query = {{"id", "query/" + std::to_string(i)},
                            {"scene", scene},
                            {"batch", i % 2},
                            {"sensor", {1, 1, 0, 0, 0.001 * i, 0, 1, 0, 0, 0, 0, 1, 0}},
                            {"dir", {0, 0, 1}},
                            {"D", 12}};
    if (i % 5 == 0) query["mask"] = 1;
    if (i % 7 == 0) query["hits"] = "all";
    if (i % 11 == 0) query["any_hit"] = true, query.erase("hits");
    if (i % 3 == 0) query["mode"] = "reference";
    file["queries"].push_back(query);
  }
  folder.write("q.json", file.dump());
  const Run whole = runProgram(folder, "query q.json");
  REQUIRE(whole.status == 0);
  const Run run = runRanks(folder, 3, "q.json --out a.jsonl");
  INFO(run.err);
  REQUIRE(run.status == 0);
  requireSame(folder.read("a.jsonl"), whole.out);
}

TEST_CASE("when a rank is killed, the run ends, its file is resumed, and the bytes are those of one process") {
  const ScratchFolder folder;
  // Seconds of work, so that the rank is killed before it is done.
  REQUIRE(runProgram(folder, "workload interlocking --sensors 40000 --binary --out w").status == 0);
  REQUIRE(runProgram(folder, "query w/queries.json --out whole.jsonl").status == 0);
  const std::string whole = folder.read("whole.jsonl");
  const bool killsFirst = GENERATE(true, false);
  CAPTURE(killsFirst);
  // The environment names a rank's process; one that has answered something is killed.
  const std::string kill =
      "while kill -0 $! && [ \"$(head -c 100000 a.jsonl.partial 2>/dev/null | wc -c)\" -lt 100000 ]; do sleep 0.02; "
      "done\n"
      "for process in $(pgrep -P $! -f cyber-radar-mpi); do\n"
      "  if tr '\\0' '\\n' </proc/$process/environ | grep -qx OMPI_COMM_WORLD_RANK=" +
      std::string(killsFirst ? "0" : "1") + "; then kill -KILL $process; fi\ndone\nwait $!";
  const Run run = runCommand(folder, mpirun(3, "w/queries.json --out a.jsonl --threads 1") + " &\n" + kill);
  INFO(run.err);
  CHECK(run.status != 0);
  CHECK(folder.list() == "a.jsonl.partial w whole.jsonl");
  if (!killsFirst) CHECK_THAT(run.err, Contains("a.jsonl.partial has the answers so far, and --resume finishes it"));
  const std::string partial = withoutHead(folder.read("a.jsonl.partial"));
  CHECK((!partial.empty() && partial.size() < whole.size()));
  CHECK(whole.starts_with(partial));

  const std::string before = folder.read("a.jsonl.partial");
  REQUIRE(runRanks(folder, 2, "w/queries.json --out a.jsonl --resume --stats s.json").status == 0);
  requireSame(folder.read("a.jsonl"), whole);
  CHECK(nlohmann::json::parse(folder.read("s.json"))["queries"] < 40'000);
  // One process finishes what ranks began, too.
  folder.write("b.jsonl.partial", before);
  REQUIRE(runProgram(folder, "query w/queries.json --out b.jsonl --resume").status == 0);
  requireSame(folder.read("b.jsonl"), whole);
}

TEST_CASE("when rank 0 can no longer write, the run ends with a message, and its file is resumed") {
  const ScratchFolder folder;
  REQUIRE(runProgram(folder, "workload table1 --boxes 50 --sensors 100000 --binary --out w").status == 0);
  // No file may grow beyond 30000 blocks, and the system says so instead of ending the process.
  const Run run = runCommand(folder, mpirun(2, "w/queries.json --out a.jsonl", "trap '' XFSZ; ulimit -f 30000"));
  INFO(run.err);
  CHECK(run.status == 2);
  CHECK_THAT(run.err, Contains("cyber-radar-mpi: a.jsonl.partial: expected a file to write to, got File too large") &&
                          Contains("a.jsonl.partial has the answers so far, and --resume finishes it"));
  CHECK(folder.list() == "a.jsonl.partial w");
  REQUIRE(runRanks(folder, 2, "w/queries.json --out a.jsonl --resume").status == 0);
  requireSame(folder.read("a.jsonl"), runProgram(folder, "query w/queries.json").out);
}

TEST_CASE("ranks that read different query files under one name do not begin") {
  const ScratchFolder folder;
  REQUIRE(runProgram(folder, "workload table1 --boxes 20 --sensors 20 --out 0").status == 0);
  REQUIRE(runProgram(folder, "workload table1 --boxes 21 --sensors 20 --out 1").status == 0);
  const Run run = runCommand(folder, mpirun(2, "queries.json --out ../a", "cd \\$OMPI_COMM_WORLD_RANK"));
  CHECK(run.status == 2);
  CHECK_THAT(run.err, Contains("cyber-radar-mpi: rank 1 on ") && Contains("expected the query file of rank 0"));
  CHECK(folder.list() == "0 1");
}

TEST_CASE("bad input ends all ranks with one message and status 2, and leaves no file") {
  const ScratchFolder folder;
  REQUIRE(runProgram(folder, "workload table1 --boxes 20 --sensors 20 --out w").status == 0);
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    CAPTURE(arguments);
    const Run run = runRanks(folder, 2, arguments);
    CHECK(run.status == 2);
    CHECK_THAT(run.err, Contains("cyber-radar-mpi: ") && Contains(words));
    CHECK(run.err.find(words) == run.err.rfind(words));
    CHECK(folder.list() == "w");
  };
  refused("missing.json --out a", "missing.json: expected a query file");
  refused("w/queries.json --out none/a", "--out: none/a: expected a file in a folder that exists");
  refused("w/queries.json --out w/queries.json",
          "--out: w/queries.json: expected another file than those that are read");
  refused("w/queries.json --out a --mode exact", "--mode: expected mode");
  refused("w/queries.json --out a --device 7,8", "rank 0 on ");
  refused("/dev/null --out a", "FILE.json: /dev/null: expected a file that every rank can read");
  const Run full = runCommand(folder, "'" RADAR_MPI_PROGRAM "' --help >/dev/full");
  CHECK(full.status == 2);
  CHECK_THAT(full.err, Contains("standard output: expected a place to write to"));
  const Run noOut = runRanks(folder, 2, "w/queries.json");
  CHECK(noOut.status == 2);
  CHECK_THAT(noOut.err, Contains("--out is required"));
}
