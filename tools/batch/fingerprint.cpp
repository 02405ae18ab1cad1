#include "batch/fingerprint.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdio>

namespace radar::tools {

void Fingerprint::addBytes(std::span<const std::byte> bytes) {
  const XXH128_hash_t more = XXH3_128bits(bytes.data(), bytes.size());
  const uint64_t chained[] = {hash_[0], hash_[1], more.low64, more.high64};
  const XXH128_hash_t all = XXH3_128bits(chained, sizeof chained);
  hash_ = {all.low64, all.high64};
}

std::string Fingerprint::text() const {
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(hash_[1]),
                static_cast<unsigned long long>(hash_[0]));
  return digits;
}

}  // namespace radar::tools
