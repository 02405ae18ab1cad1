// Fuzzes queries as arrays: an input is a list of arrays, of which the target makes an .npz file, so that sums are
// right and what they protect is reached. An array is the number of its name, a byte that says whether it is
// compressed, its length in two bytes, and what would be in its file .npy.
#include <minizip/zip.h>

#include <cmath>
#include <cstring>

#include "batch/npz_file.h"
#include "batch/query_file.h"
#include "fuzz/check_batch.h"
#include "fuzz/target.h"
#include "support/scratch_folder.h"

namespace radar::fuzz {

namespace {

constexpr const char* kNames[] = {"mesh",     "pose",  "dir",  "D",     "scene",  "batch",     "motion",
                                  "exclude",  "mask",  "hits", "mode",  "decide", "slack",     "ignore_leaving",
                                  "speed",    "other", "",     "mesh/", "dir",    "clearance", "skip_overlapping",
                                  "tolerance"};

/// Writes them to a file; as many as the input has.
void writeArchive(std::string_view arrays, const std::filesystem::path& file) {
  std::filesystem::remove(file);
  void* const archive = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
  while (arrays.size() >= 4) {
    const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<uint8_t>(arrays[i])); };
    const std::string name = std::string(kNames[byte(0) % std::size(kNames)]) + ".npy";
    const std::string_view content = arrays.substr(4, byte(2) + 256 * byte(3));
    const int method = (byte(1) & 1) != 0 ? Z_DEFLATED : 0;
    zipOpenNewFileInZip64(archive, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, method, 1, 0);
    zipWriteInFileInZip(archive, content.data(), static_cast<unsigned>(content.size()));
    zipCloseFileInZip(archive);
    arrays.remove_prefix(4 + content.size());
  }
  zipClose(archive, nullptr);
}

/// The folder with the query file, which is the current one.
struct Files {
  Files() {
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj", "a.obj"], "scenes":
 [{"instances": [[0], [1, 1,0,0,5, 0,1,0,0, 0,0,1,0]]}, {"base": 0, "instances": [], "motions": [[1, 0, 0, -3]]}],
 "queries_file": "q.npz"})");
    std::filesystem::current_path(folder.path());
  }
  test::ScratchFolder folder;
};

void run(std::string_view input) {
  static const Files files;
  writeArchive(input, "q.npz");
  std::vector<std::string> warnings;
  try {
    const tools::Workload workload = tools::readQueryFile("q.json", warnings);
    // In ranges, as the program reads it.
    const tools::QueryFile ranges("q.json", warnings);
    require(ranges.count() == workload.queries.size(), "another number of queries");
    std::vector<tools::QuerySpec> room;
    for (uint64_t i = 0; i < ranges.count(); ++i) {
      require(ranges.read(i, 1, room)[0].sensor() == workload.queries[i].sensor(), "another query");
    }
    if (workload.queries.size() <= 16) checkBatch(workload);
  } catch (const tools::InputError& error) {
    checkMessage("q.npz", error.what());
  }
}

/// An array of an input.
std::string array(size_t name, bool isCompressed, const std::string& content) {
  std::string text{static_cast<char>(name), static_cast<char>(isCompressed)};
  text += static_cast<char>(content.size() & 255);
  text += static_cast<char>(content.size() >> 8);
  return text + content;
}

template <class Value>
std::string npy(const char* descr, std::vector<uint64_t> shape, const std::vector<Value>& values) {
  std::string content = tools::npyHeader(descr, shape);
  const size_t before = content.size();
  content.resize(before + values.size() * sizeof(Value));
  std::memcpy(content.data() + before, values.data(), values.size() * sizeof(Value));
  return content;
}

std::vector<std::string> seeds() {
  const std::vector<double> poses{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3, 2, 0, 0, 5, 0, 0, 2, 0, 0, -2, 0, 1};
  const auto usual = [&](bool isCompressed) {
    return array(0, isCompressed, npy<uint8_t>("'|u1'", {2}, {0, 1})) +
           array(1, isCompressed, npy("'<f8'", {2, 3, 4}, poses));
  };
  const std::string ways = array(2, false, npy<float>("'<f4'", {2, 3}, {0, 0, 1, 0, -1, 0.5f})) +
                           array(3, false, npy<double>("'<f8'", {2}, {8, 0}));
  return {usual(false) + ways,
          usual(true) + array(6, true, npy<double>("'<f8'", {2, 3}, {0, 0, 4, 0, 0, 0})) +
              array(4, false, npy<int16_t>("'<i2'", {2}, {0, 1})),
          usual(false) + ways + array(7, false, npy<int64_t>("'<i8'", {2, 2}, {0, 1, -1, -1})) +
              array(8, false, npy<uint32_t>("'<u4'", {2}, {1, ~0u})) +
              array(11, false, npy<uint8_t>("'|b1'", {2}, {0, 1})),
          usual(false) + ways + array(9, false, npy<uint32_t>("'<u4'", {2}, {0, 3})) +
              array(10, false, npy<uint8_t>("'|u1'", {2}, {1, 2})) +
              array(12, false, npy<double>("'<f8'", {2}, {NAN, 1e-9})) +
              array(13, false, npy<uint8_t>("'|b1'", {2}, {1, 1})) +
              array(19, false, npy<float>("'<f4'", {2}, {0.25f, 0}))};
}

}  // namespace

const Target& target() {
  static const Target kTarget{run, seeds, {"'descr': ",    "'fortran_order': ",
                                           "True",         "False",
                                           "'shape': ",    "(2,)",
                                           "(0,)",         "(2, 3)",
                                           "(2, 3, 4)",    "(18446744073709551615,)",
                                           "'<f4'",        "'<f8'",
                                           "'<f2'",        "'>f8'",
                                           "'|b1'",        "'<u3'",
                                           "'<u0'",        "'<i1'",
                                           "'<u8'",        "'|O8'",
                                           "\x93NUMPY\x01"}};
  return kTarget;
}

}  // namespace radar::fuzz
