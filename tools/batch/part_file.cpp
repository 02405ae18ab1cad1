#include "batch/part_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "batch/atomic_file.h"
#include "batch/json_output.h"
#include "batch/mapped_file.h"
#include "import/json_input.h"

namespace radar::tools {

namespace {

constexpr const char* kFormat = "cyber-radar-part-1";

std::string headerOf(const Part& part) {
  JsonObject header;
  header.addString("format", kFormat);
  header.addString("answers", nameOf(part.format));
  header.add("queries", std::to_string(part.queries));
  if (part.shard) {
    header.add("shard", "[" + std::to_string(part.shard->index) + ", " + std::to_string(part.shard->count) + "]");
  }
  header.addString("fingerprint", part.fingerprint);
  header.addString("mode", part.mode);
  header.addString("resolution", part.resolution);
  header.addString("program", part.program);
  if (!part.device.empty()) header.addString("device", part.device);
  std::string text = header.text();
  if (part.format == AnswerFormat::records && text.size() < kRecordsStart) text.resize(kRecordsStart - 1, ' ');
  return text + "\n";
}

std::string inWords(const std::optional<Shard>& shard) {
  return shard ? "shard " + std::to_string(shard->index) + "/" + std::to_string(shard->count) : "all queries";
}

// floor(queries * index / count), though the product may not fit 64 bits.
uint64_t boundary(uint64_t queries, uint64_t index, uint64_t count) {
  return queries / count * index + queries % count * index / count;
}

}  // namespace

Shard shardFrom(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, wrongIndex] = std::from_chars(text.data(), end, shard.index);
  if (wrongIndex == std::errc() && slash != end && *slash == '/') {
    const auto [last, wrongCount] = std::from_chars(slash + 1, end, shard.count);
    if (wrongCount == std::errc() && last == end && shard.index < shard.count) return shard;
  }
  throw InputError("--shard", "", "expected I/N with I from 0 to N - 1, got \"" + text + "\"");
}

uint64_t Part::first() const {
  return shard ? boundary(queries, shard->index, shard->count) : 0;
}

uint64_t Part::end() const {
  return shard ? boundary(queries, uint64_t{shard->index} + 1, shard->count) : queries;
}

size_t headerLength(std::string_view bytes) {
  return bytes.find('\n') + 1;  // npos + 1 is 0
}

Part partFrom(const std::string& file, std::string_view bytes) {
  if (!bytes.starts_with("{\"format\": \"cyber-radar-part-") || headerLength(bytes) == 0) {
    throw InputError(file, "line 1", std::string("expected the first line of a part file, format ") + kFormat);
  }
  const nlohmann::json document = parseJson(file, bytes.substr(0, headerLength(bytes)));
  const JsonValue header(file, document);
  const JsonValue format = header.member("format");
  if (format.string() != kFormat) format.expected(std::string("\"") + kFormat + "\"");
  Part part;
  const JsonValue answers = header.member("answers");
  part.format = answers.guard([&] { return answerFormatFrom(answers.string()); });
  part.queries = header.member("queries").wholeNumber<uint64_t>();
  header.ifHas("shard", [&](const JsonValue& shard) {
    if (shard.size() != 2) shard.expected("[index, count]");
    part.shard = Shard{shard[0].wholeNumber<uint32_t>(), shard[1].wholeNumber<uint32_t>()};
    if (part.shard->index >= part.shard->count) shard.expected("an index below the count");
  });
  part.fingerprint = header.member("fingerprint").string();
  part.mode = header.member("mode").string();
  part.resolution = header.member("resolution").string();
  part.program = header.member("program").string();
  header.ifHas("device", [&](const JsonValue& device) { part.device = device.string(); });
  return part;
}

void requireSameRun(const std::string& file, const Part& part, const Part& expected, const std::string& whose) {
  const auto require = [&](const char* what, const std::string& found, const std::string& wanted) {
    if (found == wanted) return;
    throw InputError(file, what, "expected that of " + whose + ", \"" + wanted + "\", got \"" + found + "\"");
  };
  require("format of the answers", nameOf(part.format), nameOf(expected.format));
  require("number of queries", std::to_string(part.queries), std::to_string(expected.queries));
  require("fingerprint of the query file", part.fingerprint, expected.fingerprint);
  require("mode", part.mode, expected.mode);
  require("resolution", part.resolution, expected.resolution);
  require("version of the program", part.program, expected.program);
  require("device of mode sampled", part.device, expected.device);
}

PartWriter::PartWriter(const std::filesystem::path& file, const Part& part, const QueryFile& queries, bool resume)
    : file_(isStream(file) ? file : targetOf(file)), partial_(file_), part_(part), next_(part.first()) {
  if (isStream(file_)) {
    descriptor_ = Descriptor(open(file_.c_str(), O_WRONLY | O_CLOEXEC));
    if (!descriptor_) fail(std::strerror(errno));
    write(part_.shard ? headerOf(part_) : startOf(part_.format, part_.queries));
    return;
  }
  partial_ += ".partial";
  std::error_code error;
  const bool isFinished =
      resume && part.shard && !std::filesystem::exists(partial_, error) && std::filesystem::exists(file_, error);
  const std::filesystem::path& found = isFinished ? file_ : partial_;
  openAlone(found);
  keep(queries, found, resume);
  if (isFinished) std::filesystem::rename(file_, partial_);
}

PartWriter::~PartWriter() {
  std::error_code ignored;
  if (next_ == part_.first() && !writesAtOnce()) std::filesystem::remove(partial_, ignored);
}

// Opens what other processes then leave alone, or makes it.
void PartWriter::openAlone(const std::filesystem::path& found) {
  for (struct stat opened{}, named{};;) {
    descriptor_ = Descriptor(open(found.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (!descriptor_) fail(errno == ELOOP ? "a symbolic link" : std::strerror(errno));
    if (flock(descriptor_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      throw InputError(found.string(), "", "expected a file of this process alone, got one that another is writing");
    }
    // The other may just have completed this file and given it its last name.
    const bool isNamed = fstat(descriptor_.get(), &opened) == 0 && lstat(found.c_str(), &named) == 0;
    if (isNamed && opened.st_dev == named.st_dev && opened.st_ino == named.st_ino) return;
  }
}

// What the file has is kept up to the last complete row. If it ends within the first line, it begins anew. A file that
// no run of ours left is not touched.
void PartWriter::keep(const QueryFile& queries, const std::filesystem::path& found, bool resume) {
  size_t kept = 0;
  {
    const MappedFile mapped(found, "a part file");
    const std::string_view bytes = mapped.bytes();
    if (!headerOf(part_).starts_with(bytes)) {
      const Part left = partFrom(found.string(), bytes);
      if (!resume) {
        throw InputError(
            found.string(), "",
            "expected no such file, got what an interrupted run left: finish it with --resume, or remove it");
      }
      kept = keptBytes(left, bytes, queries, found.string());
    }
  }
  if (ftruncate(descriptor_.get(), static_cast<off_t>(kept)) != 0) fail(std::strerror(errno));
  if (lseek(descriptor_.get(), 0, SEEK_END) < 0) fail(std::strerror(errno));
  if (kept > 0) return;
  try {
    write(headerOf(part_));
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(found, ignored);  // it has nothing to resume
    throw;
  }
}

// The length of the first line and the complete rows, which are checked and counted.
size_t PartWriter::keptBytes(const Part& found, std::string_view bytes, const QueryFile& queries,
                             const std::string& name) {
  requireSameRun(name, found, part_, "this run");
  if (found.shard != part_.shard) {
    throw InputError(name, "shard", "expected " + inWords(part_.shard) + ", got " + inWords(found.shard));
  }
  constexpr uint64_t kTogether = 16'384;
  std::vector<QuerySpec> room;
  size_t kept = headerLength(bytes);
  while (next_ < part_.end()) {
    for (const QuerySpec& query : queries.read(next_, std::min(kTogether, part_.end() - next_), room)) {
      const size_t length = rowLength(part_.format, bytes.substr(kept));
      if (length == 0) return kept;
      const std::string_view row = bytes.substr(kept, length);
      const bool isItsRow = isRow(part_.format, row, next_, &query);
      const std::optional<Status> status = isItsRow ? statusOfRow(part_.format, row) : std::nullopt;
      if (!status) {
        throw InputError(
            name, "answer " + std::to_string(next_ - part_.first()),
            "expected the answer to query \"" + query.id + "\", got \"" + std::string(row.substr(0, 60)) + "\"");
      }
      ++kept_[static_cast<size_t>(*status)];
      kept += length;
      ++next_;
    }
  }
  if (kept < bytes.size()) {
    throw InputError(name, "",
                     "expected nothing after the last answer, got " + std::to_string(bytes.size() - kept) + " bytes");
  }
  return kept;
}

void PartWriter::fail(const std::string& problem) const {
  throw std::runtime_error(partial_.string() + ": expected a file to write to, got " + problem);
}

void PartWriter::write(std::string_view bytes) {
  if (const int error = writeAll(descriptor_.get(), bytes); error != 0) fail(std::strerror(error));
}

void PartWriter::append(std::string_view rows, uint64_t count) {
  write(rows);
  next_ += count;
}

void PartWriter::finish() {
  if (writesAtOnce()) return;
  std::error_code error;
  if (part_.shard) {
    std::filesystem::rename(partial_, file_, error);
    if (error) throw std::runtime_error(file_.string() + ": expected a place to write to, got " + error.message());
    return;
  }
  const MappedFile mapped(partial_, "a part file");
  const std::string start = startOf(part_.format, part_.queries);
  if (start.size() == headerLength(mapped.bytes())) {
    // The records need not be copied: what numpy wants before them takes the place of the first line.
    if (pwrite(descriptor_.get(), start.data(), start.size(), 0) != static_cast<ssize_t>(start.size())) {
      fail(std::strerror(errno));
    }
    std::filesystem::rename(partial_, file_, error);
    if (error) throw std::runtime_error(file_.string() + ": expected a place to write to, got " + error.message());
    return;
  }
  AtomicFile whole(file_);
  whole.write(start);
  whole.write(mapped.bytes().substr(headerLength(mapped.bytes())));
  whole.finish();
  std::filesystem::remove(partial_, error);
}

}  // namespace radar::tools
