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

/// Their bytes, from `first` on, `stride` bytes apart.
inline std::vector<std::byte> bytesOf(std::span<const HostQuery> queries, size_t first = 0,
                                      size_t stride = sizeof(HostQuery)) {
  std::vector<std::byte> bytes(first + stride * queries.size() + 4, std::byte{0xff});
  for (size_t i = 0; i < queries.size(); ++i) {
    std::memcpy(&bytes[first + i * stride], &queries[i], sizeof(HostQuery));
  }
  return bytes;
}

inline std::vector<Result> execute(Recorder& recorder, const HostQueries& queries, const HostGeometry& geometry = {}) {
  gpu::Submission submission(test::device().impl(), false);
  recorder.record(submission.begin(), queries, geometry);
  submission.submitAndWait();
  return recorder.read().results;
}

/// From a buffer of their own.
inline std::vector<Result> execute(Recorder& recorder, std::span<const HostQuery> queries,
                                   const HostGeometry& geometry = {}) {
  const OnDevice buffer(bytesOf(queries));
  return execute(recorder, HostQueries{.buffer = buffer.get(), .count = static_cast<uint32_t>(queries.size())},
                 geometry);
}

}  // namespace radar::test
