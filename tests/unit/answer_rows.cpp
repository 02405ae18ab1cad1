// The bytes of answers, which people read with programs of their own: lines, and records of numpy's.
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "batch/answer_rows.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Asked {
  QuerySpec query;
  Answer answer;
};

Result hit() {
  Result result;
  result.status = Status::hit;
  result.tier = Tier::contact;
  result.detected = Detected::yes;
  result.t = 0.1 + 0.2;
  result.lo = 0.3;
  result.hi = 100'000;
  result.fraction = 1e-300;
  result.object = 100'000;
  result.triB = 4294967294u;
  result.triA = 0;
  result.featureA = Feature::vertex;
  result.featureB = Feature::face;
  result.point = {1, -2.5, kInfinity};
  result.normal = {0, 0.6, -0.8};
  result.gap = 0.125;
  result.paperMinL = -0.25;
  return result;
}

/// One of each kind.
std::vector<Asked> allKinds() {
  std::vector<Asked> all(9);
  for (size_t i = 0; i < all.size(); ++i) all[i].query.id = "\"" + std::to_string(i) + "\"\n";
  all[0].answer.reason = "out of \"memory\"";
  all[0].query.scene = 1;
  // Of what nobody asked, nothing is listed.
  all[1].answer = {.result = hit(), .listed = {.hits = {hit()}, .overlapping = {3}}};
  all[2].answer = {.result = hit(), .mode = AnswerMode::sampled};
  all[2].answer.result.tier = Tier::sampled;
  all[3].answer.result = Result(Status::clear);
  all[3].answer.result.detected = Detected::no;
  all[3].query.speed = 2;
  all[4].answer = {.result = Result(Status::undecided), .mode = AnswerMode::sampled};
  all[4].answer.result.lo = 1e22;
  all[4].answer.result.paperMinL = kInfinity;
  all[5].answer.result = hit();
  all[5].answer.result.status = Status::overlap;
  all[5].answer.result.t = all[5].answer.result.lo = all[5].answer.result.hi = 0;
  all[5].answer.result.normal.fill(std::nan(""));
  all[6].query.motion = {0, 3, 4};
  all[6].query.speed = 10;
  all[6].answer.result = hit();
  all[6].answer.result.t = all[6].answer.result.fraction = 0.5;
  all[6].answer.result.lo = 0.4375;
  all[6].answer.result.hi = 0.75;
  all[7].query = all[6].query;
  all[7].query.hits = kAllHits;
  all[7].query.skipOverlapping = true;
  all[7].answer = all[6].answer;
  all[7].answer.listed = {.hits = {all[6].answer.result, Result(Status::undecided)}, .overlapping = {3, 100'000}};
  all[8].query.hits = 2;
  all[8].query.clearance = 0.25;
  all[8].query.scene = 1;
  all[8].answer = {.result = hit(), .listed = {.hits = {hit()}}};
  all[8].answer.result.object = all[8].answer.listed.hits[0].object = 1;
  return all;
}

std::string rowsIn(AnswerFormat format) {
  Workload world;
  world.scenes.resize(2);
  world.scenes[1].instances.resize(2);
  world.scenes[1].names = {"", "the \"lid\""};
  std::vector<QuerySpec> queries;
  std::vector<Answer> answers;
  for (Asked& one : allKinds()) {
    queries.push_back(std::move(one.query));
    answers.push_back(std::move(one.answer));
  }
  return startOf(format, queries.size()) + AnswerRows(world, format).text(0, queries, answers);
}

std::string stored(const char* name) {
  std::ifstream file(std::string(RADAR_STORED_ANSWERS) + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("lines and records of answers have the bytes that they had") {
  CHECK(rowsIn(AnswerFormat::lines) == stored(".jsonl"));
  CHECK((rowsIn(AnswerFormat::records) == stored(".npy")));
}
