// Ranges of an arena never overlap, and what is freed can be allocated again.
#include "scene/arena.h"

#include <algorithm>
#include <vector>

#include "scene/changed_pages.h"
#include "support/catch.h"
#include "workloads/random.h"

namespace {

using radar::Arena;
using radar::ChangedPages;
using radar::tools::Random;

constexpr uint32_t kCapacity = 1000;

}  // namespace

TEST_CASE("an arena's ranges are inside it and apart, whatever is allocated and freed") {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Arena arena;
    arena.reset(kCapacity);
    std::vector<bool> taken(kCapacity);
    std::vector<std::pair<uint64_t, uint64_t>> held;
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
      if (random.oneIn(3) && !held.empty()) {
        const size_t which = random.below(static_cast<uint32_t>(held.size()));
        const auto [first, count] = held[which];
        arena.free(first, count);
        std::fill_n(taken.begin() + static_cast<ptrdiff_t>(first), count, false);
        held.erase(held.begin() + static_cast<ptrdiff_t>(which));
        continue;
      }
      const uint64_t count = random.below(40);
      const auto first = arena.allocate(count);
      if (!first) {
        // Only if there is no room anywhere.
        ++refused;
        uint64_t room = 0, most = 0;
        for (const bool is : taken) most = std::max(most, room = is ? 0 : room + 1);
        REQUIRE(most < count);
        continue;
      }
      REQUIRE(*first + count <= kCapacity);
      for (uint64_t k = *first; k < *first + count; ++k) {
        REQUIRE(!taken[k]);
        taken[k] = true;
      }
      held.push_back({*first, count});
    }
    CHECK(refused > 0);
    for (const auto& [first, count] : held) arena.free(first, count);
    CHECK(arena.allocate(kCapacity) == 0);
    CHECK(!arena.allocate(1));
  }
}

TEST_CASE("readers of changed pages see every change that is new to them, and few others") {
  Random random(1);
  ChangedPages pages;
  constexpr size_t kCount = 10'000;
  pages.resize(kCount);
  std::vector<uint64_t> changedAt(kCount);
  uint64_t version = 0;
  std::vector<uint64_t> seen(3);
  for (int round = 0; round < 200; ++round) {
    for (uint32_t changes = random.below(5); changes-- > 0;) {
      const size_t element = random.below(kCount);
      pages.mark(element, ++version);
      changedAt[element] = version;
    }
    uint64_t& mine = seen[random.below(3)];
    std::vector<bool> visited(kCount);
    size_t end = 0, total = 0;
    pages.forEachSince(mine, [&](size_t first, size_t last) {
      REQUIRE((first < last && last <= kCount && first >= end));
      end = last;
      total += last - first;
      std::fill(visited.begin() + static_cast<ptrdiff_t>(first), visited.begin() + static_cast<ptrdiff_t>(last), true);
    });
    size_t changed = 0;
    for (size_t i = 0; i < kCount; ++i) {
      if (changedAt[i] <= mine) continue;
      ++changed;
      REQUIRE(visited[i]);
    }
    CHECK(total <= changed * ChangedPages::kPage);
    mine = version;
  }
}
