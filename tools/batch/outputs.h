// The files that a command writes: each a place of its own, and none that the command reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace radar::tools {

/// Files are compared by what they are, not by name: links to a file are that file. Whatever is a stream (isStream) is
/// nobody's own.
class Outputs {
 public:
  /// Throws InputError that names the option and the file if its folder does not exist, if it is a folder, or if
  /// another one was added that is the same.
  void add(const std::string& option, const std::filesystem::path& file);
  /// The same for files in a folder, which may be missing.
  void addIn(const std::string& option, const std::filesystem::path& folder, const std::vector<std::string>& names);
  /// Throws InputError that names option and file if a file that is read is one of these.
  void requireNone(const std::filesystem::path& read) const;

 private:
  struct Output {
    std::string option;
    std::filesystem::path file;
  };
  const Output* find(const std::filesystem::path& file) const;

  std::vector<Output> outputs_;
};

}  // namespace radar::tools
