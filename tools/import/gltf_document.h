// A glTF 2 file: its JSON, and the numbers in its buffers.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "import/json_input.h"
#include "import/text.h"

namespace radar::tools {

/// The elements of an accessor. Reads the document's buffers, which must outlive it.
class GltfAccessor {
 public:
  size_t count() const { return count_; }
  /// A component of an element; of a normalised accessor, from -1 to 1.
  double at(size_t element, unsigned component) const;
  template <size_t kSize>
  std::array<double, kSize> row(size_t element) const {
    std::array<double, kSize> values;
    for (unsigned i = 0; i < kSize; ++i) values[i] = at(element, i);
    return values;
  }

 private:
  friend class GltfDocument;
  size_t count_ = 0, stride_ = 0, sparseStride_ = 0;
  uint32_t componentType_ = 0;
  bool isNormalised_ = false;
  const char *data_ = nullptr, *sparseData_ = nullptr;  // null: zeros; no sparse elements
  std::vector<uint32_t> sparseElements_;                // ascending
};

class GltfDocument {
 public:
  /// Refuses a file that is not of version 2, or that requires an extension that could change its geometry and is not
  /// read here. `text` must outlive this.
  explicit GltfDocument(Text text);

  JsonValue root() const { return {file_, json_}; }
  /// Calls `use` with the element of a list of the root that a number names.
  template <class Use>
  decltype(auto) use(const char* list, const JsonValue& number, const Use& use) const {
    const JsonValue top = root(), all = top.member(list), element = all[number.index(all.size(), list)];
    return use(element);
  }
  /// `type`: SCALAR, VEC3, ...; `compression`: the extension, if any, that may hold its elements instead, by name.
  GltfAccessor accessor(const JsonValue& number, const std::string& type, const char* compression = nullptr);

 private:
  struct View {
    std::string_view bytes;
    size_t stride;  // 0: none given
  };
  View view(const JsonValue& number);
  std::string_view buffer(const JsonValue& number, const char* compression);
  void readSparse(const JsonValue& sparse, size_t elementSize, GltfAccessor& to);

  const std::string& file_;
  nlohmann::json json_;
  std::optional<std::string_view> binary_;  // the second part of a binary file
  std::map<uint32_t, std::string> loaded_;  // buffers elsewhere
};

/// Whether a file is of glTF 1, another format.
bool isGltf1(std::string_view bytes);

}  // namespace radar::tools
