#include "command/spelling.h"

#include <algorithm>
#include <numeric>

namespace radar::tools {

namespace {

// How many letters are to be added, left out, replaced, or swapped with the next, to make one word of the other (the
// optimal string alignment distance).
size_t editsBetween(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> edits(a.size() + 1, std::vector<size_t>(b.size() + 1));
  std::iota(edits[0].begin(), edits[0].end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    edits[i][0] = i;
    for (size_t k = 1; k <= b.size(); ++k) {
      edits[i][k] = std::min({edits[i - 1][k] + 1, edits[i][k - 1] + 1, edits[i - 1][k - 1] + (a[i - 1] != b[k - 1])});
      const bool isSwap = i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1];
      if (isSwap) edits[i][k] = std::min(edits[i][k], edits[i - 2][k - 2] + 1);
    }
  }
  return edits.back().back();
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  const std::string* best = nullptr;
  size_t least = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string& one : known) {
    const size_t edits = one.starts_with(word) ? 0 : editsBetween(word, one);
    if (edits >= least) continue;
    least = edits;
    best = &one;
  }
  return best == nullptr ? "" : "; did you mean " + *best + "?";
}

}  // namespace radar::tools
