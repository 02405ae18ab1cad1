#include "cli/program.h"

#include <sys/wait.h>

#include <cstdlib>

#include "support/catch.h"

namespace radar::test {

namespace {

/// The names of the files, and what is in them.
std::string contentOf(const ScratchFolder& folder) {
  std::string all = folder.list();
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.is_regular_file()) all += folder.read(entry.path().filename());
  }
  return all;
}

}  // namespace

Run runCommand(const ScratchFolder& folder, const std::string& command) {
  const ScratchFolder output;
  const std::string out = (output.path() / "out").string(), err = (output.path() / "err").string();
  const int status = std::system(
      ("cd '" + folder.path().string() + "' && { " + command + "\n} </dev/null >'" + out + "' 2>'" + err + "'")
          .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output.read("out"), output.read("err")};
}

Run runProgram(const ScratchFolder& folder, const std::string& arguments, const std::string& environment) {
  return runCommand(folder, environment + " '" RADAR_PROGRAM "' " + arguments);
}

Run runLab(const ScratchFolder& folder, const std::string& arguments, const std::string& environment) {
  return runCommand(folder, environment + " '" RADAR_LAB "' " + arguments);
}

Run succeed(const ScratchFolder& folder, const std::string& arguments, decltype(runProgram)& run) {
  Run done = run(folder, arguments, "");
  CAPTURE(arguments, done.err);
  REQUIRE(done.status == 0);
  return done;
}

void checkRefused(const ScratchFolder& folder, const std::string& arguments, const std::string& words,
                  decltype(runProgram)& run) {
  CAPTURE(arguments);
  const std::string before = contentOf(folder);
  const Run refused = run(folder, arguments, "");
  CHECK(refused.status == 2);
  CHECK(refused.out.empty());
  CHECK_THAT(refused.err, Contains(words));
  CHECK(contentOf(folder) == before);
}

}  // namespace radar::test
