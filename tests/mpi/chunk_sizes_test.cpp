#include "mpi/chunk_sizes.h"
#include "support/catch.h"

using radar::tools::ChunkSizes;

TEST_CASE("chunks take about a tenth of a second and shrink towards the end") {
  ChunkSizes sizes(4);
  CHECK(sizes.next(0, 1'000'000) == 64);  // before anything is known
  sizes.answered(0, 64, 0.064);
  CHECK(sizes.next(0, 1'000'000) == 100);
  sizes.answered(0, 100, 1e-9);
  CHECK(sizes.next(0, 1'000'000) == 800);
  sizes.answered(0, 60'000, 1e-9);
  CHECK(sizes.next(0, 100'000'000) == 65'536);
  CHECK(sizes.next(0, 16'000) == 1'000);
  CHECK(sizes.next(0, 100) == 16);
  CHECK(sizes.next(0, 5) == 5);
  sizes.answered(1, 1, 60);
  CHECK(sizes.next(1, 1'000'000) == 16);
}

TEST_CASE("chunks of any speed add up to all queries") {
  for (const double seconds : {1e-7, 1e-4, 1e-2, 10.0}) {
    ChunkSizes sizes(3);
    uint64_t remaining = 100'000, chunks = 0;
    for (size_t rank = 0; remaining > 0; rank = (rank + 1) % 3) {
      const uint64_t size = sizes.next(rank, remaining);
      REQUIRE((size >= 1 && size <= remaining));
      remaining -= size;
      sizes.answered(rank, size, seconds * static_cast<double>(size));
      ++chunks;
    }
    CHECK(chunks >= 10);
  }
}
