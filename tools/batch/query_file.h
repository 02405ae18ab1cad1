// Query files, format cyber-radar-queries-1.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "batch/outputs.h"
#include "import/input_error.h"
#include "workloads/workload.h"

namespace radar::tools {

class BinaryQueries;

/// The modes that queries ask for.
struct ModesAsked {
  std::map<std::optional<AnswerMode>, uint64_t> modes;  ///< how many; none: they leave the choice to the command
  std::string exactOnly;                                ///< what of one that does mode sampled does not offer; or empty
  std::optional<std::string> listed;  ///< the id of one whose answer has lists: of hits, or of what overlaps
  std::optional<std::string> moved;   ///< of one of a chain
  void add(const Workload& world, const QuerySpec& query);
  /// Those of later queries.
  void add(const ModesAsked& later);
  /// Whether a query is answered in `mode` where the command chooses `command`.
  bool asks(AnswerMode mode, AnswerMode command) const {
    return modes.contains(mode) || (modes.contains(std::nullopt) && mode == command);
  }
};
ModesAsked modesOf(const Workload& workload);

/// A query file whose queries are read in ranges.
class QueryFile {
 public:
  /// Reads a query file with its meshes and instance files; "-" is standard input, in the current folder. Everything is
  /// checked: what is returned keeps the contracts of radar::Scene and radar::Query. Queries in a queries file stay
  /// there. Throws InputError that names the file, the JSON path (or line) and what was expected; also if one of
  /// `outputs` is read, before it is. Appends the warnings about mesh files to `warnings`.
  QueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings, const Outputs& outputs = {});
  ~QueryFile();

  /// Its meshes and scenes.
  const Workload& world() const { return world_; }
  uint64_t count() const;
  /// The queries from `first` on, `count` of them, which exist. Valid until `room`, which may hold them, changes.
  std::span<const QuerySpec> read(uint64_t first, uint64_t count, std::vector<QuerySpec>& room) const;
  /// The world with all queries.
  Workload all() &&;
  /// A query in JSON, as it would stand in the file; another one may have its id. Throws InputError that begins with
  /// `name`.
  QuerySpec query(const std::string& name, std::string_view json) const;
  /// Throws InputError at a query's place; `wrong` as of inKeys().
  [[noreturn]] void refuse(uint64_t number, const std::string& wrong) const;
  const ModesAsked& modes() const { return modes_; }
  /// A hash of all that the answers depend on: bytes of the files, but of meshes only what was read.
  const std::string& fingerprint() const { return fingerprint_; }

 private:
  std::string name_;
  Workload world_;
  std::vector<std::array<double, 3>> bases_;  ///< of the meshes that may be sensors
  std::unique_ptr<BinaryQueries> binary_;     ///< none: the queries are in world_
  ModesAsked modes_;
  std::string fingerprint_;
};

/// What a query file holds, for measuring. Throws InputError, too, if there is no query, or one of a chain.
Workload queriesToMeasure(const std::filesystem::path& file, std::vector<std::string>& warnings,
                          const Outputs& outputs);

/// Writes `folder`/queries.json, the meshes as binary PLY, whose floats are exact, and a scene of more than 64
/// instances as an instance file; makes the folder. `binary`: the queries as an array in queries.npy. Reading it gives
/// the same workload to the bit (a mesh's name is its file's then, and names of objects are not kept, nor, if binary,
/// ids of queries). Returns the query file. Throws std::runtime_error if something cannot be written.
std::filesystem::path writeQueryFile(const Workload& workload, const std::filesystem::path& folder,
                                     bool binary = false);

/// The first option of a query that does not go with its others, or with a cutter, as a query file calls it, and what
/// was expected; empty if all do.
std::pair<std::string, std::string> conflictIn(const Workload& workload, const QuerySpec& query);

/// What radar::validate() says of a query, as a query file calls it: "dir: expected ...".
std::string inKeys(std::string_view wrong);

/// What of a query mode sampled does not offer, as a query file says it; empty if it answers the query.
std::string exactOnly(const Workload& workload, const QuerySpec& query);

/// The words of a mode in files and options. modeFrom throws std::invalid_argument that lists them.
const char* nameOf(AnswerMode mode);
AnswerMode modeFrom(std::string_view name);

}  // namespace radar::tools
