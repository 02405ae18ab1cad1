// Zip archives in memory, also of 64-bit sizes and of files whose sizes follow them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace radar::tools {

class ZipArchive {
 public:
  /// `file` names the archive in messages. It and the bytes must outlive this. Throws InputError if they are no
  /// archive.
  ZipArchive(const std::string& file, std::string_view bytes);
  bool has(const std::string& name) const { return entries_.contains(name); }
  /// A file's content. Throws InputError if it is missing, broken, encrypted, larger than 2 GiB, or neither stored nor
  /// deflated.
  std::string read(const std::string& name) const;

 private:
  struct Entry {
    uint64_t offset = 0, packed = 0, size = 0;
    uint32_t method = 0, flags = 0, check = 0;
  };
  template <class Number>
  Number at(uint64_t offset) const;
  [[noreturn]] void refuse(const std::string& place, const std::string& problem) const;

  const std::string* file_;
  std::string_view bytes_;
  std::map<std::string, Entry> entries_;
};

}  // namespace radar::tools
