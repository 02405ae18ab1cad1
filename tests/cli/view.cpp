// Pages of answers, as far as their data goes; tests/view looks at them in a browser.
#include "cli/page_data.h"
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

constexpr const char* kTriangle = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";

/// A query file of one object at z = 5, and these queries.
std::string queryFile(const std::string& queries) {
  return R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"],
    "scenes": [{"instances": [[0, 1,0,0,0, 0,1,0,0, 0,0,1,5]]}], "queries": [)" +
         queries + "]}";
}

std::string query(const std::string& id, const std::string& more) {
  return R"({"id": ")" + id + R"(", "scene": 0, "sensor": [0], )" + more + "}";
}

}  // namespace

TEST_CASE("a page is the same whether its answers are found, or read as lines or as records") {
  const ScratchFolder folder;
  folder.write("a.obj", kTriangle);
  folder.write("steps.json",
               queryFile(query("up", R"("motion": [0, 0, 10])") + "," + query("down", R"("motion": [0, 0, -1])") + "," +
                         query("any", R"("motion": [0, 0, 9], "any_hit": true)") + "," +
                         query("near", R"("dir": [0, 0, 1], "D": 8, "clearance": 0.5)")));
  // Records cannot list contacts, or what overlaps.
  std::string several = queryFile(query("all", R"("dir": [0, 0, 1], "D": 8, "hits": "all", "ignore_leaving": true)") +
                                  "," + query("near", R"("dir": [0, 0, 1], "D": 8, "hits": 2, "clearance": 0.5)") +
                                  "," + query("step", R"("motion": [0, 1, 9], "hits": "all", "clearance": 0.5)"));
  several.insert(several.find("], \"queries\"") - 2, ", [0, 1,0,0,0, 0,1,0,0, 0,0,1,7]");
  folder.write("several.json", several);
  folder.write("left.json", queryFile(query("free", R"("dir": [0, 0, 1], "D": 8, "skip_overlapping": true)") + "," +
                                      R"({"id": "left out", "scene": 0, "sensor": [0, 1,0,0,1, 0,0,-1,1, 0,1,0,3],
                                          "dir": [0, 0, 1], "D": 8, "skip_overlapping": true})"));
  succeed(folder, "workload soup --objects 40 --sensors 50 --out soup");
  succeed(folder, "workload figure7 --teapots 3 --boxes 40 --steps 2 --out flight");
  for (const std::string file :
       {"flight/queries.json", "soup/queries.json", "steps.json", "several.json", "left.json"}) {
    CAPTURE(file);
    succeed(folder, "view " + file + " --mode reference --out found.html");
    for (const std::string answers : {"answers.jsonl", "answers.npy"}) {
      CAPTURE(answers);
      if ((file == "left.json" || file == "several.json") && answers == "answers.npy") continue;
      succeed(folder, "query " + file + " --mode reference --out " + answers);
      const Run run = succeed(folder, "view " + file + " " + answers + " --out read.html");
      CHECK(folder.read("read.html") == folder.read("found.html"));
    }
  }
  const auto found = pageData(folder.read("found.html"));
  CHECK(found["queries"]["asked"]["0"] == nlohmann::json({{"skip_overlapping", true}}));
  CHECK(found["left"] == nlohmann::json::parse(R"({"1": [0]})"));
  succeed(folder, "view flight/queries.json --mode reference --out found.html --title Flight");
  const auto data = pageData(folder.read("found.html"));
  CHECK(data["title"] == "Flight");
  CHECK(data["queries"]["count"] == 6);
  CHECK(data["scenes"].size() == 3);
  CHECK(data["queries"]["ignored"]["2"] == nlohmann::json({42}));
  CHECK(data["notes"].empty());
}

TEST_CASE("text of a query file cannot leave the page's data") {
  const ScratchFolder folder;
  folder.write("a.obj", kTriangle);
  const std::string hostile = "</script><script>document.title = 'mine'</script><!--";
  folder.write("q.json", queryFile(query(hostile, R"("dir": [0,0,1], "D": 8)")));
  succeed(folder, "view q.json --mode reference --out q.html");
  const std::string page = folder.read("q.html");
  CHECK(page.find(hostile) == std::string::npos);
  CHECK(pageData(page)["queries"]["id"] == nlohmann::json({hostile}));
}

TEST_CASE("what is too much for a page is cut, and the page says so") {
  const ScratchFolder folder;
  succeed(folder, "workload scale --boxes 100001 --sensors 10001 --shape box --out w");
  succeed(folder, "view w/queries.json --mode reference --out w.html");
  const auto data = pageData(folder.read("w.html"));
  CHECK(data["queries"]["count"] == 10'000);
  CHECK(data["notes"] == nlohmann::json({"The first 10000 of 10001 queries.",
                                         "Scene boxes: 100000 of 100001 objects, with all that answers name."}));
}

TEST_CASE("answers that are not those of the queries are refused") {
  const ScratchFolder folder;
  folder.write("a.obj", kTriangle);
  folder.write("q.json",
               queryFile(query("p", R"("dir": [0,0,1], "D": 8)") + "," + query("q", R"("dir": [0,0,1], "D": 1)")));
  succeed(folder, "query q.json --mode reference --out good.jsonl");
  succeed(folder, "query q.json --mode reference --shard 0/2 --out part.npy");
  const std::string good = folder.read("good.jsonl"), first = good.substr(0, good.find('\n') + 1);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  folder.write("short.jsonl", first);
  folder.write("long.jsonl", good + first);
  folder.write("order.jsonl", good.substr(first.size()) + first);
  folder.write("status.jsonl", changed("\"hit\"", "\"hurt\""));
  folder.write("object.jsonl", changed("\"object\": 0", "\"object\": 1"));
  folder.write("triangle.jsonl", changed("\"tri_a\": 0", "\"tri_a\": -1"));
  folder.write("point.jsonl", changed("\"point\": [", "\"point\": [0, "));
  folder.write("text.jsonl", changed("\"t\": 5", "\"t\": \"5\""));
  folder.write("cut.jsonl", good.substr(0, good.size() - 9));
  folder.write("list.jsonl", changed("\"point\": [", "\"hits\": [{\"object\": 0}, {\"object\": null}], \"point\": ["));
  folder.write("other.npy", "what is no array\n");
  for (const auto& [answers, words] :
       {std::pair{"short.jsonl", "short.jsonl: expected 2 answers, one for each query, got 1"},
        std::pair{"long.jsonl", "long.jsonl: expected 2 answers, one for each query, got 3"},
        std::pair{"order.jsonl", "order.jsonl: line 1: expected the answer to query \"p\", got that to \"q\""},
        std::pair{"status.jsonl", "status.jsonl: line 1: status: expected hit, clear, overlap, undecided or invalid"},
        std::pair{"object.jsonl", "object.jsonl: line 1: object: expected a whole number below 1"},
        std::pair{"triangle.jsonl", "triangle.jsonl: line 1: tri_a: expected a whole number below 1"},
        std::pair{"point.jsonl", "point.jsonl: line 1: point: expected three numbers"},
        std::pair{"list.jsonl", "list.jsonl: line 1: hits[1].object: expected a whole number that names one of the 1"},
        std::pair{"text.jsonl", "text.jsonl: line 1: t: expected a finite number"},
        std::pair{"cut.jsonl", "cut.jsonl: line 2"}, std::pair{"other.npy", "other.npy: "},
        std::pair{"part.npy", "part.npy: expected an array"}, std::pair{"none.jsonl", "none.jsonl: expected"}}) {
    checkRefused(folder, std::string("view q.json ") + answers + " --out page.html", words);
  }
  checkRefused(folder, "view q.json good.jsonl --out good.jsonl",
               "--out: good.jsonl: expected another file than those");
  checkRefused(folder, "view q.json --out a.obj", "--out: a.obj: expected another file than those");
  checkRefused(folder, "view q.json --out nowhere/page.html", "--out: nowhere/page.html: expected");
  checkRefused(folder, "view q.json", "--out");
  checkRefused(folder, "view q.json good.jsonl --mode sampled --out page.html", "--mode: expected it only where");
  checkRefused(folder, "view q.json good.jsonl --threads 1 --out page.html", "--threads: expected it only where");
  checkRefused(folder, "view q.json good.jsonl --gltf q.glb --title Q", "--title: expected it with --out");
  // What is too large for a double is null.
  folder.write("huge.jsonl", changed("\"point\": [", "\"point\": [1e308, null, 0], \"was\": ["));
  succeed(folder, "view q.json huge.jsonl --out huge.html");
  checkRefused(folder, "sweep a.obj a.obj --direction 0 0 1 --distance 1 --view a.obj",
               "--view: a.obj: expected another");
}
