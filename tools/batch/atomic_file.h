// Output files that are either complete or absent.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace radar::tools {

/// A file that is written beside its place and renamed into it. What fails throws std::runtime_error that names the
/// file; the old file is then untouched and no unfinished file stays.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  /// Removes what was written, unless it was finished.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void finish();

 private:
  [[noreturn]] void fail(const std::string& problem) const;

  std::filesystem::path file_, unfinished_;
  int descriptor_ = -1;
};

/// Writes all bytes to an open file. Returns 0, or errno.
int writeAll(int descriptor, std::string_view bytes);

/// As AtomicFile, for content that is at hand.
void writeAtomically(const std::filesystem::path& file, std::string_view content);

}  // namespace radar::tools
