// The numbers in a Result, for C++ and for shaders: radar::Status::hit and RADAR_STATUS_hit, likewise Tier, Detected,
// Feature and Flag. To list names, expand a list with a macro of your own.
#ifndef RADAR_CODES_H
#define RADAR_CODES_H

// clang-format off

#define RADAR_STATUSES(X)                                                                                      \
  X(hit, 0)       /* certain contact within D: t*, the exact distance, lies in [lo, hi], hi <= D */            \
  X(clear, 1)     /* certainly no contact within D */                                                          \
  X(overlap, 2)   /* certain contact at the start: t = lo = hi = 0 */                                          \
  X(undecided, 3) /* no contact before lo; later contact is possible */                                        \
  X(invalid, 4)   /* not answered: Result::flags or Answers::reasons tell why */

/* The stage that produced an answer. */
#define RADAR_TIERS(X) X(select, 0) X(sampled, 1) X(contact, 2) X(reference, 3)

/* The paper's first step: whether any surface lies in the target volume. */
#define RADAR_DETECTIONS(X)                                                                                    \
  X(no, 0)        /* certainly none (after sampling: none at any pixel centre) */                              \
  X(yes, 1)       /* at least one */                                                                           \
  X(notLooked, 2) /* not determined */

/* A part of a triangle; the value is the number of its corners. */
#define RADAR_FEATURES(X) X(none, 0) X(vertex, 1) X(edge, 2) X(face, 3)

/* Bits of Result::flags: why a Recorder (radar/recorder.h) gave no answer. */
#define RADAR_FLAGS(X)                                                                                         \
  X(unresolved, 1) /* pairs of triangles too close for the device: Recorder::read() decides */                 \
  X(candidates, 2) /* Capacity::candidates, or a list of the search, was too small */                          \
  X(rounds, 4)     /* Capacity::rounds was too small */                                                        \
  X(range, 8)      /* floats cannot hold the scene, or the sensor or D relative to it */                       \
  X(bounds, 16)    /* something in HostGeometry has left its bounds */                                         \
  X(query, 32)     /* no query, or an invalid one, in HostQueries (radar/host.h) */

// clang-format on

#ifdef __cplusplus
#include <cstdint>

namespace radar {
#define RADAR_CODE(name, value) name = (value),
enum class Status : uint32_t { RADAR_STATUSES(RADAR_CODE) };
enum class Tier : uint32_t { RADAR_TIERS(RADAR_CODE) };
enum class Detected : uint32_t { RADAR_DETECTIONS(RADAR_CODE) };
enum class Feature : uint32_t { RADAR_FEATURES(RADAR_CODE) };
#undef RADAR_CODE
struct Flag {
#define RADAR_CODE(name, value) static constexpr uint32_t name = (value);
  RADAR_FLAGS(RADAR_CODE)
#undef RADAR_CODE
};
}  // namespace radar
#else
#define RADAR_CODE(name, value) const uint RADAR_STATUS_##name = (value);
RADAR_STATUSES(RADAR_CODE)
#undef RADAR_CODE
#define RADAR_CODE(name, value) const uint RADAR_TIER_##name = (value);
RADAR_TIERS(RADAR_CODE)
#undef RADAR_CODE
#define RADAR_CODE(name, value) const uint RADAR_DETECTED_##name = (value);
RADAR_DETECTIONS(RADAR_CODE)
#undef RADAR_CODE
#define RADAR_CODE(name, value) const uint RADAR_FEATURE_##name = (value);
RADAR_FEATURES(RADAR_CODE)
#undef RADAR_CODE
#define RADAR_CODE(name, value) const uint RADAR_FLAG_##name = (value);
RADAR_FLAGS(RADAR_CODE)
#undef RADAR_CODE
#endif

#endif
