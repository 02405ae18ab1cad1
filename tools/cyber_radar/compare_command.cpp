#include <cmath>
#include <iostream>

#include "batch/answer_difference.h"
#include "cyber_radar/commands.h"
#include "cyber_radar/words.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr const char* kExamples = R"(Examples:
  cyber-radar compare expected.jsonl answers.jsonl
  cyber-radar compare expected.npy answers.jsonl --within 1e-9

Answers agree if their statuses, objects and triangles are equal and their distances t are, too, or no farther apart
than --within; likewise their hits, and the objects left out. The exit status is 0 if all agree, else 1.)";

struct Options {
  std::string a, b;
  double within = 0;
};

int compare(const Options& options) {
  if (!(options.within >= 0) || std::isinf(options.within)) {
    throw InputError("--within", "", "expected a finite number of 0 or more");
  }
  const AnswerDifference found = compareAnswers(options.a, options.b, options.within);
  std::cout << counted(found.answers, "answer");
  if (found.different > 0) {
    std::cout << ", " << found.different << " of them different\n" << found.first << "\n";
    return kStatusNotAsWanted;
  }
  std::cout << (found.answers == 1 ? " agrees" : " agree");
  if (found.farthest > 0) std::cout << "; distances differ by up to " << inDigits(found.farthest);
  std::cout << "\n";
  return 0;
}

}  // namespace

void addCompareCommand(Program& program) {
  Command command =
      program.add("compare", "Tells whether two answer files agree, and where they first do not", kExamples);
  auto options = std::make_shared<Options>();
  command.option("A", &options->a, "An answer file: lines of JSON, those of a shard, or records (.npy)").required();
  command.option("B", &options->b, "Another, to the same queries").required();
  command.option("--within", &options->within, "How far distances may be apart, in the meshes' units").value("LENGTH");
  command.run([options] { return compare(*options); });
}

}  // namespace radar::tools
