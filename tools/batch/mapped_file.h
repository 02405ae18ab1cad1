// A file's bytes in memory, read as they are used.
#pragma once

#include <filesystem>
#include <string_view>

namespace radar::tools {

class MappedFile {
 public:
  /// Throws InputError "FILE: expected `kind`, got ..." if it is no regular file that can be read.
  MappedFile(const std::filesystem::path& file, const char* kind);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

}  // namespace radar::tools
