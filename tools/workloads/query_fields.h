// What a query may ask for beside its course, one row for each: JSON, arrays, options of commands, Python and the table
// in docs/query-file.md go by these rows.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

struct QueryField {
  using Member = std::variant<bool QuerySpec::*, uint32_t QuerySpec::*, double QuerySpec::*,
                              std::optional<double> QuerySpec::*, std::vector<ObjectId> QuerySpec::*>;
  const char* name;  ///< the key in JSON and the column; the option is this with dashes
  Member member;
  const char* about;
  double least = 0, most = std::numeric_limits<double>::max();  ///< of numbers
  const char* word = nullptr;  ///< stands for the number after `most`; in a column, 0 does
  bool lists = false;          ///< given, it makes the answer list something
  bool cast = false;           ///< a keyword of Python's Scene.cast, too
  /// In mode sampled, which refuses `no`; `idle` changes nothing there, as without the options that it is about.
  enum class Sampled { yes, idle, no } sampled = Sampled::yes;
  bool option = false;  ///< of the command sweep
  bool chain = false;   ///< of a chain, too

  /// 'b' true or false, 'u' whole number, 'f' number, 'o' ids of objects
  char kind() const { return "buffo"[member.index()]; }
};

std::span<const QueryField> queryFields();

/// The value as a number: 0 or 1 for false or true, infinity for the word, NaN for none. Not of ids.
double valueIn(const QuerySpec& query, const QueryField& field);
/// Sets such a value; returns whether the field takes it.
bool setValue(QuerySpec& query, const QueryField& field, double value);
/// Whether the query gives a value that is not the default.
bool isGiven(const QuerySpec& query, const QueryField& field);
/// Words for messages: what the field takes.
std::string expectedFor(const QueryField& field);

/// The first field given that mode sampled refuses, or null.
const QueryField* exactOnly(const QuerySpec& query);
/// The query without these, and with a motion made a sweep: what mode sampled answers of it where no object moves.
QuerySpec sampledPartOf(QuerySpec query);
/// Whether the answer has lists.
bool hasLists(const QuerySpec& query);

/// A message of the engine's in the words of query files and Python: ignoreLeaving is ignore_leaving.
std::string inOptions(std::string_view message);
/// That of an error "call: problem", without the call.
std::string problemOf(const Error& error);

/// The rows as a table in Markdown.
std::string queryFieldTable();

}  // namespace radar::tools
