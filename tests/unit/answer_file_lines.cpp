#include <nlohmann/json.hpp>

#include "batch/answer_file.h"
#include "batch/atomic_file.h"
#include "support/catch.h"
#include "support/scratch_folder.h"

using namespace radar;
using namespace radar::tools;

namespace {

Result hit() {
  Result result;
  result.status = Status::hit;
  result.tier = Tier::sampled;
  result.detected = Detected::yes;
  result.t = result.hi = 0.1 + 0.2;
  result.lo = 0;
  result.fraction = 1e-300;
  result.object = 7;
  result.triB = 4294967294u;
  result.triA = 0;
  result.featureA = Feature::vertex;
  result.featureB = Feature::face;
  result.point = {1, -2.5, 1e22};
  result.normal = {0, 0, -1};
  result.paperMinL = -0.25;
  return result;
}

QuerySpec queryWithId(const std::string& id) {
  QuerySpec query;
  query.id = id;
  return query;
}

}  // namespace

TEST_CASE("an answer line has every key in order and the shortest numbers that read back the same") {
  CHECK(
      answerLine(queryWithId("ring/0"), {.result = hit(), .mode = AnswerMode::sampled}) ==
      R"({"id": "ring/0", "status": "hit", "t": 0.30000000000000004, "lo": 0, "hi": 0.30000000000000004, )"
      R"("fraction": 1e-300, "detected": true, "object": 7, "tri_a": 0, "tri_b": 4294967294, )"
      R"("feature_a": "vertex", "feature_b": "face", "point": [1, -2.5, 1e+22], "normal": [0, 0, -1], "tier": "sampled", "paper_min_l": -0.25})");
}

TEST_CASE("lists appear only where the query asks for them, and names and times of nothing are null") {
  QuerySpec query = queryWithId("a");
  const Answer answer{.result = hit(), .listed = {.hits = {hit(), hit()}, .overlapping = {3, 5}}};
  const auto plain = nlohmann::json::parse(answerLine(query, answer));
  CHECK_FALSE((plain.contains("hits") || plain.contains("overlapping")));
  query.hits = 2;
  query.skipOverlapping = true;
  query.motion = {0, 0, 0};
  const std::vector<std::string> names(8);
  const auto full = nlohmann::json::parse(answerLine(query, answer, names));
  CHECK((full["hits"].size() == 2 && full["hits"][1]["object_name"].is_null() && full["t"] == 0));
  const auto none = nlohmann::json::parse(answerLine(query, {}, names));
  CHECK((none["hits"].empty() && none["hits"].is_array() && none["overlapping"].is_array()));
  CHECK((none["object_name"].is_null() && none["fraction_lo"].is_null()));
}

TEST_CASE("an id of any characters reads back unchanged") {
  const std::string id = "\"quoted\"\n\\ \x01 \xc3\xa4";
  CHECK(nlohmann::json::parse(answerLine(queryWithId(id), {.result = hit(), .mode = AnswerMode::sampled}))["id"] == id);
}

TEST_CASE("writeAtomically writes a whole file or leaves nothing") {
  const radar::test::ScratchFolder folder;
  writeAtomically(folder.path() / "a", "first");
  writeAtomically(folder.path() / "a", "second");
  CHECK(folder.read("a") == "second");
  CHECK_THROWS_WITH(writeAtomically(folder.path() / "no" / "a", "x"), test::Contains("no/a"));
  std::filesystem::create_directory(folder.path() / "b");
  CHECK_THROWS(writeAtomically(folder.path() / "b", "x"));
  CHECK(folder.list() == "a b");
}
