// 3MF, https://3mf.io: the core specification 1.3. Colours and materials are ignored.
#include <expat.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <optional>

#include "import/readers.h"
#include "import/zip_archive.h"

namespace radar::tools {

namespace {

constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr std::string_view kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
constexpr std::string_view kMaterial = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
constexpr uint32_t kMostNodes = 1u << 20, kMostNested = 100;

using Attributes = std::map<std::string_view, std::string_view>;

uint64_t line(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9  // which warn of the other
  return XML_GetCurrentLineNumber64(parser);
#else
  return XML_GetCurrentLineNumber(parser);
#endif
}

/// Calls `begin` with each element and its attributes, named as namespace|name, and `declare` with each prefix and its
/// namespace.
class XmlReader {
 public:
  XmlReader(const std::string& file, const std::string& part) : file_(file), part_(part) {}

  std::function<void(std::string_view, const Attributes&)> begin;
  std::function<void(std::string_view, std::string_view)> declare = [](auto, auto) {};

  void read(const std::string& text) {
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreateNS(nullptr, '|'),
                                                                              XML_ParserFree);
    if (!parser) throw std::bad_alloc();
    parser_ = parser.get();
    XML_SetUserData(parser_, this);
    XML_SetStartElementHandler(parser_, [](void* self, const char* name, const char** attributes) {
      Attributes given;
      for (; *attributes != nullptr; attributes += 2) given[attributes[0]] = attributes[1];
      static_cast<XmlReader*>(self)->guard([&](XmlReader& to) { to.begin(name, given); });
    });
    XML_SetStartNamespaceDeclHandler(parser_, [](void* self, const char* prefix, const char* uri) {
      static_cast<XmlReader*>(self)->guard([&](XmlReader& to) { to.declare(prefix ? prefix : "", uri ? uri : ""); });
    });
    XML_SetStartDoctypeDeclHandler(parser_, [](void* self, const char*, const char*, const char*, int) {
      static_cast<XmlReader*>(self)->guard([](XmlReader& to) { to.refuse("expected no DOCTYPE"); });
    });
    constexpr size_t kStep = 1 << 24;
    for (size_t at = 0; !error_ && at <= text.size(); at += kStep) {
      const size_t size = std::min(kStep, text.size() - at);
      if (XML_Parse(parser_, text.data() + at, static_cast<int>(size), at + kStep > text.size()) == XML_STATUS_OK)
        continue;
      if (!error_)
        guard([](XmlReader& to) {
          to.refuse(std::string("expected XML, got: ") + XML_ErrorString(XML_GetErrorCode(to.parser_)));
        });
    }
    if (error_) std::rethrow_exception(error_);
  }

  [[noreturn]] void refuse(const std::string& problem) const {
    throw InputError(file_, printable(part_) + ": line " + std::to_string(line(parser_)), problem);
  }

 private:
  // No exception may pass the parser, which is C.
  template <class Work>
  void guard(const Work& work) {
    if (error_) return;
    try {
      work(*this);
    } catch (...) {
      error_ = std::current_exception();
      XML_StopParser(parser_, XML_FALSE);
    }
  }

  const std::string &file_, &part_;
  XML_Parser parser_ = nullptr;
  std::exception_ptr error_;
};

class ThreeMfReader {
 public:
  explicit ThreeMfReader(Text text) : file_(text.file()), archive_(file_, text.rest()), xml_(file_, part_) {}

  MeshFile read();

 private:
  struct Use {
    uint32_t object = 0;
    Transform pose;
  };
  struct Object {
    std::string name;
    MeshFile::Part mesh;
    std::vector<Use> components;
    std::optional<uint32_t> part;  ///< the mesh's number in the file
  };

  std::string rootPart();
  void begin(std::string_view name, const Attributes& given);
  void beginModel(const Attributes& given);
  Use useFrom(const Attributes& given) const;
  uint32_t number(const Attributes& given, std::string_view key) const;
  double coordinate(const Attributes& given, std::string_view key) const;
  void place(const Use& use, const Transform& fileFromParent, uint32_t depth);

  const std::string& file_;
  ZipArchive archive_;
  std::string part_ = "_rels/.rels";
  XmlReader xml_;
  std::map<std::string, std::string, std::less<>> namespaces_;
  std::map<uint32_t, Object> objects_;
  Object* object_ = nullptr;
  std::vector<Use> items_;
  MeshFile result_;
};

std::string ThreeMfReader::rootPart() {
  std::string root;
  XmlReader relations(file_, part_);
  relations.begin = [&](std::string_view name, const Attributes& given) {
    const auto type = given.find("Type"), target = given.find("Target");
    if (!name.ends_with("|Relationship") || type == given.end() || target == given.end()) return;
    if (type->second.ends_with("/3dmodel")) root = target->second;
  };
  relations.read(archive_.read(part_));
  if (root.starts_with('/')) root.erase(0, 1);
  return root.empty() ? "3D/3dmodel.model" : root;
}

uint32_t ThreeMfReader::number(const Attributes& given, std::string_view key) const {
  const auto found = given.find(key);
  const std::optional<uint64_t> value = found == given.end() ? std::nullopt : wholeNumber(found->second);
  if (!value || *value >= UINT32_MAX) xml_.refuse("expected a whole number as " + std::string(key));
  return static_cast<uint32_t>(*value);
}

double ThreeMfReader::coordinate(const Attributes& given, std::string_view key) const {
  const auto found = given.find(key);
  const std::optional<double> value = found == given.end() ? std::nullopt : tools::coordinate(found->second);
  if (!value) xml_.refuse("expected a number in the range of floats as " + std::string(key));
  return *value;
}

ThreeMfReader::Use ThreeMfReader::useFrom(const Attributes& given) const {
  if (given.contains(std::string(kProduction) + "|path")) {
    xml_.refuse("expected objects of this part, got a path to another, of the production extension, which is not read");
  }
  Use use{number(given, "objectid"), {}};
  const auto found = given.find("transform");
  if (found == given.end()) return use;
  Text numbers(file_, found->second);
  for (size_t i = 0; i < 12; ++i) {
    const std::optional<double> value = tools::coordinate(numbers.token());
    if (!value || !std::isfinite(*value)) xml_.refuse("expected 12 numbers as transform");
    use.pose.m[4 * (i % 3) + i / 3] = *value;  // the file multiplies rows by it
  }
  if (!numbers.token().empty()) xml_.refuse("expected 12 numbers as transform");
  return use;
}

void ThreeMfReader::beginModel(const Attributes& given) {
  const auto unit = given.find("unit");
  result_.unit = unit == given.end() ? "millimeter" : unit->second;
  result_.isOddUnit = result_.unit != "millimeter";
  const auto required = given.find("requiredextensions");
  if (required == given.end()) return;
  Text prefixes(file_, required->second);
  for (std::string_view prefix; !(prefix = prefixes.token()).empty();) {
    const auto found = namespaces_.find(prefix);
    const std::string uri = found == namespaces_.end() ? std::string(prefix) : found->second;
    if (uri != kCore && uri != kProduction && uri != kMaterial) {
      xml_.refuse("expected no extension that a reader must know, got " + printable(uri, 200));
    }
  }
}

void ThreeMfReader::begin(std::string_view name, const Attributes& given) {
  if (!name.starts_with(kCore) || name.size() <= kCore.size()) return;
  name.remove_prefix(kCore.size() + 1);
  if (name == "model") return beginModel(given);
  if (name == "item") return items_.push_back(useFrom(given));
  if (name == "object") {
    const auto [entry, isNew] = objects_.try_emplace(number(given, "id"));
    if (!isNew) xml_.refuse("expected an id that no other object has");
    object_ = &entry->second;
    if (const auto found = given.find("name"); found != given.end()) object_->name = found->second;
    return;
  }
  if (object_ == nullptr) return;
  if (name == "component") object_->components.push_back(useFrom(given));
  if (name == "vertex") {
    for (const char* axis : {"x", "y", "z"}) object_->mesh.positions.push_back(coordinate(given, axis));
  }
  if (name == "triangle") {
    for (const char* corner : {"v1", "v2", "v3"}) object_->mesh.indices.push_back(number(given, corner));
  }
}

/// Nodes for an object and its components.
void ThreeMfReader::place(const Use& use, const Transform& fileFromParent, uint32_t depth) {
  const auto found = objects_.find(use.object);
  if (found == objects_.end()) {
    throw InputError(file_, part_, "expected an object's id, got " + std::to_string(use.object));
  }
  if (depth > kMostNested || result_.nodes.size() >= kMostNodes) {
    throw InputError(file_, part_, "expected at most 2^20 placed objects, nested at most 100 deep, got more");
  }
  Object& object = found->second;
  const Transform pose = product(fileFromParent, use.pose);
  if (!object.mesh.positions.empty() || object.components.empty()) {
    if (!object.part) {
      object.part = static_cast<uint32_t>(result_.parts.size());
      result_.parts.push_back(std::move(object.mesh));
      object.mesh.positions.assign(1, 0);  // marks it as a mesh
    }
    result_.nodes.push_back({object.name, pose, {*object.part}});
  }
  for (const Use& component : object.components) place(component, pose, depth + 1);
}

MeshFile ThreeMfReader::read() {
  part_ = rootPart();
  xml_.declare = [this](std::string_view prefix, std::string_view uri) { namespaces_[std::string(prefix)] = uri; };
  xml_.begin = [this](std::string_view name, const Attributes& given) { begin(name, given); };
  xml_.read(archive_.read(part_));
  for (const Use& item : items_) place(item, {}, 0);
  return std::move(result_);
}

}  // namespace

MeshFile readThreeMf(Text text) {
  return ThreeMfReader(text).read();
}

}  // namespace radar::tools
