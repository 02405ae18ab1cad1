#include "cli/program.h"

#include <sys/wait.h>

#include <cstdlib>

namespace radar::test {

Run runProgram(const ScratchFolder& folder, const std::string& arguments, const std::string& environment) {
  const ScratchFolder output;
  const std::string out = (output.path() / "out").string(), err = (output.path() / "err").string();
  const std::string command = "cd '" + folder.path().string() + "' && " + environment +
                              " </dev/null '" RADAR_PROGRAM "' " + arguments + " >'" + out + "' 2>'" + err + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output.read("out"), output.read("err")};
}

}  // namespace radar::test
