// Numpy's structured arrays of one dimension, in files .npy: rows of named columns.
// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "batch/mapped_file.h"

namespace radar::tools {

/// What stands before the rows. `type`: theirs, as numpy writes it, with quotes or brackets. `least`: bytes, a multiple
/// of 64.
std::string npyHeader(const std::string& type, uint64_t rows, size_t least = 64);

/// Numbers that each row has, little-endian.
struct Column {
  std::string name;
  char kind = 0;                ///< 'f' float, 'i' and 'u' integers, 'b' boolean
  size_t size = 0;              ///< bytes of a number
  std::vector<uint64_t> shape;  ///< of a row's numbers; none: one number
  const char* first = nullptr;
  uint64_t stride = 0;  ///< from row to row

  uint64_t width() const;  ///< numbers in a row
  double real(uint64_t row, uint64_t part = 0) const;
  /// A negative one as 2^64 - 1.
  uint64_t whole(uint64_t row, uint64_t part = 0) const;
  bool flag(uint64_t row) const { return first[row * stride] != 0; }
  /// "float64 of shape (3, 4)".
  std::string type() const;

 private:
  template <class Value>
  Value at(uint64_t row, uint64_t part) const;
};

/// Such a file. The rows stay there.
class Columns {
 public:
  /// Throws InputError that names file and column.
  explicit Columns(const std::filesystem::path& file);

  /// The file's.
  const std::string& name() const { return name_; }
  uint64_t rows() const { return rows_; }
  const std::vector<Column>& all() const { return all_; }
  /// Null where there is none.
  const Column* find(std::string_view name) const;
  /// The whole file.
  std::string_view bytes() const { return mapped_.bytes(); }

 private:
  std::string name_;
  MappedFile mapped_;
  uint64_t rows_ = 0;
  std::vector<Column> all_;
};

}  // namespace radar::tools
