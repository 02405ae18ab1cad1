#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>

#include "import/number_text.h"
#include "import/readers.h"

namespace radar::tools {

namespace {

struct Type {
  size_t bytes = 0;
  enum Kind { sign, plain, real } kind = plain;
};

struct Property {
  std::string name;
  Type type;
  std::optional<Type> length;  ///< of a list
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { ascii, littleEndian, bigEndian };

Type typeFrom(const Text& line, std::string_view name) {
  static const std::map<std::string_view, Type> kTypes{
      {"char", {1, Type::sign}},    {"int8", {1, Type::sign}},    {"uchar", {1, Type::plain}},
      {"uint8", {1, Type::plain}},  {"short", {2, Type::sign}},   {"int16", {2, Type::sign}},
      {"ushort", {2, Type::plain}}, {"uint16", {2, Type::plain}}, {"int", {4, Type::sign}},
      {"int32", {4, Type::sign}},   {"uint", {4, Type::plain}},   {"uint32", {4, Type::plain}},
      {"float", {4, Type::real}},   {"float32", {4, Type::real}}, {"double", {8, Type::real}},
      {"float64", {8, Type::real}}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end()) line.expected("a PLY type", name);
  return found->second;
}

class PlyReader {
 public:
  explicit PlyReader(Text text) : text_(text) {}

  MeshFile read();

 private:
  void readHeader();
  void readProperty(Text line);
  void readItem();
  void readList(const Property& property);
  void readFace(const Property& property, uint64_t count);
  void readStrip(const Property& property, uint64_t count);
  /// The next value. `word` is its text in an ASCII file, empty in others.
  struct Value {
    std::string_view word;
    double number = 0;
  };
  Value take(const Type& type);
  uint64_t takeWhole(const Type& type, const char* what, uint64_t end) { return wholeOf(take(type), what, end); }
  uint64_t wholeOf(const Value& value, const char* what, uint64_t end) const;
  static std::string inWords(const Value& value);
  [[noreturn]] void refuse(const std::string& problem) const;

  Text text_;
  Format format_ = Format::ascii;
  std::vector<Element> elements_;
  const Element* element_ = nullptr;  ///< at hand
  uint64_t item_ = 0;
  uint64_t vertices_ = 0;
  std::vector<uint32_t> corners_;
  MeshFile::Part part_;
};

MeshFile PlyReader::read() {
  readHeader();
  for (const Element& element : elements_) {
    if (element.name != "vertex") continue;
    if (vertices_ > 0) text_.refuse("header", "expected one element vertex, got another");
    vertices_ = element.count;
  }
  for (const Element& element : elements_) {
    element_ = &element;
    if (element.properties.empty()) continue;  // takes no room, however many
    for (item_ = 0; item_ < element.count; ++item_) readItem();
  }
  return {{std::move(part_)}, {{"", {}, {0}}}};
}

void PlyReader::readHeader() {
  if (text_.lineOfText() != "ply") text_.refuse("line 1", "expected \"ply\"");
  std::optional<Format> format;
  for (std::string_view key; key != "end_header";) {
    if (text_.atEnd()) text_.refuse("header", "expected end_header, the file ends");
    const size_t number = text_.line();
    Text line(text_.file(), text_.lineOfText(), number);
    key = line.token();
    if (key == "format") {
      const std::string_view name = line.token();
      if (name == "ascii") format = Format::ascii;
      if (name == "binary_little_endian") format = Format::littleEndian;
      if (name == "binary_big_endian") format = Format::bigEndian;
      if (!format) line.expected("ascii, binary_little_endian or binary_big_endian", name);
    }
    if (key == "element") {
      Element& element = elements_.emplace_back();
      element.name = line.token();
      const std::string_view word = line.token();
      const std::optional<uint64_t> count = wholeNumber(word);
      if (!count) line.expected("the number of an element", word);
      element.count = *count;
    }
    if (key == "property") {
      if (elements_.empty()) line.expected("an element before its properties", key);
      readProperty(line);
    }
  }
  if (!format) text_.refuse("header", "expected a line \"format\", got none");
  format_ = *format;
}

void PlyReader::readProperty(Text line) {
  Property property;
  std::string_view type = line.token();
  if (type == "list") {
    property.length = typeFrom(line, line.token());
    type = line.token();
  }
  property.type = typeFrom(line, type);
  property.name = line.token();
  elements_.back().properties.push_back(property);
}

void PlyReader::refuse(const std::string& problem) const {
  text_.refuse(element_->name + " " + std::to_string(item_), problem);
}

void PlyReader::readItem() {
  std::array<std::optional<double>, 3> position;
  for (const Property& property : element_->properties) {
    if (property.length) {
      readList(property);
      continue;
    }
    const Value value = take(property.type);
    const size_t axis = property.name.size() == 1 ? std::string_view("xyz").find(property.name) : 3;
    if (element_->name != "vertex" || axis > 2) continue;
    position[axis] = format_ == Format::ascii ? coordinate(value.word) : inFloatRange(value.number);
    if (!position[axis]) {
      refuse("expected a coordinate in the range of floats, got " + inWords(value));
    }
  }
  if (element_->name != "vertex") return;
  for (const std::optional<double>& coordinate : position) {
    if (!coordinate) refuse("expected the properties x, y and z");
    part_.positions.push_back(*coordinate);
  }
}

void PlyReader::readList(const Property& property) {
  const uint64_t count = takeWhole(*property.length, "the length of a list", UINT64_MAX);
  const bool areCorners = property.name == "vertex_indices" || property.name == "vertex_index";
  if (areCorners && element_->name == "face") return readFace(property, count);
  if (areCorners && element_->name == "tristrips") return readStrip(property, count);
  if (format_ != Format::ascii && count <= text_.rest().size() / property.type.bytes) {
    text_.skipBytes(count * property.type.bytes);
  } else {
    for (uint64_t i = 0; i < count; ++i) take(property.type);
  }
}

/// Every second triangle runs round the other way in a strip. -1 ends one.
void PlyReader::readStrip(const Property& property, uint64_t count) {
  corners_.clear();
  for (uint64_t i = 0; i < count; ++i) {
    const Value value = take(property.type);
    if (value.word == "-1" || value.number == -1) {
      corners_.clear();
      continue;
    }
    corners_.push_back(static_cast<uint32_t>(wholeOf(value, "the number of a vertex, or -1", vertices_)));
    if (corners_.size() < 3) continue;
    const size_t last = corners_.size() - 1, odd = last % 2;
    const uint32_t a = corners_[last - 2 + odd], b = corners_[last - 1 - odd], c = corners_[last];
    if (a != b && b != c && c != a) part_.indices.insert(part_.indices.end(), {a, b, c});
  }
}

void PlyReader::readFace(const Property& property, uint64_t count) {
  corners_.clear();
  for (uint64_t i = 0; i < count; ++i) {
    corners_.push_back(static_cast<uint32_t>(takeWhole(property.type, "the number of a vertex", vertices_)));
  }
  part_.addFace(corners_);
}

std::string PlyReader::inWords(const Value& value) {
  if (!value.word.empty()) return "\"" + std::string(value.word) + "\"";
  std::ostringstream number;
  number << value.number;
  return number.str();
}

PlyReader::Value PlyReader::take(const Type& type) {
  if (format_ == Format::ascii) {
    const std::string_view word = text_.token();
    if (!word.empty()) return {word};
  } else if (text_.rest().size() >= type.bytes) {
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), text_.rest().data(), type.bytes);
    text_.skipBytes(type.bytes);
    if (format_ == Format::bigEndian) std::reverse(bytes.begin(), bytes.begin() + static_cast<long>(type.bytes));
    if (type.kind == Type::real) {
      float single = 0;
      double number = 0;
      std::memcpy(&single, bytes.data(), sizeof single);
      std::memcpy(&number, bytes.data(), sizeof number);
      return {{}, type.bytes == 4 ? single : number};
    }
    int64_t whole = 0;
    std::memcpy(&whole, bytes.data(), sizeof whole);
    const int64_t end = int64_t(1) << (8 * type.bytes);  // at most 4 bytes
    if (type.kind == Type::sign && whole >= end / 2) whole -= end;
    return {{}, static_cast<double>(whole)};
  }
  refuse("expected " + std::to_string(element_->count) + " of element " + element_->name + ", the file ends");
}

uint64_t PlyReader::wholeOf(const Value& value, const char* what, uint64_t end) const {
  if (format_ == Format::ascii) {
    const std::optional<uint64_t> whole = wholeNumber(value.word);
    if (whole && *whole < end) return *whole;
  } else if (value.number >= 0 && value.number < 0x1p63 && value.number == std::floor(value.number)) {
    const auto whole = static_cast<uint64_t>(value.number);
    if (whole < end) return whole;
  }
  refuse("expected " + std::string(what) + (end < UINT64_MAX ? ", below " + std::to_string(end) : "") + ", got " +
         inWords(value));
}

}  // namespace

MeshFile readPly(Text text) {
  return PlyReader(text).read();
}

}  // namespace radar::tools
