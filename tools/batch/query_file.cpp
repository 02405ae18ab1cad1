#include "batch/query_file.h"

#include <algorithm>
#include <exception>
#include <thread>

#include "batch/binary_queries.h"
#include "batch/query_json.h"
#include "batch/query_reader.h"
#include "workloads/query_fields.h"

namespace radar::tools {

void ModesAsked::add(const Workload& world, const QuerySpec& query) {
  if (!listed && hasLists(query)) listed = query.id;
  if (!moved && query.chain) moved = query.id;
  ++modes[query.mode];
  if (query.mode || !exactOnly.empty()) return;
  const std::string reason = tools::exactOnly(world, query);
  if (!reason.empty()) exactOnly = reason + " of query \"" + query.id + "\"";
}

void ModesAsked::add(const ModesAsked& later) {
  for (const auto& [mode, count] : later.modes) modes[mode] += count;
  if (exactOnly.empty()) exactOnly = later.exactOnly;
  if (!listed) listed = later.listed;
  if (!moved) moved = later.moved;
}

namespace {

// Reads every query, so that nothing is answered if one is refused: the first of them is.
ModesAsked check(const BinaryQueries& queries, const Workload& world) {
  struct Range {
    ModesAsked modes;
    std::exception_ptr refused;
  };
  std::vector<Range> ranges(std::max(1u, std::thread::hardware_concurrency()));
  {
    std::vector<std::jthread> threads;
    for (size_t k = 0; k < ranges.size(); ++k) {
      threads.emplace_back([&, k] {
        const uint64_t each = queries.count() / ranges.size() + 1, first = std::min(k * each, queries.count());
        try {
          for (uint64_t i = first; i < std::min(first + each, queries.count()); ++i) {
            ranges[k].modes.add(world, queries.read(i));
          }
        } catch (...) {
          ranges[k].refused = std::current_exception();
        }
      });
    }
  }
  ModesAsked all;
  for (const Range& range : ranges) {
    if (range.refused) std::rethrow_exception(range.refused);
    all.add(range.modes);
  }
  return all;
}

}  // namespace

ModesAsked modesOf(const Workload& workload) {
  ModesAsked modes;
  for (const QuerySpec& query : workload.queries) modes.add(workload, query);
  return modes;
}

std::string inKeys(std::string_view wrong) {
  std::string words = inOptions(wrong);
  for (const auto& [option, key] : {std::pair{"direction: ", "dir: "}, std::pair{"distance: ", "D: "}}) {
    if (words.starts_with(option)) words.replace(0, std::string_view(option).size(), key);
  }
  return words;
}

QueryFile::QueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings, const Outputs& outputs) {
  JsonQueryFile json = readJsonQueryFile(file, warnings, outputs);
  name_ = std::move(json.name);
  world_ = std::move(json.workload);
  bases_ = std::move(json.bases);
  if (json.queriesFile) {
    binary_ = std::make_unique<BinaryQueries>(*json.queriesFile, world_, bases_);
    modes_ = check(*binary_, world_);
    json.fingerprint.add(binary_->bytes());
  } else {
    modes_ = modesOf(world_);
  }
  fingerprint_ = json.fingerprint.text();
}

QueryFile::~QueryFile() = default;

uint64_t QueryFile::count() const {
  return binary_ ? binary_->count() : world_.queries.size();
}

std::span<const QuerySpec> QueryFile::read(uint64_t first, uint64_t count, std::vector<QuerySpec>& room) const {
  if (!binary_) return std::span(world_.queries).subspan(first, count);
  room.clear();
  for (uint64_t i = first; i < first + count; ++i) room.push_back(binary_->read(i));
  return room;
}

QuerySpec QueryFile::query(const std::string& name, std::string_view json) const {
  const nlohmann::json document = parseJson(name, json);
  return queryFrom(JsonValue(name, document), world_, bases_);
}

void QueryFile::refuse(uint64_t number, const std::string& wrong) const {
  const size_t end = wrong.find(": ");
  const std::string key = wrong.substr(0, end), problem = wrong.substr(end + 2);
  if (binary_) binary_->refuse(key, number, problem);
  throw InputError(name_, "queries[" + std::to_string(number) + "]." + key, problem);
}

Workload QueryFile::all() && {
  for (uint64_t i = 0; binary_ && i < count(); ++i) world_.queries.push_back(binary_->read(i));
  return std::move(world_);
}

Workload queriesToMeasure(const std::filesystem::path& file, std::vector<std::string>& warnings,
                          const Outputs& outputs) {
  QueryFile queries(file, warnings, outputs);
  if (queries.count() == 0) throw InputError(file.string(), "queries", "expected at least one query, got none");
  if (const std::optional<std::string>& moved = queries.modes().moved) {
    throw InputError(file.string(), "queries", "expected queries of sensors alone, got \"" + *moved + "\" of a chain");
  }
  return std::move(queries).all();
}

}  // namespace radar::tools
