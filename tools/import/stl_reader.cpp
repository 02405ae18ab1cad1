#include <bit>
#include <cstring>
#include <optional>

#include "import/number_text.h"
#include "import/readers.h"

namespace radar::tools {

namespace {

constexpr size_t kHeader = 80, kFacet = 50, kNormal = 12;

/// Whether the file is as long as a binary one of its number of facets. Text may not be told by its first word: some
/// binary files begin with "solid", too.
bool isBinary(std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little);
  uint32_t facets = 0;
  if (bytes.size() < kHeader + sizeof facets) return false;
  std::memcpy(&facets, bytes.data() + kHeader, sizeof facets);
  return bytes.size() == kHeader + sizeof facets + kFacet * uint64_t(facets);
}

/// The last three vertices become a triangle.
void addTriangle(MeshFile::Part& part) {
  const auto count = static_cast<uint32_t>(part.positions.size() / 3);
  part.indices.insert(part.indices.end(), {count - 3, count - 2, count - 1});
}

MeshFile readBinary(std::string_view bytes) {
  MeshFile file{{{}}, {{"", {}, {0}}}};
  MeshFile::Part& part = file.parts.front();
  bytes.remove_prefix(kHeader + sizeof(uint32_t));
  for (; !bytes.empty(); bytes.remove_prefix(kFacet)) {
    float corners[9];
    std::memcpy(corners, bytes.data() + kNormal, sizeof corners);
    part.positions.insert(part.positions.end(), std::begin(corners), std::end(corners));
    addTriangle(part);
  }
  return file;
}

void readFacet(Text& text, MeshFile::Part& part) {
  size_t vertices = 0;
  for (std::string_view word; (word = text.token()) != "endfacet";) {
    if (word.empty()) text.expected("endfacet", word);
    if (word != "vertex") continue;  // the normal, "outer", "loop", "endloop"
    if (++vertices > 3) text.expected("a facet of 3 vertices", "another one");
    for (int k = 0; k < 3; ++k) {
      const std::string_view number = text.token();
      const std::optional<float> value = nearest<float>(number);
      if (!value) text.expected("the number of a coordinate", number);
      part.positions.push_back(*value);
    }
  }
  if (vertices < 3) text.expected("a facet of 3 vertices", std::to_string(vertices));
  addTriangle(part);
}

}  // namespace

MeshFile readStl(Text text) {
  if (isBinary(text.rest())) return readBinary(text.rest());
  MeshFile file;
  for (std::string_view word; !(word = text.token()).empty();) {
    if (word != "solid") text.expected("solid, or a binary file as long as its number of facets asks", word);
    Text name(text.file(), text.lineOfText());
    file.nodes.push_back({std::string(name.token()), {}, {static_cast<uint32_t>(file.parts.size())}});
    MeshFile::Part& part = file.parts.emplace_back();
    while ((word = text.token()) != "endsolid") {
      if (word != "facet") text.expected("facet or endsolid", word);
      readFacet(text, part);
    }
    text.lineOfText();
  }
  return file;
}

}  // namespace radar::tools
