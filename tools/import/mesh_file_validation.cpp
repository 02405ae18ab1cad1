#include "import/mesh_file_validation.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

bool isNumber(std::string_view token, uint64_t& value) {
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  return error == std::errc() && end == token.data() + token.size();
}

/// A file's text, taken token by token or line by line.
class Text {
 public:
  Text(const std::string& file, std::string_view text, size_t line = 1) : file_(file), rest_(text), line_(line) {}

  bool atEnd() const { return rest_.empty(); }
  /// Empty at the end.
  std::string_view token() {
    drop(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view found = rest_.substr(0, rest_.find_first_of(kBlanks));
    drop(found.size());
    return found;
  }
  std::string_view lineOfText() {
    const std::string_view found = rest_.substr(0, rest_.find('\n'));
    drop(std::min(found.size() + 1, rest_.size()));
    return found.ends_with('\r') ? found.substr(0, found.size() - 1) : found;
  }
  /// A token, as a whole number below `limit`; `what` says what it stands for.
  uint64_t number(const std::string& what, uint64_t limit = UINT64_MAX) {
    uint64_t value = 0;
    const std::string_view word = token();
    if (!isNumber(word, value) || value >= limit) {
      refuse(line_, "expected " + what + ", got \"" + std::string(word) + "\"");
    }
    return value;
  }
  /// False if fewer bytes are left.
  bool skipBytes(uint64_t count) {
    if (rest_.size() < count) return false;
    rest_.remove_prefix(count);
    return true;
  }
  std::string_view rest() const { return rest_; }
  const std::string& file() const { return file_; }
  size_t line() const { return line_; }
  [[noreturn]] void refuse(size_t line, const std::string& problem) const {
    refuse("line " + std::to_string(line), problem);
  }
  [[noreturn]] void refuse(const std::string& place, const std::string& problem) const {
    throw InputError(file_, place, problem);
  }

 private:
  void drop(size_t count) {
    line_ += std::count(rest_.begin(), rest_.begin() + count, '\n');
    rest_.remove_prefix(count);
  }

  const std::string& file_;
  std::string_view rest_;
  size_t line_;
};

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
  static const std::map<std::string, size_t> kBytes{{"char", 1},   {"uchar", 1},   {"int8", 1},   {"uint8", 1},
                                                    {"short", 2},  {"ushort", 2},  {"int16", 2},  {"uint16", 2},
                                                    {"int", 4},    {"uint", 4},    {"float", 4},  {"int32", 4},
                                                    {"uint32", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = kBytes.find(type);
  if (found == kBytes.end()) text.refuse(text.line() - 1, "expected a PLY type, got \"" + type + "\"");
  return found->second;
}

/// A property of one item of an element: false if the file ends before it does.
bool walkText(Text& text, const Property& property) {
  uint64_t values = 1;
  if (property.countBytes > 0) {
    if (text.rest().find_first_not_of(kBlanks) == text.rest().npos) return false;
    values = text.number("the length of a list");
  }
  for (; values > 0; --values) {
    if (text.token().empty()) return false;
  }
  return true;
}

bool walkBinary(Text& text, const Property& property, bool bigEndian) {
  uint64_t values = 1;
  if (property.countBytes > 0) {
    const std::string_view bytes = text.rest().substr(0, property.countBytes);
    if (!text.skipBytes(property.countBytes)) return false;
    values = 0;
    for (size_t i = 0; i < bytes.size(); ++i) {
      values = values << 8 | uint8_t(bigEndian ? bytes[i] : bytes[bytes.size() - 1 - i]);
    }
  }
  return values <= text.rest().size() / property.bytes && text.skipBytes(values * property.bytes);
}

void requireIntactPly(Text text) {
  std::vector<Element> elements;
  std::string format;
  for (std::string key; key != "end_header";) {
    if (text.atEnd()) text.refuse("header", "expected end_header, the file ends");
    std::istringstream words{std::string(text.lineOfText())};
    key.clear();
    words >> key;
    if (key == "format") words >> format;
    if (key == "element") {
      Element& element = elements.emplace_back();
      if (!(words >> element.name >> element.count)) {
        text.refuse(text.line() - 1, "expected \"element NAME COUNT\"");
      }
    }
    if (key == "property" && !elements.empty()) {
      Property property;
      std::string type;
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
    for (uint64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (format == "ascii" ? walkText(text, property) : walkBinary(text, property, format == "binary_big_endian")) {
          continue;
        }
        text.refuse("element " + element.name,
                    "expected " + std::to_string(element.count) + ", the file ends in number " + std::to_string(i));
      }
    }
  }
}

void skipComments(Text& text) {
  while (Text(text).token().starts_with('#')) text.lineOfText();
}

/// The next line that is not blank, which is what assimp takes for a vertex or a face.
std::string_view offLine(Text& text, const char* what, uint64_t i, uint64_t count) {
  while (!text.atEnd()) {
    const std::string_view line = text.lineOfText();
    const size_t first = line.find_first_not_of(kBlanks);
    if (first == line.npos) continue;
    if (line[first] != '#') return line;
    text.refuse(text.line() - 1, "expected no comment among vertices and faces, where assimp takes it for one of them");
  }
  text.refuse(std::string(what) + " " + std::to_string(i),
              "expected " + std::to_string(count) + " in all, the file ends");
}

void requireIntactOff(Text text) {
  skipComments(text);
  const std::string_view header = text.token();
  if (!header.ends_with("OFF") || header.starts_with('n')) return;  // not what this check knows: assimp judges
  skipComments(text);
  const uint64_t vertices = text.number("the number of vertices");
  skipComments(text);
  const uint64_t faces = text.number("the number of faces");
  text.lineOfText();
  for (uint64_t i = 0; i < vertices; ++i) offLine(text, "vertex", i, vertices);
  for (uint64_t i = 0; i < faces; ++i) {
    const std::string_view line = offLine(text, "face", i, faces);
    Text face(text.file(), line, text.line() - 1);
    const std::string number = "face " + std::to_string(i) + " to have ";
    const uint64_t corners = face.number(number + "1 to 9 corners, which is what assimp takes from an OFF file", 10);
    if (corners == 0) face.refuse(face.line(), "expected " + number + "1 to 9 corners, got none");
    for (uint64_t k = 0; k < corners; ++k) {
      face.number(number + "vertex numbers below " + std::to_string(vertices), vertices);
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
  const std::string content{std::istreambuf_iterator<char>(stream), {}}, name = file.string();
  if (content.empty()) throw InputError(name, "", "expected a mesh file, got an empty one");
  extension == ".ply" ? requireIntactPly({name, content}) : requireIntactOff({name, content});
}

}  // namespace radar::tools
