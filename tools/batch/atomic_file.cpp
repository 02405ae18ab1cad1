#include "batch/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace radar::tools {

int Descriptor::close() {
  return number_ >= 0 && ::close(std::exchange(number_, -1)) != 0 ? errno : 0;
}

bool isStream(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  return exists(status) && !is_regular_file(status) && !is_directory(status);
}

std::filesystem::path targetOf(std::filesystem::path file) {
  std::error_code error;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(file, error); ++links) {
    file = file.parent_path() / std::filesystem::read_symlink(file, error);
  }
  return file;
}

AtomicFile::AtomicFile(const std::filesystem::path& file) : file_(isStream(file) ? file : targetOf(file)) {
  if (isStream(file_)) {
    descriptor_ = Descriptor(open(file_.c_str(), O_WRONLY | O_CLOEXEC));
  } else {
    createUnfinished();
  }
  if (!descriptor_) fail(std::strerror(errno));
}

// Its name can be foretold, so it must be a file of our own, not one, or a link, that waits there.
void AtomicFile::createUnfinished() {
  constexpr int kMost = 100;
  for (int i = 0; i < kMost && !descriptor_; ++i) {
    unfinished_ = file_;
    unfinished_ += ".unfinished-" + std::to_string(getpid()) + (i == 0 ? "" : "-" + std::to_string(i));
    descriptor_ = Descriptor(open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!descriptor_ && errno != EEXIST) return;
  }
}

AtomicFile::~AtomicFile() {
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
  if (const int error = writeAll(descriptor_.get(), bytes); error != 0) fail(std::strerror(error));
}

void AtomicFile::finish() {
  if (const int error = descriptor_.close(); error != 0) fail(std::strerror(error));
  if (unfinished_.empty()) return;
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
