// What C++ and the shaders share, in scalar layout. Lengths are metres; z is up.
#ifndef EXAMPLE_SHARED_H
#define EXAMPLE_SHARED_H

#ifdef __cplusplus
#include <array>
#include <cstdint>

namespace example {

using vec3 = std::array<float, 3>;
using uint = uint32_t;
#endif

// Places and strides are multiples of 1/kGrid, so that their sums are exact: an agent that has moved stands exactly
// where its query said that it would, not a rounding beside.
const float kGrid = 4096.0f;
const float kPitch = 18.0f;  // from building to building
const float kReach = 12.0f;  // how far agents look ahead
const float kClose = 4.0f;   // agents turn away from what is closer ahead
const float kSkin = 0.1f;    // what is left between an agent and what it would touch
const int kStrides = 4;      // a move is up to this many strides
const uint kBuckets = 1u << 15;
const float kCell = 2.5f;  // side of the cells in which claims are found, at least the widest claim

struct Agent {
  vec3 place;
  float clear;  // free distance ahead, at most kReach
  vec3 normal;  // of what limits it
  uint goal;    // the number of the place that it goes to
};

// What an agent would like to do in this frame, and the sphere in which it does so.
struct Claim {
  vec3 stride;
  vec3 centre;
  float radius;
  uint link;  // the next claim in the same bucket, plus 1
};

struct Push {
  vec3 eye;  // looks at the middle of the city
  float aspect;
  uint frame;
  uint agents;   // objects 0, 1, 2, ...
  uint mesh;     // theirs
  float radius;  // of a sphere around an agent's place that contains it
  float city;    // half its side
};

// Bindings.
const uint kAgents = 0, kClaims = 1, kGridCells = 2, kQueries = 3, kResults = 4, kTransforms = 5, kVertices = 6,
           kBindings = 7;

#ifdef __cplusplus
static_assert(sizeof(Agent) == 32 && sizeof(Claim) == 32 && sizeof(Push) == 36);
}  // namespace example
#endif

#endif
