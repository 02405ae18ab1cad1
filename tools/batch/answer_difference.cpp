#include "batch/answer_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "batch/answer_reader.h"
#include "batch/answer_rows.h"
#include "batch/json_output.h"
#include "batch/mapped_file.h"
#include "batch/part_file.h"

namespace radar::tools {

namespace {

constexpr std::array kCompared{"t", "link", "mesh", "object", "other_link", "other_mesh", "tri_a", "tri_b"};
/// NaN for null.
using Contact = std::array<double, kCompared.size()>;

/// `in`: what memberIn() reads.
template <class... In>
Contact contactIn(const In&... in) {
  Contact contact;
  std::ranges::transform(kCompared, contact.begin(),
                         [&](const char* name) { return memberIn(in..., *findAnswerField(name)); });
  return contact;
}

/// What is compared of an answer.
struct Row {
  std::optional<std::string> id;  ///< records have none
  Status status = Status::invalid;
  Contact contact;
  std::optional<std::vector<Contact>> hits;
  std::optional<std::vector<double>> overlapping;
};

class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual std::optional<Row> next() = 0;
};

class LineSource : public RowSource {
 public:
  explicit LineSource(const std::filesystem::path& file)
      : name_(file.string()), mapped_(file, "an answer file"), rest_(mapped_.bytes()) {
    if (!rest_.starts_with("{\"format\": \"cyber-radar-part-")) return;
    if (partFrom(name_, rest_).format != AnswerFormat::lines) {
      throw InputError(name_, "", "expected lines or a file .npy, got others of a shard: cyber-radar merge joins them");
    }
    rest_.remove_prefix(headerLength(rest_));
    before_ = 1;
  }

  std::optional<Row> next() override {
    if (rest_.empty()) return std::nullopt;
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(rest_.size(), line.size() + 1));
    const std::string where = name_ + ": line " + std::to_string(read_ + before_ + 1);
    const nlohmann::json json = parseJson(where, line);
    const JsonValue root(where, json);
    ++read_;
    Row row{.id = root.member("id").string(), .contact = contactIn(root)};
    const JsonValue status = root.member("status");
    row.status = status.guard([&] { return statusFrom(status.string()); });
    root.ifHas("hits", [&](const JsonValue& hits) {
      row.hits.emplace();
      hits.forEach([&](const JsonValue& hit) { row.hits->push_back(contactIn(hit)); });
    });
    root.ifHas("overlapping", [&](const JsonValue& ids) {
      row.overlapping.emplace();
      ids.forEach([&](const JsonValue& id) { row.overlapping->push_back(id.number()); });
    });
    return row;
  }

 private:
  std::string name_;
  MappedFile mapped_;
  std::string_view rest_;
  uint64_t read_ = 0, before_ = 0;
};

class RecordSource : public RowSource {
 public:
  explicit RecordSource(const std::filesystem::path& file) : columns_(file) {}

  std::optional<Row> next() override {
    if (read_ == columns_.rows()) return std::nullopt;
    const double status = memberIn(columns_, read_, *findAnswerField("status"));
    return Row{.status = std::isnan(status) ? Status::invalid : static_cast<Status>(static_cast<uint32_t>(status)),
               .contact = contactIn(columns_, read_++)};
  }

 private:
  Columns columns_;
  uint64_t read_ = 0;
};

std::unique_ptr<RowSource> sourceOf(const std::filesystem::path& file) {
  if (readFormatOf(file) == AnswerFormat::records) return std::make_unique<RecordSource>(file);
  return std::make_unique<LineSource>(file);
}

std::string textOf(double value) {
  std::string text;
  appendNumber(text, value);
  return text;
}

bool areEqual(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

class Comparison {
 public:
  Comparison(double within, std::string a, std::string b) : within_(within), a_(std::move(a)), b_(std::move(b)) {}

  /// Returns the first difference of two answers in words; empty if they agree.
  std::string between(const Row& a, const Row& b) {
    if (a.status != b.status) return differ("status", nameOf(a.status), nameOf(b.status));
    if (std::string found = between(a.contact, b.contact, ""); !found.empty()) return found;
    if (a.hits && b.hits) {
      if (a.hits->size() != b.hits->size()) return differ("hits", counted(*a.hits), counted(*b.hits));
      for (size_t i = 0; i < a.hits->size(); ++i) {
        std::string found = between((*a.hits)[i], (*b.hits)[i], "hits[" + std::to_string(i) + "].");
        if (!found.empty()) return found;
      }
    }
    if (a.overlapping && b.overlapping && *a.overlapping != *b.overlapping) {
      return differ("overlapping", listed(*a.overlapping), listed(*b.overlapping));
    }
    return "";
  }
  double farthest() const { return farthest_; }

 private:
  std::string between(const Contact& a, const Contact& b, const std::string& place) {
    for (size_t k = 0; k < kCompared.size(); ++k) {
      const double apart = std::abs(a[k] - b[k]), within = k == 0 ? within_ : 0;
      if (!areEqual(a[k], b[k]) && !(apart <= within)) return differ(place + kCompared[k], textOf(a[k]), textOf(b[k]));
      if (apart > farthest_) farthest_ = apart;
    }
    return "";
  }
  std::string differ(const std::string& what, const std::string& inA, const std::string& inB) const {
    return what + ": " + inA + " in " + a_ + ", " + inB + " in " + b_;
  }
  static std::string counted(const std::vector<Contact>& hits) { return std::to_string(hits.size()); }
  static std::string listed(const std::vector<double>& ids) {
    return listOf(ids, ", ", [](std::string& text, double id) { appendNumber(text, id); });
  }

  double within_, farthest_ = 0;
  std::string a_, b_;
};

}  // namespace

AnswerDifference compareAnswers(const std::filesystem::path& a, const std::filesystem::path& b, double within) {
  const std::unique_ptr<RowSource> inA = sourceOf(a), inB = sourceOf(b);
  Comparison comparison(within, a.string(), b.string());
  AnswerDifference difference;
  for (;; ++difference.answers) {
    const std::optional<Row> rowA = inA->next(), rowB = inB->next();
    if (!rowA && !rowB) break;
    if (!rowA || !rowB) {
      throw InputError(
          (rowA ? b : a).string(), "",
          "expected as many answers as in " + (rowA ? a : b).string() + ", got " + std::to_string(difference.answers));
    }
    const std::string place = "answer " + std::to_string(difference.answers);
    if (rowA->id && rowB->id && rowA->id != rowB->id) {
      throw InputError(
          b.string(), place,
          "expected that to query \"" + *rowA->id + "\", as in " + a.string() + ", got that to \"" + *rowB->id + "\"");
    }
    const std::string found = comparison.between(*rowA, *rowB);
    if (found.empty()) continue;
    if (difference.different++ > 0) continue;
    const std::optional<std::string>& id = rowA->id ? rowA->id : rowB->id;
    difference.first = place + (id ? ", to query \"" + *id + "\"" : "") + ": " + found;
  }
  difference.farthest = comparison.farthest();
  return difference;
}

}  // namespace radar::tools
