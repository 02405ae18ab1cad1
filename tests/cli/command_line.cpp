// What the program says about itself, about words that it does not know, and about its work.
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program.h"
#include "cyber_radar/progress.h"
#include "support/catch.h"

using radar::test::checkRefused;
using radar::test::Contains;
using radar::test::Run;
using radar::test::runCommand;
using radar::test::runProgram;
using radar::test::ScratchFolder;
using radar::test::StartsWith;

TEST_CASE("a word that is no command or option is named, with the nearest that is one") {
  const ScratchFolder folder;
  for (const auto& [arguments, words] :
       {std::pair{"swep a b", "cyber-radar: expected a command, got \"swep\"; did you mean sweep?"},
        std::pair{"chrat", "got \"chrat\"; did you mean chart?"},
        std::pair{"self", "got \"self\"; did you mean selftest?"},
        std::pair{"frobnicate", "expected a command, got \"frobnicate\"\n"},
        std::pair{"", "expected a command, got none\ncyber-radar --help explains"},
        std::pair{"workload tabel1 --out x",
                  "cyber-radar workload: expected a command, got \"tabel1\"; did you mean table1?"},
        std::pair{"sweep a b --directon 1 0 0 --distance 1",
                  "cyber-radar sweep: expected one of its options, got \"--directon\"; did you mean --direction?"},
        std::pair{"query --statsu s q.json", "got \"--statsu\"; did you mean --stats?"},
        std::pair{"query q.json second third", "cyber-radar query: expected nothing more, got \"second third\"\n"},
        std::pair{"sweep a", "cyber-radar sweep: SENSOR is required\ncyber-radar sweep --help explains"}}) {
    checkRefused(folder, arguments, words);
  }
}

TEST_CASE("the program tells its version, and devices are listed for programs, too") {
  const ScratchFolder folder;
  const Run version = runProgram(folder, "--version");
  CHECK(version.status == 0);
  CHECK_THAT(version.out, StartsWith("cyber-radar 0.") && Contains(", commit "));
  const auto devices = nlohmann::json::parse(runProgram(folder, "devices --json").out);
  CHECK((devices[0]["number"] == 0 && devices[0]["usable"] == true && devices[0]["limits"].size() > 9));
}

TEST_CASE("a run ends with a line that says what was done, and how fast") {
  const ScratchFolder folder;
  CHECK(runProgram(folder, "workload table1 --boxes 9 --sensors 1 --out one").out ==
        "one/queries.json: 1 query, 1 scene, 2 meshes\n");
  CHECK_THAT(runProgram(folder, "query one/queries.json").err, Contains("cyber-radar: answered 1 query in "));
  REQUIRE(runProgram(folder, "workload figure7 --teapots 5 --boxes 60 --steps 12 --out w").status == 0);
  const Run run = runProgram(folder, "query w/queries.json --shard 0/2 --out part");
  CHECK_THAT(run.err,
             Contains("cyber-radar: answered 30 queries in ") && Contains(" per second): ") && Contains(" clear"));
  CHECK_THAT(runProgram(folder, "query w/queries.json --shard 0/2 --out part --resume").err,
             Contains("answered 0 queries in ") && Contains("; 30 had been answered before\n"));
}

TEST_CASE("a bar tells how far the work is, and how long the rest will take") {
  using namespace radar::tools;
  const std::string half = std::string(20, '#') + std::string(20, '.');
  CHECK(progressInWords("answering", 30, 60, 12) == "answering [" + half + "] 30 of 60, 12 s left");
  CHECK(progressInWords("answering", 0, 60, 12) == "answering [" + std::string(40, '.') + "] 0 of 60");
  CHECK(progressInWords("answering", 60, 60, 12) == "answering [" + std::string(40, '#') + "] 60 of 60");
  CHECK_THAT(progressInWords("x", 1, 1001, 8), Contains(", 2 h 13 min left"));
  CHECK((inTime(0.3149) == "0.31 s" && inTime(59.6) == "1 min 0 s" && inTime(192) == "3 min 12 s"));
}

TEST_CASE("bash completes commands, options and the words that an option takes") {
  const ScratchFolder folder;
  folder.write("try.sh",
               "source <('" RADAR_PROGRAM
               "' completion bash)\n"
               "try() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _cyber_radar; echo \"${COMPREPLY[*]}\"; }\n"
               "try cyber-radar st; try cyber-radar workload t; try cyber-radar query --mo\n"
               "try cyber-radar query --mode ''; try cyber-radar query --mode = sa\n"
               "try cyber-radar workload table1 --shape b; try cyber-radar query ''\n");
  const Run run = runCommand(folder, "bash try.sh");
  CHECK(run.err.empty());
  CHECK(run.out == "stability\ntable1\n--mode\nsampled contact reference\nsampled\nbox\n\n");
}

TEST_CASE("the manual and the completions of every shell have every option of every command") {
  const ScratchFolder folder;
  const auto printed = [&](const std::string& arguments) {
    const Run run = runProgram(folder, arguments);
    REQUIRE(run.status == 0);
    return run.out;
  };
  std::string manual = printed("man");
  CHECK_THAT(manual, StartsWith(".TH CYBER"));
  for (size_t at = 0; (at = manual.find("\\-", at)) != manual.npos;) manual.erase(at, 1);
  const std::string fish = printed("completion fish"), zsh = printed("completion zsh"),
                    bash = printed("completion bash");
  size_t options = 0;
  for (const char* command : {"", "sweep", "query", "chart", "workload figure7"}) {
    std::istringstream help(printed(std::string(command) + " --help"));
    for (std::string line; std::getline(help, line);) {
      if (!line.starts_with("  --")) continue;
      const std::string name = line.substr(2, line.find_first_of(" =[", 2) - 2);
      CAPTURE(command, name);
      CHECK_THAT(manual, Contains("\n.B " + name));
      CHECK_THAT(fish, Contains("-l " + name.substr(2) + " "));
      CHECK_THAT(zsh, Contains("'" + name + "["));
      CHECK_THAT(bash, Contains(name));
      ++options;
    }
  }
  CHECK(options > 30);
}
