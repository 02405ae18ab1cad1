#include "measure/report.h"

#include <cmath>

#include "support/catch.h"

using namespace radar::tools;

TEST_CASE("a table is text with columns that line up, and comma-separated values") {
  const Json table{{{"name", "a, \"b\""}, {"n", 12'345}, {"share", 1.0 / 3}, {"right", true}},
                   {{"name", "c"}, {"n", 7}, {"share", NAN}, {"right", false}}};
  CHECK(textOf(table, "  ") ==
        "  name        n   share  right\n"
        "  a, \"b\"  12345  0.3333  yes\n"
        "  c           7          no\n");
  CHECK(csvOf(table) == "name,n,share,right\n\"a, \"\"b\"\"\",12345,0.3333333333333333,yes\nc,7,,no\n");
  CHECK(textOf(Json::array()).empty());
  CHECK(csvOf(Json::array()).empty());
}

TEST_CASE("columns that make lines too long follow below their row") {
  const std::string sentence(110, 'x');
  const Json table{{{"name", "a"}, {"n", 7}, {"found", sentence}, {"needed", ""}, {"so", sentence}, {"at", 8}},
                   {{"name", "b"}, {"n", 12}, {"found", "short"}, {"needed", "this"}, {"so", "that"}, {"at", 16}}};
  CHECK(textOf(table, "  ") == "  name   n\n  a      7\n    found: " + sentence + "\n    so: " + sentence +
                                   "\n    at: 8" + "\n  b     12\n    found: short; needed: this; so: that; at: 16\n");
}
