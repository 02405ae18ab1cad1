#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "cyber_radar/commands.h"
#include "cyber_radar/options.h"
#include "cyber_radar/words.h"
#include "import/mesh_facts.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar info gearbox.glb
  cyber-radar info *.stl --json

A query file names a node of a file by its number or by a name that it alone has: "gearbox.glb#3", "gearbox.glb#lid".
--ignore-leaving is exact for closed meshes, wound outwards.)";

using Json = nlohmann::ordered_json;

std::string inWords(const Box& box) {
  std::string text;
  for (size_t k = 0; k < 3; ++k) text += (k == 0 ? "" : " x ") + inDigits(box.high[k] - box.low[k]);
  return text + ", from " + inDigits(box.low) + " to " + inDigits(box.high);
}

std::string sizeInWords(const MeshData& mesh) {
  return counted(mesh.triangleCount(), "triangle") + ", " + counted(mesh.vertexCount(), "vertex", "vertices");
}

Json inJson(const MeshData& mesh, const Box& box, const MeshFacts& facts) {
  Json json;
  json["triangles"] = mesh.triangleCount();
  json["vertices"] = mesh.vertexCount();
  json["low"] = box.low;
  json["high"] = box.high;
  json["closed"] = facts.isClosed();
  json["border_edges"] = facts.borderEdges;
  json["uneven_edges"] = facts.unevenEdges;
  json["shells"] = facts.shells;
  json["inward_shells"] = facts.isEven() ? Json(facts.inwardShells) : Json();
  json["flat_shells"] = facts.isEven() ? Json(facts.flatShells) : Json();
  json["volume"] = facts.isEven() ? Json(facts.volume) : Json();
  json["without_area"] = facts.degenerate;
  json["repeated"] = facts.repeated;
  return json;
}

/// What is said of a file, in words and as JSON.
class Description {
 public:
  Description(const std::string& file, const FileContent& content) : file_(file), content_(content) {
    for (const FileMesh& mesh : content.assembly.meshes) facts_.push_back(factsOf(mesh));
    for (uint32_t i = 0; i < content.assembly.parts.size(); ++i) {
      firstOf_.emplace(content.assembly.parts[i].mesh, i);
    }
  }

  std::string words() const {
    const MeshFacts facts = factsOf(content_.whole);
    std::string text = file_ + ": " + counted(content_.assembly.parts.size(), "node") + ", " +
                       sizeInWords(content_.whole) + "\n  " + inWords(boxOf(content_.whole)) +
                       (content_.unit.empty() ? "" : ", in the unit " + printable(content_.unit, 40)) + "\n  " +
                       tools::inWords(facts) + (facts.isEven() ? "; volume " + inDigits(facts.volume) : "") + "\n";
    const std::vector<Assembly::Part>& parts = content_.assembly.parts;
    for (uint32_t i = 0; i < parts.size(); ++i) {
      const uint32_t first = firstOf_.at(parts[i].mesh);
      text += "  #" + std::to_string(i) + " \"" + printable(parts[i].name, 200) + "\"";
      if (parts.size() > 1) {
        text += ": " + (first == i ? sizeInWords(meshOf(parts[i])) : "the mesh of #" + std::to_string(first)) + "; " +
                inWords(boxOf(parts[i]));
        if (first == i) text += "; " + tools::inWords(facts_[parts[i].mesh]);
      }
      text += "\n";
    }
    return text;
  }

  Json json() const {
    Json json{{"file", file_}, {"unit", content_.unit.empty() ? Json() : Json(content_.unit)}};
    json.update(inJson(content_.whole, boxOf(content_.whole), factsOf(content_.whole)));
    json["nodes"] = Json::array();
    for (uint32_t i = 0; i < content_.assembly.parts.size(); ++i) {
      const Assembly::Part& part = content_.assembly.parts[i];
      Json node{{"number", i}, {"name", part.name}, {"mesh_of", firstOf_.at(part.mesh)}};
      node.update(inJson(meshOf(part), boxOf(part), facts_[part.mesh]));
      json["nodes"].push_back(node);
    }
    return json;
  }

 private:
  const FileMesh& meshOf(const Assembly::Part& part) const { return content_.assembly.meshes[part.mesh]; }
  Box boxOf(const FileMesh& mesh, const Transform& pose = {}) const { return tools::boxOf(mesh, pose); }
  Box boxOf(const Assembly::Part& part) const { return boxOf(meshOf(part), part.fileFromNode); }

  std::string file_;
  const FileContent& content_;
  std::vector<MeshFacts> facts_;          ///< of the assembly's meshes
  std::map<uint32_t, uint32_t> firstOf_;  ///< mesh -> the first node that places it
};

void describe(const std::vector<std::string>& files, bool asJson) {
  Json all = Json::array();
  for (const std::string& file : files) {
    std::vector<std::string> warnings;
    const FileContent content = readContent(file, warnings);
    printWarnings(warnings);
    const Description description(file, content);
    if (asJson) {
      all.push_back(description.json());
    } else {
      std::cout << description.words();
    }
  }
  if (asJson) std::cout << all.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

}  // namespace

void addInfoCommand(Program& program) {
  Command command = program.add("info", "Says what mesh files hold: nodes, sizes, whether they are closed", kExamples);
  auto files = std::make_shared<std::vector<std::string>>();
  auto json = std::make_shared<bool>(false);
  command.option("FILE", files.get(), "Mesh files").required();
  command.option("--json", json.get(), "Prints all of it as one JSON array");
  command.run([files, json] {
    describe(*files, *json);
    return 0;
  });
}

}  // namespace radar::tools
