// What continuous integration asks of the program: exit statuses by what is answered, and answer files compared.
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

// A triangle at z = 5; the sensors start at z = 0, or in it.
void writeQueries(const ScratchFolder& folder) {
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"],
    "scenes": [{"id": "a", "instances": [[0, 1,0,0,0, 0,1,0,0, 0,0,1,5]]}],
    "queries": [{"id": "hits", "scene": 0, "sensor": [0], "dir": [0,0,1], "D": 8},
                {"id": "misses", "scene": 0, "sensor": [0], "dir": [0,0,1], "D": 4},
                {"id": "starts", "scene": 0, "sensor": [0, 1,0,0,1, 0,1,0,0, 0,0,1,5], "dir": [0,0,1], "D": 1}]})");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != text.npos);
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("sweep --expect ends with status 1 on another answer, and an overlap is a hit") {
  const ScratchFolder folder;
  writeQueries(folder);
  const std::string sweep = "sweep a.obj a.obj --direction 0 0 1 --distance 2 --mode reference --at 0 0 ";
  const struct { const char *at, *status; } starts[] = {{"-1", "hit"}, {"0", "overlap"}, {"-3", "clear"}};
  for (const auto& [at, status] : starts) {
    for (const std::string expect : {"clear", "hit"}) {
      CAPTURE(status, expect);
      const Run run = runProgram(folder, sweep + at + " --expect " + expect);
      const bool isExpected = (status == std::string("clear")) == (expect == "clear");
      CHECK(run.status == (isExpected ? 0 : 1));
      CHECK_THAT(run.out, Contains(std::string(status) + ":"));
      CHECK(run.err == (isExpected ? "" : "cyber-radar: --expect: expected " + expect + ", got " + status + "\n"));
    }
  }
  // Nobody knows whether an answer of mode sampled without a contact is one or the other.
  for (const char* expect : {"clear", "hit"}) {
    const Run run = runProgram(folder,
                               "sweep a.obj a.obj --direction 1 0 0 --distance 2 --mode sampled --at -9 0 0 "
                               "--resolution 1 --expect " +
                                   std::string(expect));
    CHECK(run.status == (run.out.find("clear:") != run.out.npos && expect == std::string("clear") ? 0 : 1));
  }
  checkRefused(folder, sweep + "0 --expect overlap", "--expect");
}

TEST_CASE("query --fail-on ends with status 1 where an answer has such a status, and writes all answers") {
  const ScratchFolder folder;
  writeQueries(folder);
  const std::string query = "query q.json --mode reference --out a.jsonl ";
  succeed(folder, query);
  const std::string answers = folder.read("a.jsonl");
  for (const auto& [list, found] :
       {std::pair{"hit", "1 hit"}, std::pair{"clear", "1 clear"}, std::pair{"overlap,undecided", "1 overlap"},
        std::pair{"hit,overlap,undecided,invalid", "1 hit, 1 overlap"}, std::pair{"undecided", ""},
        std::pair{"invalid,undecided", ""}}) {
    CAPTURE(list);
    const Run run = runProgram(folder, query + "--fail-on " + list);
    CHECK(run.status == (*found ? 1 : 0));
    const std::string words = std::string("--fail-on: expected none of these, got ") + found + "\n";
    CHECK((run.err.find(words) != run.err.npos) == (*found != 0));
    CHECK(folder.read("a.jsonl") == answers);
  }
  for (const char* list : {"hits", "hit,", ",", "hit overlap", "HIT"}) {
    checkRefused(folder, "query q.json --fail-on '" + std::string(list) + "'",
                 "--fail-on: expected hit, clear, overlap, undecided or invalid, got");
  }
}

TEST_CASE("query --fail-on counts what an interrupted run had answered") {
  const ScratchFolder folder;
  writeQueries(folder);
  const std::string out = GENERATE("part", "part.npy");
  const std::string query = "query q.json --mode reference --shard 0/1 --resume --out " + out;
  succeed(folder, query);
  CHECK(runProgram(folder, query + " --fail-on hit").status == 1);
  CHECK(runProgram(folder, query + " --fail-on clear").status == 1);
  succeed(folder, query + " --fail-on undecided");
}

TEST_CASE("compare finds answer files of every format equal, and says the first difference") {
  const ScratchFolder folder;
  writeQueries(folder);
  succeed(folder, "query q.json --mode reference --out a.jsonl");
  succeed(folder, "query q.json --mode contact --cpu-batch 0 --out c.jsonl");
  succeed(folder, "query q.json --mode reference --out a.npy");
  succeed(folder, "query q.json --mode reference --shard 0/1 --out part");
  for (const char* b : {"a.jsonl", "c.jsonl", "a.npy", "part"}) {
    for (const char* a : {"a.jsonl", "a.npy", "part"}) {
      CAPTURE(a, b);
      const Run run = succeed(folder, "compare " + std::string(a) + " " + b);
      CHECK(run.out == "3 answers agree\n");
    }
  }
  const std::string lines = folder.read("a.jsonl");
  const struct {
    const char *from, *to, *options, *first;
  } changes[] = {
      {"\"t\": 5", "\"t\": 5.25", "--within 0.25", ""},
      {"\"t\": 5", "\"t\": 5.25", "--within 0.2", "answer 0, to query \"hits\": t: 5 in FILE, 5.25 in b.jsonl"},
      {"\"t\": 5", "\"t\": null", "--within 100", "answer 0, to query \"hits\": t: 5 in FILE, null in b.jsonl"},
      {"\"clear\"", "\"undecided\"", "", "answer 1, to query \"misses\": status: clear in FILE, undecided in b.jsonl"},
      {"\"object\": 0", "\"object\": 1", "", "answer 0, to query \"hits\": object: 0 in FILE, 1 in b.jsonl"},
      {"\"tri_b\": 0", "\"tri_b\": null", "", "answer 0, to query \"hits\": tri_b: 0 in FILE, null in b.jsonl"},
  };
  for (const auto& [from, to, options, first] : changes) {
    CAPTURE(from, to, options);
    folder.write("b.jsonl", replaced(lines, from, to));
    for (const std::string file : {"a.jsonl", "a.npy", "part"}) {
      const Run run = runProgram(folder, "compare " + file + " b.jsonl " + options);
      CHECK(run.status == (*first ? 1 : 0));
      CHECK(run.err.empty());
      CHECK(run.out == (*first ? "3 answers, 1 of them different\n" + replaced(first, "FILE", file) + "\n"
                               : "3 answers agree; distances differ by up to 0.25\n"));
    }
  }
}

TEST_CASE("compare goes through the lists of answers, too") {
  const ScratchFolder folder;
  writeQueries(folder);
  std::string queries = replaced(folder.read("q.json"), "\"D\": 8", "\"D\": 8, \"hits\": \"all\"");
  queries = replaced(queries, "\"D\": 1", "\"D\": 1, \"skip_overlapping\": true");
  folder.write("q.json", replaced(queries, "[0, 1,0,0,1, 0,1,0,0, 0,0,1,5]", "[0, 0,0,1,1, 0,1,0,1, 1,0,0,4]"));
  folder.write("a.jsonl", runProgram(folder, "query q.json --mode reference").out);
  const std::string lines = folder.read("a.jsonl");
  const size_t hits = lines.find("\"hits\": [");
  REQUIRE(hits != lines.npos);
  folder.write("b.jsonl", lines.substr(0, hits) + replaced(lines.substr(hits), "\"t\": 5", "\"t\": 6"));
  CHECK_THAT(runProgram(folder, "compare a.jsonl b.jsonl").out, Contains("hits[0].t: 5 in a.jsonl, 6 in b.jsonl"));
  folder.write("b.jsonl", replaced(lines, "\"overlapping\": [0]", "\"overlapping\": []"));
  CHECK_THAT(runProgram(folder, "compare a.jsonl b.jsonl").out, Contains("overlapping: [0] in a.jsonl, [] in b.jsonl"));
}

TEST_CASE("compare refuses what is no answer file, or is of other queries") {
  const ScratchFolder folder;
  writeQueries(folder);
  succeed(folder, "query q.json --mode reference --out a.jsonl");
  succeed(folder, "query q.json --mode reference --shard 0/1 --out part.npy");
  const std::string lines = folder.read("a.jsonl");
  folder.write("other.jsonl", replaced(lines, "\"misses\"", "\"goes by\""));
  folder.write("short.jsonl", lines.substr(0, lines.find('\n') + 1));
  folder.write("cut.jsonl", lines.substr(0, lines.size() - 9));
  checkRefused(folder, "compare a.jsonl none.jsonl", "none.jsonl: expected an answer file");
  checkRefused(folder, "compare a.jsonl q.json", "q.json: line 1: ");
  checkRefused(folder, "compare a.jsonl part.npy", "part.npy: expected an array in numpy's format");
  checkRefused(folder, "compare a.jsonl other.jsonl",
               "other.jsonl: answer 1: expected that to query \"misses\", as in a.jsonl, got that to \"goes by\"");
  checkRefused(folder, "compare a.jsonl short.jsonl", "short.jsonl: expected as many answers as in a.jsonl, got 1");
  checkRefused(folder, "compare short.jsonl a.jsonl", "short.jsonl: expected as many answers as in a.jsonl, got 1");
  checkRefused(folder, "compare a.jsonl cut.jsonl", "cut.jsonl: line 3");
  for (const char* within : {"-1", "nan", "inf"}) {
    checkRefused(folder, std::string("compare a.jsonl a.jsonl --within=") + within, "--within: expected a finite");
  }
}
