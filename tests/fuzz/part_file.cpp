// Fuzzes part files: an input is that of shard 0 of 2, which is merged with shard 1 and, if it is whole, resumed.
#include "batch/part_file.h"

#include <array>

#include "batch/merge.h"
#include "fuzz/check_batch.h"
#include "fuzz/target.h"
#include "import/input_error.h"
#include "support/scratch_folder.h"

namespace radar::fuzz {

namespace {

using namespace tools;

constexpr const char* kQueries =
    R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"], "scenes": [{"instances": [[0]]}],
 "queries": [{"id": "a", "scene": 0, "sensor": [0, 1,0,0,0, 0,1,0,0, 0,0,1,-3], "dir": [0, 0, 1], "D": 8},
 {"id": "b", "scene": 0, "sensor": [0, 1,0,0,0, 0,1,0,0, 0,0,1,-3], "dir": [0, 0, -1], "D": 8},
 {"id": "c", "scene": 0, "sensor": [0], "dir": [1, 0, 0], "D": 8}]})";

constexpr std::array kFormats{AnswerFormat::lines, AnswerFormat::records, AnswerFormat::table};

/// The folder with the query file and its shards, which is the current one.
struct Files {
  Files() {
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("q.json", kQueries);
    std::filesystem::current_path(folder.path());
    std::vector<std::string> warnings;
    queries.emplace("q.json", warnings);
    for (const AnswerFormat format : kFormats) {
      write(format, 1, nameOf(format));
    }
  }
  Part part(AnswerFormat format, uint32_t index) const {
    return {format, queries->count(), Shard{index, 2}, queries->fingerprint(), "contact", "auto", "program", ""};
  }
  /// Writes what the shard's run would: queries that are clear.
  void write(AnswerFormat format, uint32_t index, const std::string& file) const {
    const Part own = part(format, index);
    PartWriter writer(file, own, *queries, false);
    std::vector<QuerySpec> room;
    const auto asked = queries->read(own.first(), own.end() - own.first(), room);
    writer.append(AnswerRows(queries->world(), format).text(own.first(), asked, std::vector<Answer>(asked.size())),
                  asked.size());
    writer.finish();
  }
  test::ScratchFolder folder;
  std::optional<QueryFile> queries;
};

const Files& files() {
  static const Files one;
  return one;
}

void run(std::string_view input) {
  const Files& all = files();
  for (const char* old : {"input", "input.partial", "out"}) std::filesystem::remove(old);
  all.folder.write("input", std::string(input));
  AnswerFormat format{};
  try {
    format = partFrom("input", input).format;
    mergeShards({"input", nameOf(format)}, "out");
  } catch (const InputError& error) {
    const std::string words = error.what();
    checkMessage(words.starts_with("out") ? "out" : words.starts_with("input") ? "input" : nameOf(format), words);
    require(!std::filesystem::exists("out"), "half a file");
  }
  std::filesystem::rename("input", "input.partial");
  try {
    PartWriter writer("input", all.part(format, 0), *all.queries, true);
    require(writer.next() <= all.part(format, 0).end(), "more answers than queries");
  } catch (const InputError& error) {
    checkMessage("input.partial", error.what());
  }
}

std::vector<std::string> seeds() {
  std::vector<std::string> seeds;
  for (const AnswerFormat format : kFormats) {
    for (const uint32_t index : {0, 1}) {
      files().write(format, index, "seed");
      seeds.push_back(files().folder.read("seed"));
    }
  }
  return seeds;
}

constexpr const char* kWords =
    R"("format"~"answers"~"lines"~"records"~"table"~"queries"~"shard"~[0, 2]~[0, 1]~[4294967295, 4294967295]~)"
    R"("fingerprint"~"mode"~"program"~{"id": "a", ~18446744073709551615~-1~null)"
    "~\n";

}  // namespace

const Target& target() {
  static const Target kTarget{run, seeds, separated(kWords)};
  return kTarget;
}

}  // namespace radar::fuzz
