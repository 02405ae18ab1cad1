#include "chart/in_child.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>

namespace radar::tools {

namespace {

// What a child has written begins with one of these.
constexpr char kValues = 'v', kWords = 'w';

[[noreturn]] void beChild(std::FILE* file, const std::function<std::vector<double>()>& work, unsigned mostSeconds) {
  const rlimit limit{mostSeconds, mostSeconds + 1};
  setrlimit(RLIMIT_CPU, &limit);
  // What libraries print (ODE and Bullet do) is not for our reader.
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  try {
    const std::vector<double> values = work();
    std::fputc(kValues, file);
    std::fwrite(values.data(), sizeof(double), values.size(), file);
  } catch (const std::exception& error) {
    std::fputc(kWords, file);
    std::fputs(error.what(), file);
  }
  _exit(std::fflush(file) == 0 ? 0 : 1);
}

}  // namespace

ChildOutcome inChild(const std::function<std::vector<double>()>& work, unsigned mostSeconds) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file) throw std::runtime_error(std::string("a temporary file: ") + std::strerror(errno));
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (child == 0) beChild(file.get(), work, mostSeconds);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return {{}, "stopped after " + std::to_string(mostSeconds) + " s of processor time"};
  }
  if (WIFSIGNALED(status)) return {{}, std::string("crashes: ") + strsignal(WTERMSIG(status))};
  std::fseek(file.get(), 0, SEEK_END);
  const long size = std::ftell(file.get());
  std::rewind(file.get());
  const int kind = std::fgetc(file.get());
  if (WEXITSTATUS(status) != 0 || size < 1) return {{}, "ends its process"};
  std::string bytes(static_cast<size_t>(size) - 1, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (kind == kWords) return {{}, bytes};
  ChildOutcome outcome;
  outcome.values.resize(bytes.size() / sizeof(double));
  std::memcpy(outcome.values.data(), bytes.data(), outcome.values.size() * sizeof(double));
  return outcome;
}

}  // namespace radar::tools
