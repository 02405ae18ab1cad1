// Fuzzes queries as an array: an input is the file .npy.
#include <cmath>
#include <fstream>

#include "batch/binary_queries.h"
#include "batch/query_file.h"
#include "fuzz/check_batch.h"
#include "fuzz/target.h"
#include "support/scratch_folder.h"

namespace radar::fuzz {

namespace {

/// The folder with the query file, which is the current one.
struct Files {
  Files() {
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj", "a.obj"], "scenes":
 [{"instances": [[0], [1, 1,0,0,5, 0,1,0,0, 0,0,1,0]]}, {"base": 0, "instances": [], "motions": [[1, 0, 0, -3]]}],
 "queries_file": "q.npy"})");
    std::filesystem::current_path(folder.path());
  }
  test::ScratchFolder folder;
};

void run(std::string_view input) {
  static const Files files;
  std::filesystem::remove("q.npy");  // to write over a file may wait for the disk
  std::ofstream("q.npy", std::ios::binary) << input;
  std::vector<std::string> warnings;
  try {
    const tools::Workload workload = tools::QueryFile("q.json", warnings).all();
    // In ranges, as the program reads it.
    const tools::QueryFile ranges("q.json", warnings);
    require(ranges.count() == workload.queries.size(), "another number of queries");
    std::vector<tools::QuerySpec> room;
    for (uint64_t i = 0; i < ranges.count(); ++i) {
      require(ranges.read(i, 1, room)[0].sensor() == workload.queries[i].sensor(), "another query");
    }
    if (workload.queries.size() <= 16) checkBatch(workload);
  } catch (const tools::InputError& error) {
    checkMessage("q.npy", error.what());
  }
}

/// A file of two rows: meshes, poses, and the columns and values given.
template <class... Values>
std::string rowsOf(const std::string& columns, const Values&... values) {
  const double poses[2][12] = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3}, {2, 0, 0, 5, 0, 0, 2, 0, 0, -2, 0, 1}};
  std::string file = tools::npyHeader("[('mesh', '|u1'), ('pose', '<f8', (3, 4)), " + columns + "]", 2);
  for (uint8_t i = 0; i < 2; ++i) {
    tools::appendBytes(file, i);
    tools::appendBytes(file, poses[i]);
    (tools::appendBytes(file, values[i]), ...);
  }
  return file;
}

std::vector<std::string> seeds() {
  using Floats = float[2][3];
  using Doubles = double[2];
  const Floats directions{{0, 0, 1}, {0, -1, 0.5f}};
  const Doubles distances{8, 0};
  const std::string way = "('dir', '<f4', (3,)), ('D', '<f8')";
  return {
      rowsOf(way, directions, distances),
      rowsOf("('motion', '<f4', (3,)), ('scene', '<i2')", Floats{{0, 0, 4}, {0, 0, 0}}, std::array<int16_t, 2>{0, 1}),
      rowsOf("('turn_axis', '<f4', (3,)), ('turn_angle', '<f8'), ('turn_centre', '<f4', (3,))", directions,
             Doubles{1.5, -40}, Floats{{0, 0, 2}, {1, 0, 0}}),
      rowsOf(way + ", ('exclude', '<i8'), ('mask', '<u4'), ('', '|V1'), ('any_hit', '|b1')", directions, distances,
             std::array<int64_t, 2>{0, -1}, std::array{1u, ~0u}, "ab", std::array{false, true}),
      rowsOf(
          way + ", ('hits', '<u4'), ('mode', '|u1'), ('slack', '<f8'), ('ignore_leaving', '|b1'), ('clearance', '<f4')",
          directions, distances, std::array{0u, 3u}, std::array<uint8_t, 2>{1, 2}, Doubles{NAN, 1e-9},
          std::array{true, true}, std::array{0.25f, 0.0f}),
      rowsOf("('D', '<f8'), ('dir', '<f8', (3,)), ('batch', '<u8'), ('speed', '<f8'), ('tolerance', '<f8'), "
             "('skip_overlapping', '|b1')",
             distances, std::array<std::array<double, 3>, 2>{{{0, 0, 1}, {1, 0, 0}}}, std::array<uint64_t, 2>{0, 7},
             Doubles{2, NAN}, Doubles{0.5, NAN}, std::array{true, false})};
}

constexpr const char* kWords =
    "'descr': ~'fortran_order': ~True~False~'shape': ~(2,)~(0,)~(2, 3)~(2, 3, 4)~(18446744073709551615,)~"
    "'<f4'~'<f8'~'<f2'~'>f8'~'|b1'~'<u3'~'<u0'~'<i1'~'<u8'~'|O8'~\x93NUMPY\x01";

}  // namespace

const Target& target() {
  static const Target kTarget{run, seeds, separated(kWords)};
  return kTarget;
}

}  // namespace radar::fuzz
