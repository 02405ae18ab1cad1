// Output files that are either complete or absent.
#pragma once

#include <filesystem>
#include <fstream>
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
  std::filesystem::path file_, unfinished_;
  std::ofstream stream_;
};

/// The same, for content that is at hand.
void writeAtomically(const std::filesystem::path& file, std::string_view content);

}  // namespace radar::tools
