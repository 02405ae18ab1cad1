#include "plot/plot.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace radar::tools {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& problem) {
  throw std::runtime_error("gnuplot, which draws the charts, " + problem);
}

// Unnamed files: with pipes on both sides, both programs could wait for each other.
File openFile() {
  File file(std::tmpfile(), std::fclose);
  if (!file) fail(std::string("cannot be given a script: ") + std::strerror(errno));
  return file;
}

// What gnuplot writes to its standard output for a script and its arguments, which are never parsed as commands.
std::string gnuplot(const std::string& script, const std::vector<std::string>& texts) {
  const File in = openFile(), out = openFile();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() || std::fflush(in.get()) != 0) {
    fail(std::string("cannot be given a script: ") + std::strerror(errno));
  }
  std::rewind(in.get());
  std::vector<const char*> arguments{"gnuplot", "-d", "-c", "/dev/stdin"};  // -d: ignores the user's settings
  for (const std::string& text : texts) arguments.push_back(text.c_str());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, const_cast<char* const*>(arguments.data()), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    fail(std::string("cannot be run: ") + std::strerror(error) + "; install it: apt install gnuplot-nox");
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) fail("failed");
  std::fseek(out.get(), 0, SEEK_END);
  std::string text(static_cast<size_t>(std::ftell(out.get())), '\0');
  std::rewind(out.get());
  if (std::fread(text.data(), 1, text.size(), out.get()) != text.size()) fail("wrote what cannot be read back");
  return text;
}

}  // namespace

std::string plot(const char* script, const std::filesystem::path& csv, const std::vector<std::string>& texts) {
  // gnuplot runs a file name that begins with < as a command: an absolute path does not.
  std::vector<std::string> arguments{std::filesystem::absolute(csv).string()};
  arguments.insert(arguments.end(), texts.begin(), texts.end());
  std::string picture = gnuplot(std::string(kStyleScript) + script, arguments);
  // It does not report that there was no room for what it wrote.
  if (picture.find("</svg>") == std::string::npos) {
    fail("left a picture unfinished: is there room for temporary files?");
  }
  return picture;
}

void requireGnuplot() {
  gnuplot(kStyleScript, {});
}

}  // namespace radar::tools
