#include "report/gnuplot.h"

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

// Files without a name: pipes could fill up on both sides.
File openFile() {
  File file(std::tmpfile(), std::fclose);
  if (!file) fail(std::string("cannot be given a script: ") + std::strerror(errno));
  return file;
}

}  // namespace

std::string gnuplot(const std::string& script) {
  const File in = openFile(), out = openFile();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() || std::fflush(in.get()) != 0) {
    fail(std::string("cannot be given a script: ") + std::strerror(errno));
  }
  std::rewind(in.get());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
  const char* arguments[] = {"gnuplot", "-d", nullptr};  // -d: no settings of the user's
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &actions, nullptr, const_cast<char* const*>(arguments), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    fail(std::string("cannot be run: ") + std::strerror(error) + "; install it: apt install gnuplot-nox");
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) fail("did not take a script");
  std::fseek(out.get(), 0, SEEK_END);
  std::string text(static_cast<size_t>(std::ftell(out.get())), '\0');
  std::rewind(out.get());
  if (std::fread(text.data(), 1, text.size(), out.get()) != text.size()) fail("wrote what cannot be read back");
  return text;
}

void requireGnuplot() {
  gnuplot("");
}

std::string quoted(const std::string& text) {
  std::string constant = "'";
  for (const char c : text) {
    if (c == '\'')
      constant += "''";
    else
      constant += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return constant + "'";
}

}  // namespace radar::tools
