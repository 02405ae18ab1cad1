// Queries as a host's shaders write them, and as the CPU takes them.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "embed/on_device.h"
#include "radar/recorder.h"

namespace radar::test {

/// The query with its numbers rounded to floats, and with at most one exclusion.
inline HostQuery hostQueryOf(const Query& query) {
  HostQuery out;
  for (size_t i = 0; i < 12; ++i) out.worldFromMesh[i] = static_cast<float>(query.worldFromMesh.m[i]);
  for (size_t k = 0; k < 3; ++k) out.direction[k] = static_cast<float>(query.direction[k]);
  out.distance = static_cast<float>(query.distance);
  out.mesh = query.mesh;
  out.mask = query.mask;
  out.exclude = query.exclude.empty() ? kNone : query.exclude[0];
  out.flags = query.anyHit ? HostQuery::kAnyHit : 0;
  return out;
}

/// The same question.
inline Query queryOf(const HostQuery& query) {
  Query out;
  for (size_t i = 0; i < 12; ++i) out.worldFromMesh.m[i] = query.worldFromMesh[i];
  for (size_t k = 0; k < 3; ++k) out.direction[k] = query.direction[k];
  out.distance = query.distance;
  out.mesh = query.mesh;
  out.mask = query.mask;
  if (query.exclude != kNone) out.exclude = {query.exclude};
  out.anyHit = query.flags == HostQuery::kAnyHit;
  return out;
}

inline std::vector<HostQuery> hostQueriesOf(std::span<const Query> queries) {
  std::vector<HostQuery> out;
  for (const Query& query : queries) out.push_back(hostQueryOf(query));
  return out;
}

/// Their bytes, from `first` on, `stride` bytes apart.
inline std::vector<std::byte> bytesOf(std::span<const HostQuery> queries, size_t first = 0,
                                      size_t stride = sizeof(HostQuery)) {
  std::vector<std::byte> bytes(first + stride * queries.size() + 4, std::byte{0xff});
  for (size_t i = 0; i < queries.size(); ++i) {
    std::memcpy(&bytes[first + i * stride], &queries[i], sizeof(HostQuery));
  }
  return bytes;
}

/// Queries as shaders write them into a buffer of the host, and the same questions for the CPU.
struct Written {
  explicit Written(std::vector<HostQuery> given, const Device& on = test::device())
      : queries(std::move(given)), buffer(bytesOf(queries), on) {
    for (const HostQuery& query : queries) same.push_back(queryOf(query));
  }
  explicit Written(std::span<const Query> given, const Device& on = test::device())
      : Written(hostQueriesOf(given), on) {}
  operator HostQueries() const { return {.buffer = buffer.get(), .count = static_cast<uint32_t>(queries.size())}; }

  std::vector<HostQuery> queries;
  std::vector<Query> same;
  OnDevice buffer;
};

}  // namespace radar::test
