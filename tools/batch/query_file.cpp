#include "batch/query_file.h"

#include <algorithm>
#include <exception>
#include <thread>

#include "batch/binary_queries.h"
#include "batch/fingerprint.h"
#include "batch/query_reader.h"

namespace radar::tools {

void ModesAsked::add(const Workload& world, const QuerySpec& query) {
  if (!listed && (query.hits > 1 || query.skipOverlapping)) listed = query.id;
  if (query.mode) {
    chosen[static_cast<size_t>(*query.mode)] = true;
    return;
  }
  byCommand = true;
  if (!exactOnly.empty()) return;
  const std::string reason = tools::exactOnly(world, query);
  if (!reason.empty()) exactOnly = reason + " of query \"" + query.id + "\"";
}

void ModesAsked::add(const ModesAsked& later) {
  for (size_t i = 0; i < chosen.size(); ++i) chosen[i] = chosen[i] || later.chosen[i];
  byCommand = byCommand || later.byCommand;
  if (exactOnly.empty()) exactOnly = later.exactOnly;
  if (!listed) listed = later.listed;
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

QueryFile::QueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings, const Outputs& outputs) {
  JsonQueryFile json = readJsonQueryFile(file, warnings, outputs);
  world_ = std::move(json.workload);
  Fingerprint fingerprint;
  fingerprint.addWorld(world_);
  if (json.queriesFile) {
    binary_ = std::make_unique<BinaryQueries>(*json.queriesFile, world_, json.listedMeshes);
    modes_ = check(*binary_, world_);
    binary_->addTo(fingerprint);
  } else {
    modes_ = modesOf(world_);
    for (const QuerySpec& query : world_.queries) fingerprint.add(query);
  }
  fingerprint_ = fingerprint.text();
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

Workload readQueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings, const Outputs& outputs) {
  JsonQueryFile json = readJsonQueryFile(file, warnings, outputs);
  if (json.queriesFile) {
    const BinaryQueries binary(*json.queriesFile, json.workload, json.listedMeshes);
    for (uint64_t i = 0; i < binary.count(); ++i) json.workload.queries.push_back(binary.read(i));
  }
  return std::move(json.workload);
}

}  // namespace radar::tools
