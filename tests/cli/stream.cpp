// Queries as they come, and query files that are only checked.
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "batch/query_file.h"
#include "cli/program.h"
#include "cyber_radar/line_input.h"
#include "support/catch.h"

using namespace radar::test;
using radar::tools::LineInput;

namespace {

const std::string kStream = "'" RADAR_PROGRAM "' stream ";

/// A query of a triangle that moves up from z.
std::string line(const std::string& id, double z, const std::string& more = "") {
  return R"({"id": ")" + id + R"(", "scene": 0, "sensor": [0, 1,0,0,0, 0,1,0,0, 0,0,1,)" + std::to_string(z) +
         R"(], "dir": [0,0,1], "D": 8)" + more + "}\n";
}

void writeScene(const ScratchFolder& folder, const std::string& queries = "") {
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"],
    "scenes": [{"id": "a", "instances": [[0]]}], "queries": [)" +
                             queries + "]}");
}

/// The answers' ids and t.
std::string briefly(const std::string& lines) {
  std::istringstream stream(lines);
  std::string text;
  for (std::string one; std::getline(stream, one);) {
    const auto answer = nlohmann::json::parse(one);
    text += answer["id"].get<std::string>() + " " + answer["t"].dump() + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("each query of a stream gets its answer before the next one is written") {
  const ScratchFolder folder;
  writeScene(folder);
  for (int i = 0; i < 3; ++i) folder.write(std::to_string(i), line("q" + std::to_string(i), -1 - i));
  folder.write("try.sh", "coproc R { " + kStream +
                             "q.json; }\n"
                             "in=${R[0]} out=${R[1]} pid=$R_PID\n"
                             "for i in 0 1 2; do cat $i >&$out; read -r answer <&$in; echo \"$answer\"; done\n"
                             "eval \"exec $out>&-\"; wait $pid; echo \"status $?\" >&2\n");
  const Run run = runCommand(folder, "bash try.sh");
  CHECK(briefly(run.out) == "q0 1\nq1 2\nq2 3\n");
  CHECK_THAT(run.err, Contains("answered 3 queries in 3 batches: 3 hit") && Contains("status 0"));
}

TEST_CASE("a thousand queries at once are answered as in a file, whatever chooses their modes") {
  const ScratchFolder folder;
  succeed(folder, "workload soup --objects 10 --sensors 1000 --triangles 6 --out w");
  auto file = nlohmann::json::parse(folder.read("w/queries.json"));
  REQUIRE(file["queries"].size() == 1000);
  for (size_t i = 0; i < 1000; i += 3) file["queries"][i]["mode"] = i % 2 == 0 ? "reference" : "sampled";
  for (size_t i = 1; i < 1000; i += 3) file["queries"][i]["hits"] = "all";
  folder.write("w/queries.json", file.dump());
  std::string lines;
  for (const auto& query : file["queries"]) lines += query.dump() + "\n";
  file["queries"] = nlohmann::json::array();
  folder.write("w/world.json", file.dump());
  lines.pop_back();  // the last line may have no end
  folder.write("lines", lines);
  const Run expected = runProgram(folder, "query w/queries.json"),
            run = runProgram(folder, "stream w/world.json <lines");
  CHECK(run.status == expected.status);
  CHECK_FALSE(run.out.empty());
  CHECK(run.out == expected.out);
  CHECK(runCommand(folder, "cat lines | " + kStream + "w/world.json").out == expected.out);
}

TEST_CASE("sensors of a stream are where the numbers of a scaled mesh far away put them") {
  const ScratchFolder folder;
  folder.write("far away.obj",
               "v 512340678 4512350123 296250\nv 512341678 4512350123 296250\n"
               "v 512340678 4512351123 296250\nf 1 2 3\n");
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": [{"file": "far away.obj", "scale": 0.001}],
    "scenes": [{"instances": [[0, 1,0,0,-512340, 0,1,0,-4512350, 0,0,1,0]]}], "queries": []})");
  folder.write("lines", R"({"id": "a", "scene": 0, "sensor": [0, 1,0,0,-512340, 0,1,0,-4512350, 0,0,1,-2.5],)"
                        R"( "dir": [0,0,1], "D": 8})");
  const Run run = succeed(folder, "stream q.json <lines");
  CHECK(nlohmann::json::parse(run.out)["t"].get<double>() == Approx(2.5).epsilon(0).margin(1e-9));
}

TEST_CASE("a bad line of a stream is named, after the answers to those before it") {
  const ScratchFolder folder;
  writeScene(folder, line("own", -5));
  for (const auto& [bad, words] : {std::pair{"{\"id\": \"x\"}\n", "standard input:3: expected the key \"scene\""},
                                   std::pair{"{\n", "standard input:3: expected valid JSON"},
                                   std::pair{"\n", "standard input:3: expected valid JSON"},
                                   std::pair{"7\n", "standard input:3: expected an object, got 7"}}) {
    folder.write("lines", line("a", -1) + line("a", -2) + bad + line("b", -3));
    const Run run = runProgram(folder, "stream q.json <lines");
    CHECK(run.status == 2);
    CHECK_THAT(run.err, Contains(words));
    CHECK(briefly(run.out) == "own 5\na 1\na 2\n");
  }
  folder.write("lines", line("a", -1, ", \"dir\": [0,0,0]"));
  CHECK_THAT(runProgram(folder, "stream q.json <lines").err,
             Contains("standard input:1: ") && Contains("\"dir\" twice"));
  folder.write("lines", line("a", -1, ", \"hits\": 2"));
  CHECK_THAT(runProgram(folder, "stream q.json --mode sampled <lines").err,
             Contains("standard input:1: expected the mode contact or reference, as \"hits\" needs"));
  succeed(folder, "stream q.json --mode reference <lines");
}

TEST_CASE("a query that only the engine can refuse is named, too") {
  const ScratchFolder folder;
  const std::string slack = ", \"skip_overlapping\": true, \"slack\": 3",
                    words = "expected at most a tenth of the sensor's";
  const std::string bad = line("bad", -2, slack);
  writeScene(folder);
  folder.write("lines",
               line("a", -1) + line("b", -1, ", \"batch\": 1") + bad + line("c", -3, ", \"batch\": 1" + slack));
  const Run run = runProgram(folder, "stream q.json <lines");
  CHECK(run.status == 2);
  CHECK_THAT(run.err, Contains("standard input:3: slack: " + words));
  CHECK(briefly(run.out) == "a 1\nb 1\n");
  folder.write("lines", line("a", -1) + line("b", -1, ", \"batch\": 1" + slack) + bad);
  CHECK_THAT(runProgram(folder, "stream q.json <lines").err, Contains("standard input:2: slack: " + words));
  writeScene(folder, line("a", -1) + "," + bad);
  checkRefused(folder, "query q.json", "q.json: queries[1].slack: " + words);
  checkRefused(folder, "query q.json --check", "q.json: queries[1].slack: " + words);
  checkRefused(folder, "view q.json --out q.html", "q.json: query \"bad\": slack: " + words);
}

TEST_CASE("a cutter that is not placed rigidly is refused at its place, in JSON, arrays and lines") {
  const ScratchFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  nlohmann::json file = nlohmann::json::parse(R"({"format": "cyber-radar-queries-1",
    "meshes": ["a.obj", {"shape": "flat", "radius": 1, "length": 5}], "scenes": [{"id": "a", "instances": [[0]]}]})");
  nlohmann::json query = {{"id", "p"}, {"scene", 0}, {"sensor", {1}}, {"dir", {0, 0, -1}}, {"D", 8}};
  file["queries"] = {query};
  query["id"] = "grown";
  query["sensor"] = {1, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 5};
  file["queries"].push_back(query);
  folder.write("q.json", file.dump());
  const std::string words = "a cutter: expected a rigid pose";
  for (const char* check : {"", " --check"}) {
    checkRefused(folder, std::string("query q.json") + check, "q.json: queries[1].sensor: " + words);
  }
  std::vector<std::string> warnings;
  const radar::tools::Workload workload = radar::tools::QueryFile((folder.path() / "q.json").string(), warnings).all();
  radar::tools::writeQueryFile(workload, folder.path() / "arrays", true);
  // A cutter has no file.
  nlohmann::json arrays = nlohmann::json::parse(folder.read("arrays/queries.json"));
  arrays["meshes"][1] = file["meshes"][1];
  folder.write("arrays/queries.json", arrays.dump());
  checkRefused(folder, "query arrays/queries.json", "arrays/queries.npy: pose[1]: " + words);
  file["queries"].erase(1);
  folder.write("q.json", file.dump());
  folder.write("lines", query.dump() + "\n");
  const Run run = runProgram(folder, "stream q.json <lines");
  CHECK(run.status == 2);
  CHECK_THAT(run.err, Contains("standard input:1: sensor: " + words));
}

TEST_CASE("a stream ends with its input, which is not the query file") {
  const ScratchFolder folder;
  writeScene(folder);
  const Run none = runProgram(folder, "stream q.json");
  CHECK((none.status == 0 && none.out.empty()));
  checkRefused(folder, "stream -", "FILE.json: expected a file, as standard input has the queries");
  checkRefused(folder, "stream no.json", "no.json: expected a query file");
  checkRefused(folder, "stream q.json <.", "standard input: expected lines, one for each query, got an error");
}

TEST_CASE("lines come as they are written, in any pieces") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  LineInput input(ends[0], "pipe");
  const auto write = [&](const std::string& text) { REQUIRE(::write(ends[1], text.data(), text.size()) > 0); };
  write("one\ntw");
  CHECK(input.next() == std::vector<std::string>{"one"});
  CHECK(input.placeOf(0) == "pipe:1");
  write("o\n\nthree\nfo");
  CHECK(input.next() == std::vector<std::string>{"two", "", "three"});
  CHECK(input.placeOf(2) == "pipe:4");
  close(ends[1]);
  CHECK(input.next() == std::vector<std::string>{"fo"});
  CHECK(input.placeOf(0) == "pipe:5");
  CHECK(input.next().empty());
  CHECK(input.next().empty());
  close(ends[0]);
}

TEST_CASE("a line without end is refused before it fills the memory") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  LineInput input(ends[0], "pipe");
  std::jthread writer([&] {
    const std::string much(size_t{1} << 20, ' ');
    for (int i = 0; i < 66; ++i) {
      for (size_t done = 0; done < much.size();) {
        const ssize_t count = ::write(ends[1], much.data() + done, much.size() - done);
        if (count > 0) done += static_cast<size_t>(count);
      }
    }
    close(ends[1]);
  });
  CHECK_THROWS_WITH(input.next(), "pipe:1: expected a line of at most 64 MiB, got more");
  char rest[4096];
  while (read(ends[0], rest, sizeof rest) > 0) {
  }
  close(ends[0]);
}

TEST_CASE("query --check reads everything as query does, says what there is, and answers nothing") {
  const ScratchFolder folder;
  writeScene(folder,
             line("a", -1) + "," + line("b", -2, ", \"mode\": \"sampled\"") + "," + line("c", -3, ", \"hits\": 2"));
  const std::string before = folder.list(), noDriver = "VK_DRIVER_FILES=/nowhere.json VK_ICD_FILENAMES=/nowhere.json";
  const Run run = runProgram(folder, "query q.json --check --out a.jsonl", noDriver);
  CHECK(run.status == 0);
  CHECK(run.out ==
        "q.json: 1 mesh of 1 triangle, 1 scene of 1 object (0 with masks, motions or deforms), 3 queries: 1 sampled, "
        "2 contact\n");
  CHECK(folder.list() == before);
  checkRefused(folder, "query q.json --check --mode sampled", "--mode: expected contact or reference");
  checkRefused(folder, "query q.json --check --out a.npy", "--out: a.npy: expected another file than .npy");
  checkRefused(folder, "query q.json --check --out q.json", "--out: q.json: expected another file than");
  writeScene(folder, line("a", -1) + "," + line("a", -2));
  checkRefused(folder, "query q.json --check", "queries[1].id: expected an id that no other query has");
  succeed(folder, "workload figure7 --teapots 3 --boxes 40 --steps 3 --binary --out w");
  CHECK_THAT(runProgram(folder, "query w/queries.json --check --mode reference").out,
             Contains(" queries: 9 reference\n"));
}
