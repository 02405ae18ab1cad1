// A compiler may take double(float(x)) for x: GCC 12 does with -O2, which this program is compiled with. Then the
// queries by which a device proves itself are not those that a shader reads as floats.
#include "proof/known_scene.h"

#include <algorithm>

#include "support/catch.h"

using namespace radar;

namespace {

bool isFloat(double x) {
  volatile float rounded = static_cast<float>(x);
  return rounded == x;
}

}  // namespace

TEST_CASE("the known queries are floats") {
  for (const uint64_t seed : {0u, 1u, 2u}) {
    const KnownScene known(seed);
    for (const Query& query : known.queries) {
      CHECK(std::all_of(query.direction.begin(), query.direction.end(), isFloat));
      CHECK(std::all_of(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), isFloat));
      CHECK(isFloat(query.distance));
    }
  }
}
