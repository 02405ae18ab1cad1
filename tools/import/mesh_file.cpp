#include "import/mesh_file.h"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace radar::tools {

namespace {

class Writer {
 public:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class List>
  void addList(const List& list) {
    add<uint64_t>(list.size());
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof list[0]);
  }
  std::string bytes;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class Value>
  void take(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    take(&value, 1);
  }
  template <class List>
  void takeList(List& list) {
    list.resize(count(sizeof list[0]));
    take(list.data(), list.size());
  }
  /// Of what follows, of so many bytes each or more.
  uint64_t count(size_t size) {
    uint64_t number = 0;
    take(number);
    if (number > rest_.size() / size) fail();
    return number;
  }
  void requireEnd() const {
    if (!rest_.empty()) fail();
  }

 private:
  template <class Value>
  void take(Value* values, size_t number) {
    if (number > rest_.size() / sizeof(Value)) fail();
    if (number > 0) std::memcpy(values, rest_.data(), number * sizeof(Value));
    rest_.remove_prefix(number * sizeof(Value));
  }
  [[noreturn]] static void fail() { throw std::runtime_error("expected the bytes of a mesh file, got others"); }

  std::string_view rest_;
};

}  // namespace

void MeshFile::Part::addFace(const std::vector<uint32_t>& corners) {
  if (corners.size() == 1) ++points;
  if (corners.size() == 2) ++lines;
  if (corners.size() > 3) {
    faces.push_back({static_cast<uint32_t>(indices.size() / 3), static_cast<uint32_t>(corners.size())});
  }
  for (size_t k = 2; k < corners.size(); ++k) {
    indices.insert(indices.end(), {corners[0], corners[k - 1], corners[k]});
  }
}

Transform product(const Transform& a, const Transform& b) {
  Transform result;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      double sum = column == 3 ? a.m[4 * row + 3] : 0.0;
      for (unsigned k = 0; k < 3; ++k) sum += a.m[4 * row + k] * b.m[4 * k + column];
      result.m[4 * row + column] = sum;
    }
  }
  return result;
}

std::string bytesOf(const MeshFile& file) {
  Writer to;
  to.add<uint64_t>(file.parts.size());
  for (const MeshFile::Part& part : file.parts) {
    to.addList(part.positions);
    to.addList(part.indices);
    to.addList(part.faces);
    to.add(part.points);
    to.add(part.lines);
  }
  to.add<uint64_t>(file.nodes.size());
  for (const MeshFile::Node& node : file.nodes) {
    to.addList(node.name);
    to.add(node.fileFromNode);
    to.addList(node.parts);
  }
  return std::move(to.bytes);
}

MeshFile meshFileFrom(std::string_view bytes) {
  Reader from(bytes);
  MeshFile file;
  file.parts.resize(from.count(5 * sizeof(uint64_t)));
  for (MeshFile::Part& part : file.parts) {
    from.takeList(part.positions);
    from.takeList(part.indices);
    from.takeList(part.faces);
    from.take(part.points);
    from.take(part.lines);
  }
  file.nodes.resize(from.count(2 * sizeof(uint64_t) + sizeof(Transform)));
  for (MeshFile::Node& node : file.nodes) {
    from.takeList(node.name);
    from.take(node.fileFromNode);
    from.takeList(node.parts);
  }
  from.requireEnd();
  return file;
}

}  // namespace radar::tools
