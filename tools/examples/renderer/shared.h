// What C++ and the shaders share, in scalar layout. Lengths are metres; z is up.
#ifdef __cplusplus
#pragma once

#include <array>
#include <cstdint>

namespace example {

using vec3 = std::array<float, 3>;
using uint = uint32_t;
#endif

// Places and strides are multiples of 1/kGrid, so that their sums are exact: an agent that has moved stands exactly
// where its query said that it would, not a rounding beside.
const float kGrid = 4096.0f;
const float kPitch = 18.0f;   // from building to building
const float kReach = 12.0f;   // how far agents look ahead
const float kSkin = 0.1f;     // what is left between an agent and what it would touch
const float kStride = 0.06f;  // a move is up to so many of these:
const int kStrides = 8;

struct Agent {
  vec3 place;
  float clear;  // free distance ahead when it last moved, at most kReach
  uint goal;    // the number of the place that it goes to
};

struct Push {
  vec3 eye;  // looks at the middle of the city
  float aspect;
  uint frame;
  uint agents;  // objects 0, 1, 2, ...
  uint mesh;    // theirs
  float city;   // half its side
};

// Bindings.
const uint kAgents = 0, kAsked = 1, kQueries = 2, kResults = 3, kTransforms = 4, kVertices = 5, kBindings = 6;

#ifdef __cplusplus
static_assert(sizeof(Agent) == 20 && sizeof(Push) == 32);
}  // namespace example
#endif
