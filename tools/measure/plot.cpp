#include "measure/plot.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "batch/atomic_file.h"

namespace radar::tools {

extern const char* const kStyleScript;  // which runs before each script

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& problem) {
  throw std::runtime_error("gnuplot, which draws the charts, " + problem);
}

// An unnamed file: with pipes on both sides, both programs could wait for each other.
File fileOf(const std::string& text) {
  File file(std::tmpfile(), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0) {
    fail(std::string("cannot be given a script: ") + std::strerror(errno));
  }
  std::rewind(file.get());
  return file;
}

// What gnuplot writes to its standard output for a script and its arguments, which are never parsed as commands.
std::string gnuplot(const std::string& script, const std::vector<std::string>& texts) {
  const File in = fileOf(script), out = fileOf("");
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

std::string plot(const char* script, Json table, const std::vector<std::string>& texts) {
  // gnuplot has its own rules for quotation marks and backslashes in a table: cells are without.
  for (Json& row : table) {
    for (Json& value : row) {
      if (!value.is_string()) continue;
      for (char& c : value.get_ref<std::string&>()) {
        if (static_cast<unsigned char>(c) < ' ' || std::strchr("\",\\", c) != nullptr) c = ' ';
      }
    }
  }
  const File csv = fileOf(csvOf(table));  // open in the child, too
  std::vector<std::string> arguments{"/dev/fd/" + std::to_string(fileno(csv.get()))};
  arguments.insert(arguments.end(), texts.begin(), texts.end());
  std::string picture = gnuplot(std::string(kStyleScript) + script, arguments);
  // It does not report that there was no room for what it wrote.
  if (picture.find("</svg>") == std::string::npos) {
    fail("left a picture unfinished: is there room for temporary files?");
  }
  return picture;
}

void drawFor(Json& part, const std::filesystem::path& folder, const std::string& name, const std::string& svg) {
  writeAtomically(folder / (name + ".svg"), svg);
  part["charts"].push_back(name);
}

void requireGnuplot() {
  gnuplot(kStyleScript, {});
}

std::string whyUndrawn() {
  try {
    requireGnuplot();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace radar::tools
