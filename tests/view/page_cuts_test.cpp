// What a page leaves out, and how it says so.
#include <nlohmann/json.hpp>

#include "cli/page_data.h"
#include "support/catch.h"
#include "view/page.h"
#include "workloads/generate.h"

using namespace radar;
using namespace radar::tools;

TEST_CASE("meshes that are too much for a page are boxes of the same size, with the numbers of their triangles") {
  Workload workload;
  for (const uint32_t cells : {800u, 1000u, 3u}) {  // two triangles each
    workload.meshes.push_back(makeGrid(cells, Diagonal::rising, [](uint32_t column, uint32_t row) {
      return Vec3{0.25 * column, 0.5 * row, column == 2 ? 7.0 : 1.0};
    }));
  }
  workload.scenes.push_back({"scene", {}, {{0, {}}, {1, {}}, {2, {}}}, {}});
  const nlohmann::json data = test::pageData(pageOf(workload, {}, {}));
  CHECK(data["notes"] == nlohmann::json({"The largest mesh is shown as its box."}));
  CHECK(data["meshes"][0]["isBox"] == false);
  CHECK(data["meshes"][1]["isBox"] == true);
  CHECK(data["meshes"][1]["triangles"] == 2'000'000);
  CHECK(data["meshes"][1]["indices"]["u4"].get<std::string>().size() == 4 * 12 * 3 * 4 / 3);
}

TEST_CASE("a page shows the lists of the first queries, and keeps the objects in them") {
  Workload workload = makeWorkload(Figure7{.teapots = 3, .boxes = 100'010, .steps = 1});
  const std::vector<Result> answers(workload.queries.size(), Result(Status::clear));
  std::vector<ListedMoment> contacts(60'000, {Result(Status::hit)});
  for (ListedMoment& contact : contacts) contact.result.object = 100'009;
  PageContent content;
  for (const uint32_t query : {0u, 2u}) content.moments[query] = contacts;
  const nlohmann::json data = test::pageData(pageOf(workload, answers, content));
  CHECK(data["moments"]["first"] == nlohmann::json({{"u4", "AAAAAGDqAABg6gAAYOoAAA=="}}));  // 0, and three times 60,000
  CHECK(data["notes"][0] == "Lists of contacts are those of the first 2 queries.");
  const std::string numbers = data["scenes"][0]["number"]["u4"];
  CHECK(numbers.ends_with("qYYBAA=="));  // 100,009
}

TEST_CASE("a page keeps what is touched, also in the base of a scene, and leaves out scenes without queries") {
  Workload workload = makeWorkload(Figure7{.teapots = 3, .boxes = 100'010, .steps = 3});
  workload.queries.erase(workload.queries.begin() + 3, workload.queries.end());
  std::vector<Result> answers(3, Result(Status::hit));
  answers[0].object = 100'009;
  answers[1].object = 100'012;  // a teapot
  const nlohmann::json data = test::pageData(pageOf(workload, answers, {}));
  const auto count = [&](size_t scene) {
    const std::string text = data["scenes"][scene]["number"]["u4"];
    return (3 * text.size() / 4 - (text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0)) / 4;
  };
  CHECK(count(0) == 100'000);
  CHECK(count(1) == 1);  // of three; no other has room
  CHECK(count(2) == 0);
  CHECK(data["notes"].size() == 2);
}
