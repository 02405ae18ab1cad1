#include "batch/atomic_file.h"

#include <unistd.h>

#include <stdexcept>

namespace radar::tools {

AtomicFile::AtomicFile(const std::filesystem::path& file) : file_(file), unfinished_(file) {
  unfinished_ += ".unfinished-" + std::to_string(getpid());
  stream_.open(unfinished_, std::ios::binary | std::ios::trunc);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!unfinished_.empty()) std::filesystem::remove(unfinished_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void AtomicFile::finish() {
  stream_.close();
  std::error_code error;
  if (stream_) std::filesystem::rename(unfinished_, file_, error);
  if (!stream_ || error) {
    throw std::runtime_error(file_.string() + ": expected a place to write to, got " +
                             (error ? error.message() : "an error while writing"));
  }
  unfinished_.clear();
}

void writeAtomically(const std::filesystem::path& file, std::string_view content) {
  AtomicFile atomic(file);
  atomic.write(content);
  atomic.finish();
}

}  // namespace radar::tools
