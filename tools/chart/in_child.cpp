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
#include <stdexcept>

namespace radar::tools {

namespace {

// The first byte of what a child sends.
constexpr char kValues = 'v', kWords = 'w';

void sendAll(int file, const char* bytes, size_t size) {
  while (size > 0) {
    const ssize_t sent = write(file, bytes, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) _exit(1);
    bytes += sent;
    size -= static_cast<size_t>(sent);
  }
}

std::string receiveAll(int file) {
  std::string text;
  char part[1 << 16];
  for (;;) {
    const ssize_t got = read(file, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(part, static_cast<size_t>(got));
  }
}

[[noreturn]] void beChild(int file, const std::function<std::vector<double>()>& work, unsigned mostSeconds) {
  const rlimit limit{mostSeconds, mostSeconds + 1};
  setrlimit(RLIMIT_CPU, &limit);
  // What libraries print (ODE and Bullet do) is not for our reader.
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  try {
    const std::vector<double> values = work();
    sendAll(file, &kValues, 1);
    sendAll(file, reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  } catch (const std::exception& error) {
    sendAll(file, &kWords, 1);
    sendAll(file, error.what(), std::strlen(error.what()));
  }
  _exit(0);
}

}  // namespace

ChildOutcome inChild(const std::function<std::vector<double>()>& work, unsigned mostSeconds) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (child == 0) {
    close(ends[0]);
    beChild(ends[1], work, mostSeconds);
  }
  close(ends[1]);
  const std::string text = receiveAll(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return {{}, "stopped after " + std::to_string(mostSeconds) + " s of processor time"};
  }
  if (WIFSIGNALED(status)) return {{}, std::string("crashes: ") + strsignal(WTERMSIG(status))};
  if (WEXITSTATUS(status) != 0 || text.empty()) return {{}, "ends its process"};
  if (text[0] == kWords) return {{}, text.substr(1)};
  ChildOutcome outcome;
  outcome.values.resize((text.size() - 1) / sizeof(double));
  std::memcpy(outcome.values.data(), text.data() + 1, outcome.values.size() * sizeof(double));
  return outcome;
}

}  // namespace radar::tools
