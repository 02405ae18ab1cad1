#include <limits>
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

TEST_CASE("values that an answer does not have are null") {
  Result clear(Status::clear);
  clear.detected = Detected::no;
  CHECK(answerLine(queryWithId("a"), {.result = clear}) ==
        R"({"id": "a", "status": "clear", "t": null, "lo": null, "hi": null, "fraction": null, "detected": false, )"
        R"("object": null, "tri_a": null, "tri_b": null, "feature_a": null, "feature_b": null, "point": null, )"
        R"("normal": null, "tier": "select"})");
}

TEST_CASE("time appears only with a speed, paper_min_l only in mode sampled, and reason only if invalid") {
  QuerySpec query = queryWithId("a");
  query.speed = 2;
  const auto timed = nlohmann::json::parse(answerLine(query, {.result = hit(), .mode = AnswerMode::reference}));
  CHECK(timed["time"] == (0.1 + 0.2) / 2);
  CHECK_FALSE(timed.contains("paper_min_l"));
  CHECK_FALSE(timed.contains("reason"));
  const auto invalid =
      nlohmann::json::parse(answerLine(query, {.mode = AnswerMode::sampled, .reason = "out of memory"}));
  CHECK(invalid["status"] == "invalid");
  CHECK(invalid["reason"] == "out of memory");
  CHECK(invalid["time"].is_null());
  CHECK(invalid["paper_min_l"].is_null());
  CHECK(invalid["detected"].is_null());
}

TEST_CASE("hits and overlapping objects appear only where the query asks for them") {
  QuerySpec query = queryWithId("a");
  query.hits = 2;
  query.skipOverlapping = true;
  const Answer answer{.result = hit(), .listed = {.hits = {hit(), hit()}, .overlapping = {3, 5}}};
  const auto line = nlohmann::json::parse(answerLine(query, answer));
  CHECK(line["overlapping"] == nlohmann::json::parse("[3, 5]"));
  REQUIRE(line["hits"].size() == 2);
  CHECK(line["hits"][1] == nlohmann::json::parse(R"({"object": 7, "t": 0.30000000000000004, "lo": 0,
      "hi": 0.30000000000000004, "tri_a": 0, "tri_b": 4294967294, "feature_a": "vertex", "feature_b": "face",
      "point": [1, -2.5, 1e22], "normal": [0, 0, -1]})"));
  const auto none = nlohmann::json::parse(answerLine(query, {}));
  CHECK((none["hits"].empty() && none["hits"].is_array() && none["overlapping"].is_array()));
  const auto plain = nlohmann::json::parse(answerLine(queryWithId("a"), answer));
  CHECK_FALSE((plain.contains("hits") || plain.contains("overlapping")));
}

TEST_CASE("objects are named where the scene has names") {
  QuerySpec query = queryWithId("a");
  query.hits = 2;
  const std::vector<std::string> names{"", "", "", "", "", "", "", "the \"lid\""};
  Result other = hit();
  other.object = 3;
  const auto line =
      nlohmann::json::parse(answerLine(query, {.result = hit(), .listed = {.hits = {hit(), other}}}, names));
  CHECK(line["object_name"] == "the \"lid\"");
  CHECK(line["hits"][0]["object_name"] == "the \"lid\"");
  CHECK(line["hits"][1]["object_name"].is_null());
  CHECK(nlohmann::json::parse(answerLine(query, {}, names))["object_name"].is_null());
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

TEST_CASE("a query with a motion is answered in fractions and in distances of its sensor") {
  QuerySpec query = queryWithId("a");
  query.motion = {0, 3, 4};
  query.speed = 10;
  Result result = hit();
  result.t = result.fraction = 0.5;
  result.lo = 0.4375;
  result.hi = 0.75;
  const auto line = nlohmann::json::parse(answerLine(query, {.result = result, .listed = {.hits = {result}}}));
  CHECK((line["fraction"] == 0.5 && line["fraction_lo"] == 0.4375 && line["fraction_hi"] == 0.75));
  CHECK((line["t"] == 2.5 && line["time"] == 0.25));
  CHECK((line["lo"] <= 2.1875 && line["lo"] > 2.1874 && line["hi"] >= 3.75 && line["hi"] < 3.7501));
  const auto clear = nlohmann::json::parse(answerLine(query, {.result = Result(Status::clear)}));
  CHECK((clear["fraction_lo"].is_null() && clear["hi"].is_null() && clear["time"].is_null()));
  query.motion = {0, 0, 0};
  CHECK(nlohmann::json::parse(answerLine(query, {.result = result}))["t"] == 0);
}
