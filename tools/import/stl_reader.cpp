#include <algorithm>
#include <bit>
#include <cstring>

#include "import/readers.h"

namespace radar::tools {

namespace {

constexpr size_t kHeader = 80, kFacet = 50, kNormal = 12;

/// Whether the file is as long as a binary one of its number of facets. Text may not be told by its first word: some
/// binary files begin with "solid", too. A binary file of another length is refused: text has no zeros.
bool isBinary(const Text& text) {
  static_assert(std::endian::native == std::endian::little);
  const std::string_view bytes = text.rest();
  uint32_t facets = 0;
  if (bytes.size() < kHeader + sizeof facets) return false;
  std::memcpy(&facets, bytes.data() + kHeader, sizeof facets);
  const uint64_t expected = kHeader + sizeof facets + kFacet * uint64_t(facets);
  if (bytes.size() == expected) return true;
  if (bytes.substr(0, kHeader + sizeof facets + kFacet).find('\0') == bytes.npos) return false;
  text.refuse("", "expected " + std::to_string(expected) + " bytes, as its " + std::to_string(facets) +
                      " facets take in a binary file, got " + std::to_string(bytes.size()));
}

/// Keywords may be written in capitals.
bool is(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword, {}, [](char c) { return c | 0x20; });
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
  for (std::string_view word; !is(word = text.token(), "endfacet");) {
    if (word.empty()) text.expected("endfacet", word);
    if (!is(word, "vertex")) continue;  // the normal, "outer", "loop", "endloop"
    if (++vertices > 3) text.expected("a facet of 3 vertices", "another one");
    for (int k = 0; k < 3; ++k) part.positions.push_back(text.coordinate(text.token()));
  }
  if (vertices < 3) text.expected("a facet of 3 vertices", std::to_string(vertices));
  addTriangle(part);
}

}  // namespace

MeshFile readStl(Text text) {
  if (isBinary(text)) return readBinary(text.rest());
  MeshFile file;
  for (std::string_view word; !(word = text.token()).empty();) {
    if (!is(word, "solid")) text.expected("solid, or a binary file", word);
    Text name(text.file(), text.lineOfText());
    file.nodes.push_back({std::string(name.token()), {}, {static_cast<uint32_t>(file.parts.size())}});
    MeshFile::Part& part = file.parts.emplace_back();
    while (!is(word = text.token(), "endsolid")) {
      if (!is(word, "facet")) text.expected("facet or endsolid", word);
      readFacet(text, part);
    }
    text.lineOfText();
  }
  return file;
}

}  // namespace radar::tools
