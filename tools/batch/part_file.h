// Part files: answers to some of a query file's queries. A run writes one beside its answer file until it is complete,
// and a shard's answer file is one. The first line is a JSON object that says which run the rest belongs to; the rest
// are rows of answers, in the order of the queries.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "batch/answer_rows.h"
#include "batch/atomic_file.h"
#include "batch/query_file.h"

namespace radar::tools {

/// Part `index` of `count`, from 0: the queries from floor(queries * index / count) on.
struct Shard {
  uint32_t index = 0, count = 1;
  friend bool operator==(const Shard&, const Shard&) = default;
};
/// "0/4". Throws InputError that names the option --shard.
Shard shardFrom(const std::string& text);

/// What a part is of.
struct Part {
  AnswerFormat format = AnswerFormat::lines;
  uint64_t queries = 0;          ///< in the query file
  std::optional<Shard> shard;    ///< none: all of them
  std::string fingerprint;       ///< of the query file and all it names
  std::string mode, resolution;  ///< the command's options
  std::string program;           ///< version and commit
  std::string device;            ///< in mode sampled, whose answers depend on it; else empty

  uint64_t first() const;
  uint64_t end() const;
};

/// The length of a part file's first line, its end included; 0 if it is cut off.
size_t headerLength(std::string_view bytes);
/// What the first line says. Throws InputError.
Part partFrom(const std::string& file, std::string_view bytes);
/// Throws InputError if the part in `file` is not of the run that `expected` is of; shards may differ. `whose`: for the
/// message.
void requireSameRun(const std::string& file, const Part& part, const Part& expected, const std::string& whose);

/// The answers of one run, written as they become complete: to FILE.partial, which becomes FILE at the end.
class PartWriter {
 public:
  /// Creates FILE.partial, which other processes then refuse to write. `resume`: keeps the complete rows of one that an
  /// interrupted run of the same part left, if there is one, and drops a row that was cut off; and keeps a shard's FILE
  /// that is complete. A stream (isStream) gets its bytes at once. Throws InputError if FILE.partial is no part file or
  /// another part's, has a row that is not that of its query, exists without `resume`, or is another process's;
  /// std::runtime_error if it cannot be written.
  PartWriter(const std::filesystem::path& file, const Part& part, const QueryFile& queries, bool resume);
  /// Removes FILE.partial if it has no row.
  ~PartWriter();
  PartWriter(const PartWriter&) = delete;
  PartWriter& operator=(const PartWriter&) = delete;

  AnswerFormat format() const { return part_.format; }
  /// The query whose row comes next, in the whole file.
  uint64_t next() const { return next_; }
  /// How many of the rows that were kept have this status.
  uint64_t kept(Status status) const { return kept_[static_cast<size_t>(status)]; }
  /// The rows of the next `count` queries.
  void append(std::string_view rows, uint64_t count);
  /// After the last row. FILE is then complete: a shard with its first line, else the rows alone.
  void finish();

 private:
  bool writesAtOnce() const { return partial_ == file_; }
  void openAlone(const std::filesystem::path& found);
  void keep(const QueryFile& queries, const std::filesystem::path& found, bool resume);
  size_t keptBytes(const Part& found, std::string_view bytes, const QueryFile& queries, const std::string& name);
  void write(std::string_view bytes);
  [[noreturn]] void fail(const std::string& problem) const;

  std::filesystem::path file_, partial_;
  Part part_;
  uint64_t next_ = 0;
  std::array<uint64_t, 5> kept_{};
  Descriptor descriptor_;
};

}  // namespace radar::tools
