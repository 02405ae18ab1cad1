#include "import/mesh_file_validation.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

/// A file's text, taken token by token or line by line.
struct Text {
  std::string file;
  std::string_view rest;
  size_t line = 1;

  /// Empty at the end.
  std::string_view token() {
    while (!rest.empty() && kBlanks.find(rest.front()) != kBlanks.npos) drop(1);
    const std::string_view found = rest.substr(0, std::min(rest.find_first_of(kBlanks), rest.size()));
    drop(found.size());
    return found;
  }
  std::string_view lineOfText() {
    const std::string_view found = rest.substr(0, std::min(rest.find('\n'), rest.size()));
    drop(std::min(found.size() + 1, rest.size()));
    return found.ends_with('\r') ? found.substr(0, found.size() - 1) : found;
  }
  void drop(size_t count) {
    line += std::count(rest.begin(), rest.begin() + count, '\n');
    rest.remove_prefix(count);
  }
};

bool isNumber(std::string_view token, uint64_t& value) {
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  return error == std::errc() && end == token.data() + token.size();
}

struct Property {
  size_t bytes = 0;
  size_t countBytes = 0;  ///< of the count in front of a list; 0: no list
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

size_t bytesOf(const Text& text, const std::string& type) {
  for (const char* name : {"char", "uchar", "int8", "uint8"}) {
    if (type == name) return 1;
  }
  for (const char* name : {"short", "ushort", "int16", "uint16"}) {
    if (type == name) return 2;
  }
  for (const char* name : {"int", "uint", "float", "int32", "uint32", "float32"}) {
    if (type == name) return 4;
  }
  if (type == "double" || type == "float64") return 8;
  throw InputError(text.file, "line " + std::to_string(text.line - 1), "expected a PLY type, got \"" + type + "\"");
}

[[noreturn]] void endsEarly(const Text& text, const Element& element, uint64_t present) {
  throw InputError(
      text.file, "element " + element.name,
      "expected " + std::to_string(element.count) + ", the file ends in number " + std::to_string(present));
}

uint64_t binaryCount(std::string_view bytes, bool bigEndian) {
  uint64_t value = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    value = value << 8 | uint8_t(bigEndian ? bytes[i] : bytes[bytes.size() - 1 - i]);
  }
  return value;
}

void walkBinary(Text& text, const Element& element, bool bigEndian) {
  for (uint64_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) {
      uint64_t values = 1;
      if (property.countBytes > 0) {
        if (text.rest.size() < property.countBytes) endsEarly(text, element, i);
        values = binaryCount(text.rest.substr(0, property.countBytes), bigEndian);
        text.rest.remove_prefix(property.countBytes);
      }
      if (text.rest.size() / property.bytes < values) endsEarly(text, element, i);
      text.rest.remove_prefix(values * property.bytes);
    }
  }
}

void walkText(Text& text, const Element& element) {
  for (uint64_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) {
      uint64_t values = 1;
      if (property.countBytes > 0) {
        const std::string_view token = text.token();
        if (token.empty()) endsEarly(text, element, i);
        if (!isNumber(token, values)) {
          throw InputError(text.file, "line " + std::to_string(text.line),
                           "expected the length of a list, got \"" + std::string(token) + "\"");
        }
      }
      for (uint64_t k = 0; k < values; ++k) {
        if (text.token().empty()) endsEarly(text, element, i);
      }
    }
  }
}

void requireIntactPly(Text text) {
  std::vector<Element> elements;
  std::string format;
  while (true) {
    if (text.rest.empty()) throw InputError(text.file, "header", "expected end_header, the file ends");
    std::istringstream words{std::string(text.lineOfText())};
    std::string key, type;
    words >> key;
    if (key == "end_header") break;
    if (key == "format") words >> format;
    if (key == "element") {
      Element element;
      if (!(words >> element.name >> element.count)) {
        throw InputError(text.file, "line " + std::to_string(text.line - 1), "expected \"element NAME COUNT\"");
      }
      elements.push_back(element);
    }
    if (key == "property" && !elements.empty()) {
      Property property;
      words >> type;
      if (type == "list") {
        words >> type;
        property.countBytes = bytesOf(text, type);
        words >> type;
      }
      property.bytes = bytesOf(text, type);
      elements.back().properties.push_back(property);
    }
  }
  for (const Element& element : elements) {
    if (element.properties.empty()) continue;  // takes no room, however many
    if (format == "ascii") {
      walkText(text, element);
    } else {
      walkBinary(text, element, format == "binary_big_endian");
    }
  }
}

uint64_t offNumber(Text& text, const char* what) {
  uint64_t value = 0;
  std::string_view token = text.token();
  while (token.starts_with('#')) {
    text.lineOfText();
    token = text.token();
  }
  if (!isNumber(token, value)) {
    throw InputError(text.file, "line " + std::to_string(text.line),
                     std::string("expected the number of ") + what + ", got \"" + std::string(token) + "\"");
  }
  return value;
}

/// The next line that is not blank, which is what assimp takes for a vertex or a face.
std::string_view offLine(Text& text, const char* what, uint64_t i, uint64_t count) {
  while (!text.rest.empty()) {
    const std::string_view line = text.lineOfText();
    const size_t first = line.find_first_not_of(kBlanks);
    if (first == line.npos) continue;
    if (line[first] == '#') {
      throw InputError(text.file, "line " + std::to_string(text.line - 1),
                       "expected no comment among vertices and faces, where assimp takes it for one of them");
    }
    return line;
  }
  throw InputError(text.file, std::string(what) + " " + std::to_string(i),
                   "expected " + std::to_string(count) + " in all, the file ends");
}

void requireIntactOff(Text text) {
  std::string_view header = text.token();
  while (header.starts_with('#')) {
    text.lineOfText();
    header = text.token();
  }
  if (!header.ends_with("OFF") || header.starts_with('n')) return;  // not what this check knows: assimp judges
  const uint64_t vertices = offNumber(text, "vertices"), faces = offNumber(text, "faces");
  text.lineOfText();
  for (uint64_t i = 0; i < vertices; ++i) offLine(text, "vertex", i, vertices);
  for (uint64_t i = 0; i < faces; ++i) {
    Text face{text.file, offLine(text, "face", i, faces)};
    const std::string place = "line " + std::to_string(text.line - 1) + ": face " + std::to_string(i);
    uint64_t corners = 0;
    if (!isNumber(face.token(), corners) || corners < 1 || corners > 9) {
      throw InputError(text.file, place, "expected 1 to 9 corners, which is what assimp takes from an OFF file");
    }
    for (uint64_t k = 0; k < corners; ++k) {
      uint64_t vertex = 0;
      const std::string_view token = face.token();
      if (!isNumber(token, vertex) || vertex >= vertices) {
        throw InputError(
            text.file, place,
            "expected vertex numbers below " + std::to_string(vertices) + ", got \"" + std::string(token) + "\"");
      }
    }
  }
}

}  // namespace

void requireIntact(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".ply" && extension != ".off") return;
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  if (content.empty()) throw InputError(file.string(), "", "expected a mesh file, got an empty one");
  const Text text{file.string(), content};
  extension == ".ply" ? requireIntactPly(text) : requireIntactOff(text);
}

}  // namespace radar::tools
