// Queries as arrays in an .npz file, one entry per query (docs/query-file.md).
#pragma once

#include <filesystem>
#include <optional>

#include "batch/fingerprint.h"
#include "batch/npz_file.h"
#include "workloads/workload.h"

namespace radar::tools {

class BinaryQueries {
 public:
  /// `world`: the meshes and scenes that the queries name; the first `meshes` meshes may be sensors. Checks names,
  /// types and shapes of the arrays. Throws InputError that names file and array. `world` must outlive this.
  BinaryQueries(const std::filesystem::path& file, const Workload& world, size_t meshes);

  uint64_t count() const { return count_; }
  /// A query; its id is its index. Throws InputError that names file, array and index if a value breaks its contract.
  QuerySpec read(uint64_t index) const;
  void addTo(Fingerprint& fingerprint) const;

 private:
  /// An array of the file, or none.
  struct Column {
    std::string name;
    const NpyArray* array = nullptr;
    uint64_t width = 1;  ///< numbers for each query
    explicit operator bool() const { return array != nullptr; }
  };
  Column column(const char* name, const char* kinds, std::vector<uint64_t> shape, bool required);
  void requireKnownNames() const;
  double number(const Column& column, uint64_t index, uint64_t part = 0) const;
  bool flag(const Column& column, uint64_t index) const;
  uint64_t whole(const Column& column, uint64_t index, uint64_t most, const std::string& expected) const;
  double finite(const Column& column, uint64_t index, uint64_t part = 0) const;
  std::optional<double> given(const Column& column, uint64_t index) const;
  void readMove(QuerySpec& query, uint64_t index) const;
  [[noreturn]] void refuse(const Column& column, uint64_t index, const std::string& expected) const;

  std::string name_;
  const Workload& world_;
  size_t meshes_;
  NpzFile file_;
  uint64_t count_ = 0;
  std::vector<std::string> known_;
  Column mesh_, pose_, scene_, batch_, direction_, distance_, motion_, exclude_, mask_, decide_, mode_, speed_,
      tolerance_, ignoreLeaving_, slack_, skipOverlapping_, hits_, clearance_;
};

/// Writes queries as such a file; their ids are not kept.
void writeBinaryQueries(std::span<const QuerySpec> queries, const std::filesystem::path& file);

}  // namespace radar::tools
