// JSON read strictly.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "import/input_error.h"

namespace radar::tools {

/// Parses one JSON document. Beyond the grammar, refuses a key given twice in an object, a number too large for a
/// double and more than 100 levels. Throws InputError with the path of the value at hand and, for a breach of the
/// grammar, line and column.
nlohmann::json parseJson(const std::string& file, std::string_view text);

/// A value with its place in the document, for messages: each accessor throws InputError(file, path, ...) that says
/// what was expected and what was found. A child must not outlive its parent.
class JsonValue {
 public:
  JsonValue(const std::string& file, const nlohmann::json& root) : file_(file), json_(root) {}

  bool has(const char* key) const { return json_.contains(key); }
  /// Of an object; refuses a missing one.
  JsonValue member(const char* key) const {
    requireObject();
    const auto found = json_.find(key);
    if (found == json_.end()) refuse(std::string("expected the key \"") + key + "\", which is missing");
    return {*this, *found, key, 0};
  }
  /// Calls `use` with a member if there is one of that name.
  template <class Use>
  void ifHas(const char* key, const Use& use) const {
    if (has(key)) use(member(key));
  }
  /// Of an array.
  JsonValue operator[](size_t index) const { return {*this, json_[index], nullptr, index}; }
  /// Calls `use` with each element of an array; refuses what is no array.
  template <class Use>
  void forEach(const Use& use) const {
    for (size_t i = 0, count = size(); i < count; ++i) use((*this)[i]);
  }

  void requireObject() const {
    if (!json_.is_object()) expected("an object");
  }
  /// Of an array; refuses what is no array.
  size_t size() const {
    if (!json_.is_array()) expected("an array");
    return json_.size();
  }
  std::string string() const {
    if (!json_.is_string()) expected("a string");
    return json_.get<std::string>();
  }
  double number() const {
    if (!json_.is_number()) expected("a finite number");
    return json_.get<double>();
  }
  double numberFrom0() const {
    if (number() < 0) expected("a number of 0 or more");
    return number();
  }
  bool boolean() const {
    if (!json_.is_boolean()) expected("true or false");
    return json_.get<bool>();
  }
  template <class Whole>
  Whole wholeNumber() const {
    constexpr Whole kMost = std::numeric_limits<Whole>::max();
    if (!json_.is_number_unsigned() || json_.get<uint64_t>() > kMost) {
      expected("a whole number from 0 to " + std::to_string(kMost));
    }
    return json_.get<Whole>();
  }
  /// A whole number below `count`; `what` says what there are `count` of.
  uint32_t index(size_t count, const char* what) const {
    if (!json_.is_number_unsigned() || json_.get<uint64_t>() >= count) {
      expected(std::string("a whole number that names one of the ") + std::to_string(count) + " " + what + ", from 0");
    }
    return json_.get<uint32_t>();
  }

  /// Throws "expected `what`, got (this value)".
  [[noreturn]] void expected(const std::string& what) const {
    constexpr size_t kLongest = 60;
    std::string found = json_.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    if (found.size() > kLongest) found = found.substr(0, kLongest) + "...";
    refuse("expected " + what + ", got " + (json_.is_structured() ? std::string(json_.type_name()) + " " : "") + found);
  }
  /// Throws `problem` at this place.
  [[noreturn]] void refuse(const std::string& problem) const { throw InputError(file_, path(), problem); }
  /// Runs `use`; what it throws is refused at this place.
  template <class Use>
  decltype(auto) guard(const Use& use) const {
    try {
      return use();
    } catch (const std::exception& error) {
      refuse(error.what());
    }
  }
  const nlohmann::json& json() const { return json_; }

 private:
  JsonValue(const JsonValue& parent, const nlohmann::json& json, const char* key, size_t index)
      : file_(parent.file_), json_(json), parent_(&parent), key_(key), index_(index) {}
  std::string path() const {
    if (!parent_) return "";
    const std::string before = parent_->path();
    if (!key_) return before + "[" + std::to_string(index_) + "]";
    return before + (before.empty() ? "" : ".") + key_;
  }

  const std::string& file_;
  const nlohmann::json& json_;
  const JsonValue* parent_ = nullptr;
  const char* key_ = nullptr;  ///< null: an array's element
  size_t index_ = 0;
};

}  // namespace radar::tools
