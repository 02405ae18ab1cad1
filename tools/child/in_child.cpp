#include "child/in_child.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace radar::tools {

namespace {

// What a child has written begins with one of these.
constexpr char kBytes = 'b', kWords = 'w';

/// Of this process, all mappings.
uint64_t addressSpace() {
  uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void beChild(std::FILE* file, const std::function<std::string()>& work, const ChildLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_DFL);  // a host's handler may do no more than take note
  const rlimit time{limits.seconds, limits.seconds + 1}, noCore{0, 0};
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &noCore);
  if (limits.bytes < UINT64_MAX) {
    const uint64_t most = addressSpace() + limits.bytes;
    const rlimit memory{most, most};
    setrlimit(RLIMIT_AS, &memory);
  }
  // What libraries print (ODE, Bullet and a crash's handlers do) is not for our reader.
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  try {
    const std::string bytes = work();
    std::fputc(kBytes, file);
    std::fwrite(bytes.data(), 1, bytes.size(), file);
  } catch (const std::exception& error) {
    std::fputc(kWords, file);
    std::fputs(error.what(), file);
  }
  _exit(std::fflush(file) == 0 && !std::ferror(file) ? 0 : 1);
}

[[noreturn]] void fail(const char* call) {
  throw std::runtime_error(std::string(call) + ": " + std::strerror(errno));
}

}  // namespace

ChildOutcome inChild(const std::function<std::string()>& work, const ChildLimits& limits) {
  const int memory = memfd_create("what a child returns", MFD_CLOEXEC);
  if (memory < 0) fail("memfd_create");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(fdopen(memory, "w+b"), std::fclose);
  if (!file) fail("fdopen");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) beChild(file.get(), work, limits);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return {{}, "stopped after " + std::to_string(limits.seconds) + " s of processor time"};
  }
  if (WIFSIGNALED(status)) return {{}, std::string("crashes: ") + strsignal(WTERMSIG(status))};
  std::fseek(file.get(), 0, SEEK_END);
  const long size = std::ftell(file.get());
  std::rewind(file.get());
  const int kind = std::fgetc(file.get());
  if (WEXITSTATUS(status) != 0 || size < 1) return {{}, "ends its process"};
  std::string bytes(static_cast<size_t>(size) - 1, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (kind == kWords) return {{}, bytes, true};
  return {std::move(bytes), {}};
}

}  // namespace radar::tools
