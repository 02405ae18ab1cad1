#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

constexpr const char* kMesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string queryFile(const std::string& query, const std::string& mesh = "a.obj") {
  return R"({"format": "cyber-radar-queries-1", "meshes": [")" + mesh +
         R"("], "scenes": [{"id": "a", "instances": [[0, 1,0,0,0, 0,1,0,0, 0,0,1,5]]}],)" + "\n \"queries\": [" +
         query + "]}";
}

constexpr const char* kGood = R"({"id": "p", "scene": 0, "batch": 0, "sensor": [0], "dir": [0,0,1], "D": 8})";

}  // namespace

TEST_CASE("a bad query file ends with status 2, a message that names the place, and no output") {
  const ScratchFolder folder;
  folder.write("a.obj", kMesh);
  folder.write("answers.jsonl", "what was there before\n");
  const std::string whole = queryFile(kGood);
  // What else is refused, tests/unit/query_file_reading.cpp has.
  for (const auto& [text, words] : {std::pair{queryFile(kGood, "missing.obj"), "missing.obj: expected a mesh file"},
                                    std::pair{queryFile(R"({"id": "p", "sensor": [0], "dir": [0,0,1], "D": 8})"),
                                              "q.json: queries[0]: expected the key \"scene\", the number of the "
                                              "query's scene, from 0, which is missing"},
                                    std::pair{whole.substr(0, whole.size() - 9), "line 2"}}) {
    folder.write("q.json", text);
    checkRefused(folder, "query q.json --out answers.jsonl --stats stats.json", words);
  }
}

TEST_CASE("the message about a missing query file names it") {
  const ScratchFolder folder;
  checkRefused(folder, "query no.json", "no.json: expected a query file");
}

TEST_CASE("the message about an unknown option or a bad value names it") {
  const ScratchFolder folder;
  folder.write("a.obj", kMesh);
  folder.write("q.json", queryFile(kGood));
  for (const auto& [options, words] :
       {std::pair{"--mode exact", "--mode: expected mode"}, std::pair{"--mode exact", "got \"exact\""},
        std::pair{"--mode bounded", "expected mode sampled, contact or reference, got \"bounded\""},
        std::pair{"--tolerance 1", "--tolerance"}, std::pair{"--resolution 0", "--resolution"},
        std::pair{"--resolution 4096", "--resolution"}, std::pair{"--resolution 64x", "\"64x\""},
        std::pair{"--repeat 0", "--repeat"}, std::pair{"--device ''", "--device: expected all or numbers"},
        std::pair{"--fast", "--fast"}, std::pair{"--out no/folder.jsonl", "no/folder.jsonl"},
        std::pair{"--stats no/s.json", "no/s.json"}}) {
    checkRefused(folder, std::string("query q.json ") + options, words);
  }
}

TEST_CASE("sweep refuses bad numbers and files and names the option or the file") {
  const ScratchFolder folder;
  folder.write("a.obj", kMesh);
  for (const auto& [arguments, words] :
       {std::pair{"a.obj b.obj --direction 0 0 1 --distance 1", "b.obj: expected a mesh file"},
        std::pair{"a.obj a.obj --direction 0 0 0 --distance 1", "--direction"},
        std::pair{"a.obj a.obj --direction 0 0 inf --distance 1", "--direction"},
        std::pair{"a.obj a.obj --direction 0 1 --distance 1", "--direction"},
        std::pair{"a.obj a.obj --direction 0 0 1", "--distance"}, std::pair{"a.obj a.obj --distance 1", "--direction"},
        std::pair{"a.obj a.obj --direction 0 0 1 --distance -1", "--distance"},
        std::pair{"a.obj a.obj --direction 0 0 1 --distance nan", "--distance: expected finite numbers, got nan\n"},
        std::pair{"a.obj a.obj --direction 0 0 1 --distance 1 --clearance=-1e300", "0 or more, got -1e+300\n"},
        std::pair{"a.obj a.obj --direction 0 0 1 --distance 1 --at 0 nan 0", "--at"},
        std::pair{"a.obj a.obj --direction 0 0 1 --distance 1 --rotate 0 0 0 9", "--rotate"},
        std::pair{"a.obj a.obj --direction 0 0 1 --distance 1 --speed 0", "--speed"},
        std::pair{"a.obj --direction 0 0 1 --distance 1", "SENSOR"}}) {
    checkRefused(folder, std::string("sweep ") + arguments, words);
  }
}

TEST_CASE("scopes names an option that is missing or does not apply") {
  const ScratchFolder folder;
  folder.write("a.obj", kMesh);
  folder.write("q.json", queryFile(kGood));
  for (const auto& [arguments, words] :
       {std::pair{"q.json --out p", "--query"}, std::pair{"q.json --query x --out p", "the id \"x\""},
        std::pair{"q.json --query p", "--out"}, std::pair{"a.obj a.obj --query p --out p", "--query"},
        std::pair{"q.json --query p --out p --distance 3", "--distance"}}) {
    checkRefused(folder, std::string("scopes ") + arguments, words);
  }
}

TEST_CASE("without a Vulkan driver the program explains how to get one, and mode reference still answers") {
  const ScratchFolder folder;
  folder.write("a.obj", kMesh);
  folder.write("q.json", queryFile(kGood));
  const std::string noDriver = "VK_DRIVER_FILES=/nowhere.json VK_ICD_FILENAMES=/nowhere.json VK_INSTANCE_LAYERS=";
  for (const char* arguments : {"query q.json --out a.jsonl", "query q.json --mode sampled --out a.jsonl", "devices",
                                "scopes q.json --query p --out pictures"}) {
    CAPTURE(arguments);
    const Run run = runProgram(folder, arguments, noDriver);
    CHECK(run.status == 2);
    CHECK_THAT(run.out + run.err, Contains("apt install mesa-vulkan-drivers"));
  }
  CHECK(runProgram(folder, "query q.json --mode reference", noDriver).status == 0);
  CHECK(folder.list() == "a.obj q.json");
}
