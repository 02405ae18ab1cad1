// What a command writes: never what it reads, nor what another process writes; and straight to devices and pipes.
#include <sys/stat.h>

#include <filesystem>

#include "batch/binary_queries.h"
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

// Names every kind of file that a query file may name; links and other names lead to some of them.
void makeFiles(const ScratchFolder& folder) {
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\no one\nf 1 2 3\n");
  radar::tools::writePlaced(std::vector<radar::tools::Instance>{{0, {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5}}}},
                            folder.path() / "a.npy");
  const float positions[9] = {0, 0, 0, 4, 0, 0, 0, 4, 0};
  folder.write("a.f32", {reinterpret_cast<const char*>(positions), sizeof positions});
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj#one"],
    "scenes": [{"instances_file": "a.npy"}, {"instances": [[0]], "deforms": [[0, "a.f32"]]}, {"assembly": "a.obj"}],
    "queries": [{"id": "p", "scene": 0, "sensor": [0], "dir": [0,0,1], "D": 8}]})");
  std::filesystem::create_symlink("q.json", folder.path() / "link");
  std::filesystem::create_symlink("nothing-yet", folder.path() / "ahead");
  std::filesystem::create_hard_link(folder.path() / "a.obj", folder.path() / "second-name");
  std::filesystem::create_directory(folder.path() / "d");
}

const std::string kProgram = "'" RADAR_PROGRAM "' ";
const std::string kQuery = "query q.json --mode reference ";

}  // namespace

TEST_CASE("an output that is an input, by whatever name, is refused before any work") {
  const ScratchFolder folder;
  makeFiles(folder);
  for (const char* option : {"--out", "--stats"}) {
    for (const char* file : {"q.json", "./d/../q.json", "link", "a.obj", "second-name", "a.npy", "a.f32"}) {
      checkRefused(folder, kQuery + option + " " + file,
                   std::string(option) + ": " + file + ": expected another file than those that are read, got ");
    }
  }
  checkRefused(folder, "query - --out q.json <q.json", "--out: q.json: expected another file than");
  folder.write("a.partial", folder.read("q.json"));
  checkRefused(folder, "query a.partial --out a", "--out: a.partial: expected another file than");
  succeed(folder, kQuery + "--shard 0/1 --out part");
  checkRefused(folder, "merge part --out ./part", "--out: ./part: expected another file than");
  REQUIRE(runCommand(folder, "cp q.json a.* d; cd d; cp q.json scopes.json; cp q.json trace.json").status == 0);
  checkRefused(folder, "scopes d/scopes.json --query p --out d", "--out: d/scopes.json: expected another file than");
  checkRefused(folder, "scale d/trace.json --out d", "--out: d/trace.json: expected another file than");
  REQUIRE(runCommand(folder, kProgram + "workload meshes --mesh a.obj --objects 2 --sensors 1 --out w").status == 0);
  checkRefused(folder, "workload meshes --mesh a.obj w/mesh-0.ply --out w",
               "--out: w/mesh-0.ply: expected another file than");
}

TEST_CASE("two outputs in one file are refused, and links are written through") {
  const ScratchFolder folder;
  makeFiles(folder);
  for (const char* files :
       {"--out a --stats ./a", "--out a --stats a.partial", "--out ahead --stats d/../nothing-yet"}) {
    checkRefused(folder, kQuery + files, "expected a file of its own, got that of --out");
  }
  succeed(folder, kQuery + "--out ahead --stats /dev/null");
  CHECK(std::filesystem::is_symlink(folder.path() / "ahead"));
  CHECK(folder.read("nothing-yet") == runProgram(folder, kQuery).out);
}

TEST_CASE("devices and pipes get their bytes at once") {
  const ScratchFolder folder;
  makeFiles(folder);
  const std::string answers = runProgram(folder, kQuery).out;
  REQUIRE(mkfifo((folder.path() / "pipe").c_str(), 0600) == 0);
  const auto readPipe = [&](const std::string& command) {
    const Run run = runCommand(folder, "cat pipe & " + kProgram + command + " || echo failed >pipe; wait $!");
    INFO(command + "\n" + run.err);
    return run.out;
  };
  CHECK(readPipe(kQuery + "--out pipe") == answers);
  CHECK_THAT(readPipe(kQuery + "--stats pipe --out a"), Contains("\"queries\": 1,"));
  succeed(folder, kQuery + "--shard 0/1 --out part");
  CHECK(readPipe(kQuery + "--shard 0/1 --out pipe") == folder.read("part"));
  CHECK(readPipe("merge part --out pipe") == answers);
  CHECK(std::filesystem::is_fifo(folder.path() / "pipe"));
  succeed(folder, kQuery + "--out /dev/null --stats /dev/null");
  CHECK(runProgram(folder, kQuery + "--out /dev/stdout | cat").out == answers);
  CHECK_THAT(runProgram(folder, kQuery + "--out /dev/full").err,
             Contains("/dev/full: expected a file to write to, got No space"));
  checkRefused(folder, kQuery + "--out /dev/null --resume",
               "--resume: /dev/null: expected a file, got a device or a pipe");
}

TEST_CASE("while a run writes its file, no other run does") {
  const ScratchFolder folder;
  succeed(folder, "workload interlocking --sensors 3000 --binary --out w");
  const std::string query = kProgram + "query w/queries.json --mode reference --out a ";
  // The first run is stopped while it writes.
  const Run run =
      runCommand(folder, query + "& until [ -s a.partial ] || ! kill -0 $!; do sleep 0.01; done; kill -STOP $!\n" +
                             query + "; echo $?\n" + query + "--resume; echo $?; kill -CONT $!; wait $!; echo $?");
  CHECK(run.out == "2\n2\n0\n");
  const std::string words = "a.partial: expected a file of this process alone, got one that another is writing";
  CHECK(run.err.find(words) != run.err.rfind(words));
  CHECK(folder.list() == "a w");
}

TEST_CASE("a file or link that waits where a run writes is not followed, emptied or removed") {
  const ScratchFolder folder;
  makeFiles(folder);
  // A file of somebody else's, with and without the end of a line.
  for (const std::string text : {"precious", "precious\n", "{\"format\": \"mine\"}\n"}) {
    folder.write("a.partial", text);
    checkRefused(folder, kQuery + "--out a", "a.partial: line 1: expected the first line of a part file");
    checkRefused(folder, kQuery + "--out a --resume", "a.partial: line 1: expected the first line of a part file");
    folder.write("part", text);
    checkRefused(folder, kQuery + "--out part --shard 0/1 --resume", "part: line 1: expected the first line");
  }
  std::filesystem::remove(folder.path() / "a.partial");
  std::filesystem::create_symlink("part", folder.path() / "a.partial");
  checkRefused(folder, kQuery + "--out a --resume", "a.partial: expected a file to write to, got a symbolic link");
  std::filesystem::remove(folder.path() / "a.partial");
  // exec: the program has the shell's number.
  const Run run = runCommand(folder, "sh -c 'ln -s part stats.unfinished-$$; exec " + std::string(RADAR_PROGRAM) +
                                         " query q.json --stats stats'");
  INFO(run.err);
  CHECK(run.status == 0);
  CHECK_THAT(folder.read("stats"), Contains("\"queries\": 1,"));
  CHECK(folder.read("part") == "{\"format\": \"mine\"}\n");
}
