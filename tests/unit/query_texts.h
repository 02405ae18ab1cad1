// A small query file without errors, what of it is read, and how others are refused.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batch/query_file.h"
#include "support/catch.h"
#include "support/scratch_folder.h"

namespace radar::test {

inline constexpr const char* kMesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A small file without errors.
inline nlohmann::json goodFile() {
  return nlohmann::json::parse(R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"],
    "scenes": [{"id": "a", "instances": [[0], [0, 1,0,0,5, 0,1,0,0, 0,0,1,0]]},
               {"id": "b", "base": 0, "instances": [[0, 2,0,0,0, 0,-2,0,0, 0,0,2,1e-3]], "masks": [[1, 6]]}],
    "queries": [{"id": "p", "scene": 0, "sensor": [0], "dir": [0, 0, 1], "D": 8},
                {"id": "q", "scene": 1, "batch": 3, "sensor": [0, 1,0,0,0, 0,1,0,0, 0,0,1,-2], "exclude": [2],
                 "dir": [0, -0.5, 1], "D": 0, "mask": 5, "any_hit": true, "mode": "sampled", "speed": 2.5,
                 "tolerance": 0.25}]})");
}

/// A folder with a query file and the mesh that it names.
struct Files {
  ScratchFolder folder;
  Files() { folder.write("a.obj", kMesh); }

  tools::Workload read(const std::string& text) {
    std::vector<std::string> warnings;
    tools::Workload workload = tools::QueryFile(folder.write("q.json", text), warnings).all();
    CHECK(warnings.empty());
    return workload;
  }
  /// The reader's message after the file's name, which must come first.
  std::string refusal(const std::string& text) {
    std::vector<std::string> warnings;
    const std::string file = folder.write("q.json", text);
    try {
      tools::QueryFile(file, warnings).all();
    } catch (const tools::InputError& error) {
      REQUIRE_THAT(error.what(), StartsWith(file + ": "));
      return std::string(error.what()).substr(file.size() + 2);
    }
    FAIL("not refused: " << text);
    return {};
  }
  std::string refusalWith(const char* pointer, const std::string& value) {
    nlohmann::json file = goodFile();
    file[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(value);
    return refusal(file.dump());
  }
};

}  // namespace radar::test
