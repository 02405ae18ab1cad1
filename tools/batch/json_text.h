// JSON read strictly.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace radar::tools {

/// Parses one JSON document. Beyond the grammar, refuses a key given twice in an object and a number too large for a
/// double. Throws InputError with line and column, and with the path of the value at hand.
nlohmann::json parseJson(const std::string& file, std::string_view text);

/// A value with its place in the document, for messages: each accessor throws InputError(file, path, ...) that says
/// what was expected and what was found. A child must not outlive its parent.
class JsonValue {
 public:
  JsonValue(const std::string& file, const nlohmann::json& root) : file_(file), json_(root) {}

  bool has(const char* key) const { return json_.contains(key); }
  /// Of an object; refuses a missing one.
  JsonValue member(const char* key) const;
  /// Of an array.
  JsonValue element(size_t index) const;

  void requireObject() const;
  size_t arraySize() const;  ///< refuses what is no array
  std::string string() const;
  double number() const;  ///< finite
  bool boolean() const;
  uint64_t wholeNumber(uint64_t most) const;
  /// A whole number below `count`; `what` says what there are `count` of.
  uint32_t index(size_t count, const char* what) const;

  std::string path() const;
  /// Throws "expected `what`, got (this value)".
  [[noreturn]] void expected(const std::string& what) const;
  /// Throws `problem` at this place.
  [[noreturn]] void refuse(const std::string& problem) const;
  const nlohmann::json& json() const { return json_; }

 private:
  JsonValue(const JsonValue& parent, const nlohmann::json& json, const char* key, size_t index)
      : file_(parent.file_), json_(json), parent_(&parent), key_(key), index_(index) {}

  const std::string& file_;
  const nlohmann::json& json_;
  const JsonValue* parent_ = nullptr;
  const char* key_ = nullptr;  ///< null: an array's element
  size_t index_ = 0;
};

}  // namespace radar::tools
