// Runs in parts: shards, merge, and runs that were interrupted.
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

// Steps of a flight, each a scene and a batch of 5 queries: 60 queries.
const std::string kWorkload = "workload figure7 --teapots 5 --boxes 60 --steps 12 --out w";

std::string answersTo(const ScratchFolder& folder, const std::string& mode) {
  const Run run = succeed(folder, "query w/queries.json --out whole.jsonl --mode " + mode);
  return folder.read("whole.jsonl");
}

// The first line, which says what the file is part of.
std::string headOf(const std::string& part) {
  return part.substr(0, part.find('\n') + 1);
}

}  // namespace

TEST_CASE("shards, merged, are the bytes of one run") {
  const ScratchFolder folder;
  succeed(folder, kWorkload);
  const std::string mode = GENERATE("contact", "sampled", "reference");
  const std::string whole = answersTo(folder, mode);
  for (const int count : {1, 2, 4, 7, 100}) {
    CAPTURE(mode, count);
    if (mode == "sampled" && count != 2) continue;  // shards are the same in all modes
    std::string parts;
    for (int i = count - 1; i >= 0; --i) {
      // Most of a hundred shards have no query or one: a few runs show both.
      const std::string name = "part-" + std::to_string(i);
      if (count < 100 || i < 4) {
        const std::string shard = std::to_string(i) + "/" + std::to_string(count);
        const Run run = succeed(folder, "query w/queries.json --mode " + mode + " --shard " + shard + " --out " + name);
      }
      parts += " " + name;
    }
    if (count == 100) continue;
    const Run merged = succeed(folder, "merge" + parts + " --out merged.jsonl");
    CHECK(folder.read("merged.jsonl") == whole);
  }
}

TEST_CASE("merge writes records to .npy alone, and lines to any other file") {
  const ScratchFolder folder;
  succeed(folder, kWorkload);
  for (const std::string part : {"lines", "records.npy"}) {
    succeed(folder, "query w/queries.json --mode reference --shard 0/1 --out " + part);
  }
  checkRefused(folder, "merge lines --out z.npy",
               "z.npy: expected another file than .npy or .csv, as the shards are lines");
  checkRefused(folder, "merge records.npy --out z.jsonl", "z.jsonl: expected a file .npy, as the shards are");
  succeed(folder, "merge records.npy --out z.npy");
  CHECK(folder.read("z.npy").starts_with("\x93NUMPY"));
  CHECK(runProgram(folder, "merge lines --out /dev/stdout").out.starts_with("{\"id\""));
}

TEST_CASE("merge names shards that are missing, doubled, cut off or of another run") {
  const ScratchFolder folder;
  succeed(folder, kWorkload);
  const auto answer = [&](const std::string& shard, const std::string& out, const std::string& more = "") {
    succeed(folder, "query w/queries.json --shard " + shard + " --out " + out + more);
  };
  for (int i = 0; i < 4; ++i) answer(std::to_string(i) + "/4", "p" + std::to_string(i));
  checkRefused(folder, "merge p0 p2 --out all.jsonl",
               "all.jsonl: expected all 4 shards, missing: shard 1/4 (queries 15 to 29), shard 3/4 (queries 45 to 59)");
  checkRefused(folder, "merge p0 p1 p2 p3 p1 --out all.jsonl", "got shard 1/4 (queries 15 to 29) also in p1");
  answer("0/3", "third");
  checkRefused(folder, "merge p0 third --out all.jsonl",
               "third: shard: expected one of 4 shards, as in p0, got shard 0/3");
  answer("1/4", "other-mode", " --mode reference");
  checkRefused(folder, "merge p0 other-mode p2 p3 --out all.jsonl",
               "other-mode: mode: expected that of p0, \"contact\", got \"reference\"");
  const std::string part = folder.read("p1");
  folder.write("cut", part.substr(0, part.size() - 1));
  checkRefused(folder, "merge p0 cut p2 p3 --out all.jsonl", "cut: expected 15 answers, got 14");
  folder.write("long", part + "{}\n");
  checkRefused(folder, "merge p0 long p2 p3 --out all.jsonl",
               "long: expected nothing after the last answer, got 3 bytes");
  folder.write("odd", headOf(part) + "\n" + part.substr(headOf(part).size()));
  checkRefused(folder, "merge p0 odd p2 p3 --out all.jsonl", "odd: answer 0: expected the answer to query 15, got");
  folder.write("whole", folder.read("p1").substr(headOf(part).size()));
  checkRefused(folder, "merge p0 whole p2 p3 --out all.jsonl", "whole: line 1: expected the first line of a part file");
  checkRefused(folder, "merge p0 missing --out all.jsonl", "missing: expected a shard's answer file, got no such file");
  checkRefused(folder, "merge p0 p1 p2 p3 --out none/all.jsonl", "--out");
  // Another query file: one number differs.
  std::string queries = folder.read("w/queries.json");
  queries.replace(queries.rfind("\"D\": "), 5, "\"D\": 1");
  folder.write("w/queries.json", queries);
  answer("1/4", "other-file");
  checkRefused(folder, "merge p0 other-file p2 p3 --out all.jsonl", "other-file: fingerprint of the query file");
}

TEST_CASE("a run that was killed while it wrote is finished by --resume with the bytes of one run") {
  const ScratchFolder folder;
  succeed(folder, "workload table1 --boxes 50 --sensors 40000 --shape box --binary --out w");
  const std::string query = "query w/queries.json --mode reference ";
  const std::string whole = runProgram(folder, query).out;
  // The system ends the process when its file would grow beyond 4000 blocks, here within a line.
  runProgram(folder, query + "--out a.jsonl", "ulimit -f 4000; ");
  REQUIRE(folder.list() == "a.jsonl.partial w");
  const std::string partial = folder.read("a.jsonl.partial");
  CHECK_FALSE(partial.ends_with('\n'));
  CHECK(partial.size() > 10 * headOf(partial).size());
  CHECK(whole.starts_with(partial.substr(headOf(partial).size())));

  checkRefused(folder, query + "--out a.jsonl", "a.jsonl.partial: expected no such file");
  checkRefused(folder, "query w/queries.json --mode contact --out a.jsonl --resume",
               "a.jsonl.partial: mode: expected that of this run, \"contact\", got \"reference\"");
  checkRefused(folder, query + "--shard 0/2 --out a.jsonl --resume",
               "a.jsonl.partial: shard: expected shard 0/2, got all");
  CHECK(folder.read("a.jsonl.partial") == partial);

  succeed(folder, query + "--out a.jsonl --resume");
  CHECK(folder.read("a.jsonl") == whole);
  CHECK(folder.list() == "a.jsonl w");
}

TEST_CASE("a run with --resume keeps what is complete, wherever the file was cut") {
  const ScratchFolder folder;
  succeed(folder, kWorkload);
  const std::string query = "query w/queries.json --shard 1/2 --out part --resume";
  succeed(folder, query);
  const std::string part = folder.read("part");
  const size_t head = headOf(part).size();
  for (const size_t length : {size_t{0}, size_t{1}, head - 1, head, head + 1, part.find('\n', head) + 1,
                              part.size() / 2, part.size() - 1, part.size()}) {
    CAPTURE(length);
    folder.write("part.partial", part.substr(0, length));
    succeed(folder, query);
    CHECK(folder.read("part") == part);
    CHECK(folder.list() == "part w");
  }
  // A shard that is complete is kept, so that all of an array of jobs may be submitted again. It needs no device.
  REQUIRE(runProgram(folder, query, "VK_DRIVER_FILES=/nowhere.json VK_ICD_FILENAMES=/nowhere.json").status == 0);
  CHECK(folder.read("part") == part);
  checkRefused(folder, query + " --mode reference", "part: mode: expected that of this run");
  CHECK(folder.read("part") == part);

  std::string wrong = part;
  wrong.replace(wrong.find("teapot", head), 6, "kettle");
  folder.write("part.partial", wrong);
  checkRefused(folder, query, "part.partial: answer 0: expected the answer to query");
  folder.write("part.partial", part + part.substr(head));
  checkRefused(folder, query, "part.partial: expected nothing after the last answer");
}

TEST_CASE("bad shards and options without a file are refused by name") {
  const ScratchFolder folder;
  succeed(folder, kWorkload);
  for (const char* shard : {"1", "2/2", "0/0", "-1/2", "1/2/3", "a/b", "0/99999999999"}) {
    checkRefused(folder, std::string("query w/queries.json --out a --shard ") + shard, "--shard: expected I/N");
  }
  checkRefused(folder, "query w/queries.json --shard 0/2", "--shard: expected --out beside it");
  checkRefused(folder, "query w/queries.json --resume", "--resume: expected --out beside it");
}
