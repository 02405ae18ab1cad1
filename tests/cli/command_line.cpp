// What the program says about itself, about words that it does not know, and about its work.
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/program.h"
#include "cyber_radar/progress.h"
#include "support/catch.h"

using namespace radar::test;

TEST_CASE("a word that is no command or option is named, with the nearest that is one") {
  const ScratchFolder folder;
  for (const auto& [arguments, words] :
       {std::pair{"swep a b", "cyber-radar: expected a command, got \"swep\"; did you mean sweep?"},
        std::pair{"veiw", "got \"veiw\"; did you mean view?"},
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
  const Run version = succeed(folder, "--version");
  CHECK_THAT(version.out, StartsWith("cyber-radar 0.") && Contains(", commit "));
  const auto devices = nlohmann::json::parse(runProgram(folder, "devices --json").out);
  CHECK((devices[0]["number"] == 0 && devices[0]["usable"] == true && devices[0]["limits"].size() > 9));
}

TEST_CASE("a run ends with a line that says what was done, and how fast") {
  const ScratchFolder folder;
  CHECK(runProgram(folder, "workload table1 --boxes 9 --sensors 1 --out one").out ==
        "one/queries.json: 1 query, 1 scene, 2 meshes\n");
  CHECK_THAT(runProgram(folder, "query one/queries.json").err, Contains("cyber-radar: answered 1 query in "));
  succeed(folder, "workload figure7 --teapots 5 --boxes 60 --steps 12 --out w");
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
               "try cyber-radar se; try cyber-radar workload t; try cyber-radar query --mo\n"
               "try cyber-radar query --mode ''; try cyber-radar query --mode = sa\n"
               "try cyber-radar workload table1 --shape b; try cyber-radar query ''\n");
  const Run run = runCommand(folder, "bash try.sh");
  CHECK(run.err.empty());
  CHECK(run.out == "selftest\ntable1\n--mode\nsampled contact reference\nsampled\nbox\n\n");
}

TEST_CASE("the manual and the completion have the options of each command that its help has, and no others") {
  const ScratchFolder folder;
  const std::string manual = runProgram(folder, "man").out;
  CHECK_THAT(manual, StartsWith(".TH CYBER"));
  for (const std::string command : {"sweep", "query", "scale", "workload figure7"}) {
    CAPTURE(command);
    std::set<std::string> inHelp, inManual, inBash;
    std::istringstream help(runProgram(folder, command + " --help").out);
    for (std::string line; std::getline(help, line);) {
      if (const size_t at = line.find("--"); at <= 5 && at != line.npos) {
        inHelp.insert(line.substr(at, line.find_first_of(" =[", at) - at));
      }
    }
    const size_t begin = manual.find("\n.SS " + command + "\n");
    REQUIRE(begin != manual.npos);
    std::istringstream section(manual.substr(begin + 1, manual.find("\n.SS ", begin + 1) - begin - 1));
    for (std::string line; std::getline(section, line);) {
      if (!line.starts_with(".B \\-\\-")) continue;
      std::string name = line.substr(3, line.find(' ', 3) - 3);
      for (size_t at = 0; (at = name.find("\\-", at)) != name.npos;) name.erase(at, 1);
      inManual.insert(name);
    }
    folder.write("try.sh", "source <('" RADAR_PROGRAM "' completion bash)\nCOMP_WORDS=(cyber-radar " + command +
                               " --); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _cyber_radar; echo \"${COMPREPLY[*]}\"\n");
    std::istringstream words(runCommand(folder, "bash try.sh").out);
    for (std::string word; words >> word;) inBash.insert(word);
    CHECK(inHelp.size() > 4);
    CHECK(inManual == inHelp);
    CHECK(inBash == inHelp);
  }
}
