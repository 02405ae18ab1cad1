#include "import/json_input.h"

#include <utility>
#include <vector>

namespace radar::tools {

namespace {

using Json = nlohmann::json;

/// Builds the document. The parser's own callbacks would take a time that grows with the square of a list's length:
/// after each object it looks through the list before it.
class Builder final : public nlohmann::json_sax<Json> {
 public:
  explicit Builder(const std::string& file) : file_(file) {}
  Json document() && { return std::move(document_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // no text has any
  bool start_object(size_t) override { return open(Json::object()); }
  bool start_array(size_t) override { return open(Json::array()); }
  bool key(string_t& name) override {
    Level& level = open_.back();
    level.key = std::move(name);
    if (!level.value->contains(level.key)) return true;
    throw InputError(file_, path(), "expected each key once, got \"" + printable(level.key, 60) + "\" twice");
  }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception& error) override {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ...": without the bracket.
    const std::string what = error.what();
    throw InputError(file_, path(), "expected valid JSON, got " + printable(what.substr(what.find("] ") + 2), 300));
  }

 private:
  static constexpr size_t kDeepest = 100;  // what is nested without end overflows the stack

  struct Level {
    Json* value;  ///< stays in place while it is open: what is around it does not grow meanwhile
    size_t index = 0;
    std::string key;
  };

  Json& place(Json value) {
    if (open_.empty()) return document_ = std::move(value);
    const Level& level = open_.back();
    if (level.value->is_object()) return (*level.value)[level.key] = std::move(value);
    level.value->push_back(std::move(value));
    return level.value->back();
  }
  bool add(Json value) {
    place(std::move(value));
    return next();
  }
  bool open(Json value) {
    if (open_.size() == kDeepest) {
      throw InputError(file_, "", "expected at most 100 levels of lists and objects, got more");
    }
    Json& placed = place(std::move(value));
    open_.push_back({&placed});
    return true;
  }
  bool close() {
    open_.pop_back();
    return next();
  }
  bool next() {
    if (!open_.empty()) ++open_.back().index;
    return true;
  }
  std::string path() const {
    std::string result;
    for (const Level& level : open_) {
      if (level.value->is_array()) {
        result += "[" + std::to_string(level.index) + "]";
      } else if (!level.key.empty()) {
        result += (result.empty() ? "" : ".") + level.key;
      }
    }
    return result;
  }

  const std::string& file_;
  Json document_;
  std::vector<Level> open_;
};

}  // namespace

Json parseJson(const std::string& file, std::string_view text) {
  Builder builder(file);
  Json::sax_parse(text, &builder);
  return std::move(builder).document();
}

}  // namespace radar::tools
