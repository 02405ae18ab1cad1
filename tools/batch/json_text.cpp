#include "batch/json_text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "import/input_error.h"

namespace radar::tools {

namespace {

using Json = nlohmann::json;

/// Builds the document and knows at every moment where in it the parser is.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  Json root;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // JSON text has none

  bool start_object(std::size_t) override {
    open_.push_back(place(Json::object()));
    keys_.emplace_back();
    return true;
  }
  bool key(string_t& name) override {
    if (open_.back()->contains(name)) {
      throw InputError(file_, path(), "expected each key once, got \"" + name + "\" twice");
    }
    keys_.back() = name;
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override {
    open_.push_back(place(Json::array()));
    keys_.emplace_back();
    return true;
  }
  bool end_array() override { return close(); }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    const std::string_view before = text_.substr(0, std::min(position, text_.size()));
    const size_t line = 1 + static_cast<size_t>(std::count(before.begin(), before.end(), '\n'));
    const size_t lineStart = before.rfind('\n');
    const size_t column = before.size() - (lineStart == before.npos ? 0 : lineStart + 1);
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ...": the last part.
    std::string what = error.what();
    if (const size_t start = what.find("syntax error"); start != what.npos) what.erase(0, start);
    if (const size_t start = what.find("] "); what.starts_with('[') && start != what.npos) what.erase(0, start + 2);
    const std::string where = path();
    throw InputError(file_, "line " + std::to_string(line) + ", column " + std::to_string(column),
                     (where.empty() ? "" : "in " + where + ": ") + "expected valid JSON, got " + what);
  }

 private:
  Json* place(Json value) {
    if (open_.empty()) {
      root = std::move(value);
      return &root;
    }
    Json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &(parent[keys_.back()] = std::move(value));
  }
  bool add(Json value) {
    place(std::move(value));
    return true;
  }
  bool close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }
  std::string path() const {
    std::string result;
    for (size_t i = 0; i < open_.size(); ++i) {
      if (open_[i]->is_array()) {
        // The value at hand, or the one being built, which the array holds already.
        const size_t count = open_[i]->size();
        result.append("[").append(std::to_string(i + 1 < open_.size() ? count - 1 : count)).append("]");
      } else if (!keys_[i].empty()) {
        result.append(result.empty() ? "" : ".").append(keys_[i]);
      }
    }
    return result;
  }

  const std::string& file_;
  std::string_view text_;
  std::vector<Json*> open_;
  std::vector<std::string> keys_;  ///< the latest of each open object
};

}  // namespace

Json parseJson(const std::string& file, std::string_view text) {
  Builder builder(file, text);
  Json::sax_parse(text.begin(), text.end(), &builder);
  return std::move(builder.root);
}

JsonValue JsonValue::member(const char* key) const {
  requireObject();
  const auto found = json_.find(key);
  if (found == json_.end()) refuse(std::string("expected the key \"") + key + "\", which is missing");
  return {*this, *found, key, 0};
}

JsonValue JsonValue::element(size_t index) const {
  return {*this, json_[index], nullptr, index};
}

void JsonValue::requireObject() const {
  if (!json_.is_object()) expected("an object");
}

size_t JsonValue::arraySize() const {
  if (!json_.is_array()) expected("an array");
  return json_.size();
}

std::string JsonValue::string() const {
  if (!json_.is_string()) expected("a string");
  return json_.get<std::string>();
}

double JsonValue::number() const {
  if (!json_.is_number()) expected("a finite number");
  return json_.get<double>();
}

bool JsonValue::boolean() const {
  if (!json_.is_boolean()) expected("true or false");
  return json_.get<bool>();
}

uint64_t JsonValue::wholeNumber(uint64_t most) const {
  if (!json_.is_number_unsigned() || json_.get<uint64_t>() > most) {
    expected("a whole number from 0 to " + std::to_string(most));
  }
  return json_.get<uint64_t>();
}

uint32_t JsonValue::index(size_t count, const char* what) const {
  if (!json_.is_number_unsigned() || json_.get<uint64_t>() >= count) {
    expected(std::string("a whole number that names one of the ") + std::to_string(count) + " " + what + ", from 0");
  }
  return json_.get<uint32_t>();
}

std::string JsonValue::path() const {
  if (!parent_) return "";
  std::string before = parent_->path();
  if (!key_) return before.append("[").append(std::to_string(index_)).append("]");
  return before.append(before.empty() ? "" : ".").append(key_);
}

void JsonValue::expected(const std::string& what) const {
  constexpr size_t kLongest = 60;
  std::string found = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (found.size() > kLongest) found = found.substr(0, kLongest) + "...";
  refuse("expected " + what + ", got " + (json_.is_structured() ? std::string(json_.type_name()) + " " : "") + found);
}

void JsonValue::refuse(const std::string& problem) const {
  throw InputError(file_, path(), problem);
}

}  // namespace radar::tools
