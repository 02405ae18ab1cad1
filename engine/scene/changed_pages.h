// When the elements of an array last changed, by pages, so that readers that follow it look at what changed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace radar {

/// Versions are at least 1 and increase with every change.
class ChangedPages {
 public:
  /// The array has `count` elements; new ones have not changed.
  void resize(size_t count) {
    pages_.resize((count + kPage - 1) / kPage);
    count_ = count;
  }
  void mark(size_t element, uint64_t version) { pages_[element / kPage] = version; }
  void markAll(uint64_t version) { std::fill(pages_.begin(), pages_.end(), version); }

  /// Calls visit(first, last) for ranges of elements, ascending and apart, that contain all those changed after `seen`.
  template <class Visit>
  void forEachSince(uint64_t seen, const Visit& visit) const {
    for (size_t page = 0; page < pages_.size(); ++page) {
      if (pages_[page] <= seen) continue;
      const size_t first = page;
      while (page + 1 < pages_.size() && pages_[page + 1] > seen) ++page;
      visit(first * kPage, std::min((page + 1) * kPage, count_));
    }
  }

  static constexpr size_t kPage = 64;

 private:
  std::vector<uint64_t> pages_;
  size_t count_ = 0;
};

}  // namespace radar
