// Numpy's files of plain arrays: .npy, one array, and .npz, a ZIP archive of them.
// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "batch/mapped_file.h"

namespace radar::tools {

/// What stands before an array's numbers. `descr`: its type, as numpy writes it: '<f8', with the quotes. `least`:
/// bytes, a multiple of 64.
std::string npyHeader(const std::string& descr, std::span<const uint64_t> shape, size_t least = 64);

/// One array, row by row, little-endian.
struct NpyArray {
  char kind = 0;    ///< 'f' float, 'i' and 'u' integers, 'b' boolean
  size_t size = 0;  ///< bytes of a number
  std::vector<uint64_t> shape;
  std::string_view bytes;

  uint64_t count() const;  ///< numbers in it
};
/// Words for messages: "float64 of shape (3, 4)".
std::string inWords(const NpyArray& array);

/// The arrays of an .npz file, stored (numpy.savez) or compressed (numpy.savez_compressed); of any length. Stored
/// arrays stay in the file.
class NpzFile {
 public:
  /// Reads all compressed arrays and checks all sums. Throws InputError that names file and array.
  explicit NpzFile(const std::filesystem::path& file);

  const std::map<std::string, NpyArray>& arrays() const { return arrays_; }

 private:
  std::string readMember(void* archive, const std::string& name, uint64_t size) const;
  NpyArray arrayFrom(const std::string& name, std::string_view member) const;

  std::string file_;
  MappedFile mapped_;
  std::vector<std::unique_ptr<std::string>> unpacked_;
  std::map<std::string, NpyArray> arrays_;
};

/// Writes an .npz file, each array stored.
class NpzWriter {
 public:
  /// Throws std::runtime_error that names the file, as add() and finish().
  explicit NpzWriter(const std::filesystem::path& file);
  /// Removes an unfinished file.
  ~NpzWriter();
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;

  void add(const std::string& name, const std::string& descr, std::span<const uint64_t> shape,
           std::span<const std::byte> numbers);
  void finish();

 private:
  void require(bool succeeded) const;

  std::filesystem::path file_, unfinished_;
  void* archive_ = nullptr;
};

}  // namespace radar::tools
