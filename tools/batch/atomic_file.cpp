#include "batch/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace radar::tools {

AtomicFile::AtomicFile(const std::filesystem::path& file) : file_(file), unfinished_(file) {
  unfinished_ += ".unfinished-" + std::to_string(getpid());
  descriptor_ = open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(std::strerror(errno));
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  std::error_code ignored;
  if (!unfinished_.empty()) std::filesystem::remove(unfinished_, ignored);
}

void AtomicFile::fail(const std::string& problem) const {
  throw std::runtime_error(file_.string() + ": expected a place to write to, got " + problem);
}

int writeAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return 0;
}

void AtomicFile::write(std::string_view bytes) {
  if (const int error = writeAll(descriptor_, bytes); error != 0) fail(std::strerror(error));
}

void AtomicFile::finish() {
  // Some file systems report only now that there was no room.
  if (close(std::exchange(descriptor_, -1)) != 0) fail(std::strerror(errno));
  std::error_code error;
  std::filesystem::rename(unfinished_, file_, error);
  if (error) fail(error.message());
  unfinished_.clear();
}

void writeAtomically(const std::filesystem::path& file, std::string_view content) {
  AtomicFile atomic(file);
  atomic.write(content);
  atomic.finish();
}

}  // namespace radar::tools
