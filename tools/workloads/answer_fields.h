// What an answer says of its query, one row for each member: lines, tables, records and their reader, Python's arrays,
// the page and the table in docs/query-file.md go by these rows. What a query lists besides is in radar::Listed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

/// An answer, as members take their values from it.
struct AnswerRow {
  /// `links`: of a chain's answer.
  AnswerRow(const Query& query, const Result& answer, AnswerMode mode, std::optional<double> speed = {},
            uint64_t index = 0, std::optional<LinksMet> links = {});

  const Query& query;
  Result result;  ///< t, lo and hi are distances (radar::toDistances)
  std::optional<LinksMet> links;
  bool isStep;                    ///< takesStep(query), or of a chain
  double fractionLo, fractionHi;  ///< of a step; else NaN
  bool isSampled;                 ///< answered in mode sampled
  std::optional<double> speed;    ///< the query's
  uint64_t index;                 ///< of the query
};

/// Which answers have a member.
enum class When { never, always, step, near, timed, sampled, chain };

struct AnswerName {
  const char* name;
};

struct AnswerType {
  const char* type;                      ///< as numpy writes it
  size_t width = 1;                      ///< numbers
  std::span<const char* const> words{};  ///< of a code; of what is none, "none"

  constexpr bool isReal() const { return type[1] == 'f'; }
  bool isTruth() const;  ///< the words are true and false
};

struct AnswerAccess {
  /// NaN if there is none; in whole numbers that is -1.
  double (*value)(const AnswerRow& row, size_t part);
  /// The way back, of members that a Result has. NaN leaves it as it is.
  void (*set)(Result& to, double value, size_t part) = nullptr;
};

struct AnswerPlaces {
  When line, hit;  ///< in lines and tables, and in contacts that lines list
  When casts;      ///< in Python
  bool page = false;
};

struct AnswerMember : AnswerName, AnswerType, AnswerAccess, AnswerPlaces {
  size_t place;                  ///< in a record of a file, or beyond it: a byte
  const char* ofStep = nullptr;  ///< the member that has a Result's number where takesStep(query)
};

struct AnswerField : AnswerMember {
  const char* about;
};

std::span<const AnswerField> answerFields();
/// Null where there is none.
const AnswerField* findAnswerField(std::string_view name);
/// Whether an answer, or a contact in its list, has what is there at that time.
bool has(const AnswerRow& row, When when);
/// The code of a word; NaN if the member has no such word.
double codeOf(const AnswerField& field, std::string_view word);
/// For messages: "false or true".
std::string wordsOf(const AnswerField& field);

/// A record: members at places, little-endian.
struct AnswerLayout {
  struct Member {
    const AnswerField* field;
    size_t place;
  };
  std::vector<Member> members;  ///< by place
  size_t size = 0;
  bool keepsInfinities = false;  ///< else they are NaN

  void write(const AnswerRow& row, char* record) const;
  Result read(const char* record) const;
};
/// Of files.
const AnswerLayout& fileLayout();
/// Of Python's arrays.
const AnswerLayout& castsLayout(bool sampled);

const char* nameOf(Status status);
/// Throws std::invalid_argument that lists the names.
Status statusFrom(std::string_view name);
const char* nameOf(Tier tier);
const char* nameOf(Feature feature);

/// The rows as a table in Markdown.
std::string answerFieldTable();

}  // namespace radar::tools
