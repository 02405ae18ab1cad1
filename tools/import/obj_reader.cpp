#include <array>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "import/readers.h"

namespace radar::tools {

namespace {

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

class ObjReader {
 public:
  explicit ObjReader(Text text) : text_(text) {}

  MeshFile read();

 private:
  /// Faces of one object and one material. Objects and materials number meshes and triangles as assimp does.
  struct Piece {
    MeshFile::Part part;             ///< without positions
    std::vector<uint32_t> vertices;  ///< the file's vertex at each of the part's
    std::optional<std::string> material;
  };
  struct Object {
    std::string name;
    std::vector<size_t> pieces;
  };

  std::string_view wholeLine();
  void readStatement(Text line);
  void readVertex(Text line);
  void readElement(char kind, Text line);
  uint32_t readCorner(const Text& line, std::string_view word);
  void beginObject(std::string_view name);
  void beginPiece();
  void nameObject(std::string_view name);
  void nameGroup(std::string_view name);
  void nameMaterial(std::string_view name);
  MeshFile finish();

  Text text_;
  std::string joined_;
  std::vector<double> positions_;
  std::vector<Piece> pieces_;
  std::vector<Object> objects_;
  std::unordered_map<std::string, size_t> firstOf_;  ///< of the objects of a name
  size_t object_ = 0, piece_ = 0;                    ///< the current ones, once there are any
  std::string group_;
  std::optional<std::string> material_;
  std::vector<uint32_t> corners_;  ///< of the element at hand
  uint64_t greatest_ = 0;          ///< vertex that an element names, from 1
  size_t greatestLine_ = 0;
};

MeshFile ObjReader::read() {
  while (!text_.atEnd()) {
    const size_t number = text_.line();
    readStatement({text_.file(), wholeLine(), number});
  }
  return finish();
}

/// A line, joined with the next ones where it ends in a backslash.
std::string_view ObjReader::wholeLine() {
  std::string_view line = text_.lineOfText();
  if (!line.ends_with('\\')) return line;
  joined_.clear();
  for (; line.ends_with('\\'); line = text_.lineOfText()) {
    joined_.append(line.substr(0, line.size() - 1)).append(" ");
  }
  return joined_.append(line);
}

void ObjReader::readStatement(Text line) {
  const std::string_view word = line.token(), rest = line.rest();
  const Text numbers(line.file(), rest.substr(0, rest.find('#')), line.line());
  if (word == "v") {
    readVertex(numbers);
  } else if (word == "f" || word == "l" || word == "p") {
    readElement(word[0], numbers);
  } else if (word == "o") {
    nameObject(line.token());
  } else if (word == "g") {
    nameGroup(trimmed(rest));
  } else if (word == "usemtl") {
    nameMaterial(trimmed(rest));
  } else if (word == "surf") {
    line.expected("polygons, which alone are read", "surf, a free-form surface");
  }
}

void ObjReader::readVertex(Text line) {
  std::array<std::string_view, 7> words;
  size_t count = 0;
  for (std::string_view word; count < words.size() && !(word = line.token()).empty(); ++count) words[count] = word;
  if (count != 3 && count != 4 && count != 6) {
    line.expected("3 or 4 coordinates, or 3 and a colour", std::to_string(count) + (count == 7 ? " or more" : ""));
  }
  const double weight = count == 4 ? line.number(words[3]) : 1;
  for (size_t k = 0; k < 3; ++k) {
    positions_.push_back(weight == 1 ? line.coordinate(words[k]) : line.number(words[k]) / weight);
  }
}

uint32_t ObjReader::readCorner(const Text& line, std::string_view word) {
  const std::string_view number = word.substr(0, word.find('/'));
  const bool fromEnd = number.starts_with('-');
  const uint64_t known = positions_.size() / 3;
  const std::optional<uint64_t> value = wholeNumber(number.substr(fromEnd ? 1 : 0));
  if (!value || *value == 0 || *value > UINT32_MAX || (fromEnd && *value > known)) {
    line.expected("the number of a vertex, from 1, or from -1 backwards", word);
  }
  const uint64_t vertex = fromEnd ? known - *value + 1 : *value;
  if (vertex > greatest_) {
    greatest_ = vertex;
    greatestLine_ = line.line();
  }
  return static_cast<uint32_t>(vertex - 1);
}

void ObjReader::readElement(char kind, Text line) {
  corners_.clear();
  for (std::string_view word; !(word = line.token()).empty();) corners_.push_back(readCorner(line, word));
  if (corners_.size() < (kind == 'l' ? 2 : 1)) line.expected(kind == 'l' ? "two vertices or more" : "vertices", "");
  if (objects_.empty()) beginObject("defaultobject");
  Piece& piece = pieces_[piece_];
  if (kind == 'f') {
    const auto first = static_cast<uint32_t>(piece.vertices.size());
    piece.vertices.insert(piece.vertices.end(), corners_.begin(), corners_.end());
    std::iota(corners_.begin(), corners_.end(), first);
    return piece.part.addFace(corners_);
  }
  for (size_t i = 0; i < corners_.size(); ++i) {
    piece.vertices.push_back(corners_[i]);
    if (kind == 'l' && i > 0 && i + 1 < corners_.size()) piece.vertices.push_back(corners_[i]);
  }
  (kind == 'l' ? piece.part.lines : piece.part.points) += corners_.size() - (kind == 'l' ? 1 : 0);
}

void ObjReader::beginPiece() {
  piece_ = pieces_.size();
  objects_[object_].pieces.push_back(piece_);
  pieces_.emplace_back().material = material_;
}

void ObjReader::beginObject(std::string_view name) {
  object_ = objects_.size();
  objects_.push_back({std::string(name), {}});
  firstOf_.emplace(name, object_);
  beginPiece();
}

// Faces after the name of an earlier object join the piece at hand until a material begins a new one.
void ObjReader::nameObject(std::string_view name) {
  if (name.empty()) return;
  const auto found = firstOf_.find(std::string(name));
  if (found == firstOf_.end()) return beginObject(name);
  object_ = found->second;
}

void ObjReader::nameGroup(std::string_view name) {
  if (name == group_) return;
  group_ = name;
  beginObject(name);
}

void ObjReader::nameMaterial(std::string_view name) {
  if (name.empty() || material_ == name) return;
  material_ = name;
  if (pieces_.empty()) return;
  const Piece& piece = pieces_[piece_];
  if (piece.material && piece.material != name && !piece.vertices.empty()) beginPiece();
  pieces_[piece_].material = material_;
}

MeshFile ObjReader::finish() {
  const uint64_t count = positions_.size() / 3;
  if (greatest_ > count) {
    text_.refuse("line " + std::to_string(greatestLine_), "expected one of the file's " + std::to_string(count) +
                                                              " vertices, got number " + std::to_string(greatest_));
  }
  MeshFile file;
  for (const Object& object : objects_) {
    MeshFile::Node& node = file.nodes.emplace_back();
    node.name = object.name;
    for (const size_t number : object.pieces) {
      Piece& piece = pieces_[number];
      node.parts.push_back(static_cast<uint32_t>(file.parts.size()));
      MeshFile::Part& part = file.parts.emplace_back(std::move(piece.part));
      part.positions.reserve(3 * piece.vertices.size());
      for (const uint32_t vertex : piece.vertices) {
        part.positions.insert(part.positions.end(), &positions_[3 * size_t(vertex)],
                              &positions_[3 * size_t(vertex)] + 3);
      }
    }
  }
  return file;
}

}  // namespace

MeshFile readObj(Text text) {
  return ObjReader(text).read();
}

}  // namespace radar::tools
