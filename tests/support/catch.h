// Catch2, in release 2 or 3.
#pragma once

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif

#include <string>

namespace radar::test {

using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

/// Matches a text that contains `part`.
inline auto Contains(const std::string& part) {
#if CATCH_VERSION_MAJOR < 3
  return Catch::Matchers::Contains(part);
#else
  return Catch::Matchers::ContainsSubstring(part);
#endif
}

}  // namespace radar::test
