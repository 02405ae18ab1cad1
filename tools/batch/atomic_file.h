// Output files that are either complete or absent.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace radar::tools {

/// Whether this is a device, a pipe or a socket, to which one writes at once: nothing can take its place.
bool isStream(const std::filesystem::path& file);

/// The file that is meant: what a symbolic link leads to, be it there or not.
std::filesystem::path targetOf(std::filesystem::path file);

/// An open file, or none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { close(); }

  explicit operator bool() const { return number_ >= 0; }
  int get() const { return number_; }
  /// Returns 0, or errno: some file systems report only now that there was no room.
  int close();

 private:
  int number_;
};

/// Writes all bytes to an open file. Returns 0, or errno.
int writeAll(int descriptor, std::string_view bytes);

/// A file that is written beside its place and renamed into it. What fails throws std::runtime_error that names the
/// file; the old file is then untouched and no unfinished file stays. A stream is written to at once.
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
  void createUnfinished();
  [[noreturn]] void fail(const std::string& problem) const;

  std::filesystem::path file_, unfinished_;  ///< of a stream, none is unfinished
  Descriptor descriptor_;
};

/// As AtomicFile, for content that is at hand.
void writeAtomically(const std::filesystem::path& file, std::string_view content);

}  // namespace radar::tools
