#include "fuzz/target.h"
#include "workloads/random.h"

namespace radar::fuzz {

std::vector<std::string> randomSeeds(size_t count, size_t bytes) {
  tools::Random random(1);
  std::vector<std::string> seeds(count);
  for (std::string& seed : seeds) {
    seed.resize(bytes);
    for (char& byte : seed) byte = static_cast<char>(random.below(256));
  }
  return seeds;
}

std::vector<std::string> separated(std::string_view words) {
  std::vector<std::string> all(1);
  for (const char c : words) {
    if (c == '~') {
      all.emplace_back();
    } else {
      all.back() += c;
    }
  }
  return all;
}

}  // namespace radar::fuzz
