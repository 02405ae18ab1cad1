// Queries as a structured array in an .npy file, one row each (docs/query-file.md).
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "batch/columns.h"
#include "workloads/query_fields.h"

namespace radar::tools {

class BinaryQueries {
 public:
  /// `world`: the meshes and scenes that the queries name; the first ones, of these bases, may be sensors. Checks
  /// names, types and shapes of the columns. Throws InputError that names file and column. `world` must outlive this.
  /// `placesOnly`: the rows are placed meshes, for placed(), and no queries.
  BinaryQueries(const std::filesystem::path& file, const Workload& world, std::vector<std::array<double, 3>> bases,
                bool placesOnly = false);

  uint64_t count() const { return columns_.rows(); }
  /// A query; its id is its index. Throws InputError that names file, column and index if a value breaks its contract.
  QuerySpec read(uint64_t index) const;
  /// What `mesh` and `pose` say, likewise.
  Instance placed(uint64_t index) const;
  /// Throws InputError that names file, column and index. `key`: of the query, as in JSON.
  [[noreturn]] void refuse(const std::string& key, uint64_t index, const std::string& problem) const;
  /// The whole file.
  std::string_view bytes() const { return columns_.bytes(); }

 private:
  const Column* column(const char* name, const char* kinds, const std::vector<uint64_t>& shape, bool required);
  uint64_t whole(const Column& column, uint64_t index, uint64_t most, const std::string& expected) const;
  double finite(const Column& column, uint64_t index, uint64_t part = 0) const;
  std::array<double, 3> vector(const Column& column, uint64_t index, double most = INFINITY,
                               const char* mostInWords = "") const;
  void readTurn(QuerySpec& query, uint64_t index) const;
  void readMove(QuerySpec& query, uint64_t index) const;
  void readField(const QueryField& field, const Column& column, uint64_t index, QuerySpec& query) const;
  void requireKnownColumns() const;
  [[noreturn]] void refuse(const Column& column, uint64_t index, const std::string& problem) const;

  std::string name_;
  const Workload& world_;
  std::vector<std::array<double, 3>> bases_;
  Columns columns_;
  std::vector<std::string> known_;
  const Column *mesh_, *pose_;
  const Column *direction_ = nullptr, *distance_ = nullptr, *motion_ = nullptr, *axis_ = nullptr, *angle_ = nullptr,
               *centre_ = nullptr, *scene_ = nullptr, *batch_ = nullptr, *mode_ = nullptr;
  std::vector<const Column*> fields_;  ///< of queryFields()
};

/// Writes queries as such a file; their ids are not kept. Throws std::runtime_error if they do not fit into
/// one array: some take steps, or are of chains.
void writeBinaryQueries(std::span<const QuerySpec> queries, const std::filesystem::path& file);
void writePlaced(std::span<const Instance> instances, const std::filesystem::path& file);

/// The bytes of a number as files hold it.
template <class Value>
void appendBytes(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace radar::tools
