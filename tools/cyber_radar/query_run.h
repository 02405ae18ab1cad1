// A run over a query file: what it is of, and its chunks.
#pragma once

#include <functional>

#include "batch/part_file.h"
#include "cyber_radar/answering.h"
#include "cyber_radar/options.h"

namespace radar::tools {

/// --out, --stats, --shard and --resume, beside the options of the engine.
struct RunOptions {
  EngineOptions engine;
  std::string file, out, stats, shard;
  bool resume = false;

  /// `about`: what --stats writes. Returns --out.
  Option addTo(Command& command, const std::string& about);
  /// Throws InputError that names the option.
  void check() const;
  /// What the run writes. Throws InputError that names the option.
  Outputs outputs() const;
  /// Throws InputError if answers to these queries cannot be written as the options say.
  void checkFormat(const QueryFile& queries) const;
  /// What the answers of this run are part of. In mode sampled, opens what `answering` needs.
  Part part(const QueryFile& queries, Answering& answering) const;
};

/// The names of devices and drivers, for messages and for runs in mode sampled.
std::string namesOf(std::span<const Device> devices);

/// What a run did.
struct Done {
  uint64_t queries = 0, kept = 0;       ///< answered, and answered before it
  double seconds = 0, preparation = 0;  ///< answering, and reading the file and setting up
};
/// The last line on standard error. `more` stands behind the time: " on 3 ranks".
void sayDone(const char* program, const Done& done, const std::string& more);

/// Receives the answers to consecutive queries, the first of which has the index `first`.
using AnswerSink =
    std::function<void(uint64_t first, std::span<const QuerySpec> queries, std::span<const Answer> answers)>;

/// Seconds in which nothing was answered.
struct Waited {
  double reading = 0;  ///< for the first queries
  double writing = 0;  ///< for the sink, and for reading further queries
};

/// Calls `ask` about queries of the file from `first` on. What the engine refuses is refused at its place in the file.
template <class Ask>
decltype(auto) placed(const QueryFile& file, uint64_t first, const Ask& ask) {
  try {
    return ask();
  } catch (const RefusedQuery& query) {
    file.refuse(first + query.index, query.problem);
  }
}

/// Answers the queries from `first` to before `end` in chunks of about two seconds, in order. While a chunk is
/// answered, another thread gives the sink the last one and reads the next. Rethrows what the sink throws.
Waited answerRange(const QueryFile& queries, uint64_t first, uint64_t end, Answering& answering,
                   const std::string& label, const AnswerSink& sink);

}  // namespace radar::tools
