#include "batch/merge.h"

#include <map>
#include <memory>

#include "batch/atomic_file.h"
#include "batch/mapped_file.h"
#include "batch/part_file.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

struct Piece {
  std::string name;
  Part part;
  std::unique_ptr<MappedFile> file;
};

std::string inWords(const Part& part) {
  const std::string shard = "shard " + std::to_string(part.shard->index) + "/" + std::to_string(part.shard->count);
  if (part.first() == part.end()) return shard + " (no queries)";
  return shard + " (queries " + std::to_string(part.first()) + " to " + std::to_string(part.end() - 1) + ")";
}

// The shards of one run by their index, some of them perhaps missing.
std::map<uint32_t, Piece> openAll(const std::vector<std::string>& files) {
  std::map<uint32_t, Piece> pieces;
  std::optional<Part> one;
  for (const std::string& name : files) {
    auto file = std::make_unique<MappedFile>(name, "a shard's answer file");
    const Part part = partFrom(name, file->bytes());
    if (!part.shard) throw InputError(name, "shard", "expected a shard, got answers to all queries");
    if (!one) one = part;
    requireSameRun(name, part, *one, files[0]);
    if (part.shard->count != one->shard->count) {
      throw InputError(name, "shard",
                       "expected one of " + std::to_string(one->shard->count) + " shards, as in " + files[0] +
                           ", got " + inWords(part));
    }
    const auto [place, isNew] = pieces.try_emplace(part.shard->index, Piece{name, part, std::move(file)});
    if (!isNew) {
      throw InputError(name, "shard",
                       "expected each shard once, got " + inWords(part) + " also in " + place->second.name);
    }
  }
  return pieces;
}

void requireAll(const std::map<uint32_t, Piece>& pieces, const std::filesystem::path& out) {
  constexpr size_t kNamed = 20;
  Part part = pieces.begin()->second.part;
  const uint32_t count = part.shard->count;
  std::string missing;
  size_t named = 0;
  for (uint32_t i = 0; i < count && named < kNamed; ++i) {
    if (pieces.contains(i)) continue;
    part.shard->index = i;
    missing += (named++ == 0 ? "" : ", ") + inWords(part);
  }
  if (named == 0) return;
  const uint64_t unnamed = count - pieces.size() - named;
  if (unnamed > 0) missing += " and " + std::to_string(unnamed) + " more";
  throw InputError(out.string(), "", "expected all " + std::to_string(count) + " shards, missing: " + missing);
}

// The rows of a piece, each checked. Sets `someInvalid` if a query was not answered.
std::string_view rowsOf(const Piece& piece, bool& someInvalid) {
  const std::string_view rows = piece.file->bytes().substr(headerLength(piece.file->bytes()));
  const Part& part = piece.part;
  std::string_view rest = rows;
  for (uint64_t i = part.first(); i < part.end(); ++i) {
    const size_t length = rowLength(part.format, rest);
    if (length == 0) {
      throw InputError(piece.name, "",
                       "expected " + std::to_string(part.end() - part.first()) + " answers, got " +
                           std::to_string(i - part.first()) + ": finish it with --resume");
    }
    const std::string_view row = rest.substr(0, length);
    const bool isItsRow = isRow(part.format, row, i, nullptr);
    const std::optional<Status> status = isItsRow ? statusOfRow(part.format, row) : std::nullopt;
    if (!status) {
      throw InputError(
          piece.name, "answer " + std::to_string(i - part.first()),
          "expected the answer to query " + std::to_string(i) + ", got \"" + std::string(row.substr(0, 60)) + "\"");
    }
    someInvalid = someInvalid || *status == Status::invalid;
    rest.remove_prefix(length);
  }
  if (!rest.empty()) {
    throw InputError(piece.name, "",
                     "expected nothing after the last answer, got " + std::to_string(rest.size()) + " bytes");
  }
  return rows;
}

}  // namespace

bool mergeShards(const std::vector<std::string>& files, const std::filesystem::path& out) {
  const std::map<uint32_t, Piece> pieces = openAll(files);
  requireAll(pieces, out);
  const Part& one = pieces.begin()->second.part;
  if (!isStream(out) && answerFormatOf(out) != one.format) {
    const std::string ending = endingOf(one.format);
    throw InputError(out.string(), "",
                     ending.empty() ? "expected another file than .npy or .csv, as the shards are lines of JSON"
                                    : "expected a file " + ending + ", as the shards are");
  }
  bool someInvalid = false;
  AtomicFile whole(out);
  whole.write(startOf(one.format, one.queries));
  for (const auto& [index, piece] : pieces) whole.write(rowsOf(piece, someInvalid));
  whole.finish();
  return !someInvalid;
}

}  // namespace radar::tools
