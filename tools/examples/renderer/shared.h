// What C++ and the shaders share, in scalar layout. Lengths are metres; z is up.
#ifndef EXAMPLE_SHARED_H
#define EXAMPLE_SHARED_H

#ifdef __cplusplus
#include <array>
#include <cstdint>

namespace example {

using vec3 = std::array<float, 3>;
using vec4 = std::array<float, 4>;
using mat4 = std::array<float, 16>;
using uint = uint32_t;
#endif

// Places and strides are multiples of 1/kGrid, rotations of 1/kGrid, vertices of 1/kVertexGrid. Sums and products of
// such numbers are exact: an agent that has moved stands exactly where its query said that it would, not a rounding
// beside.
const float kGrid = 4096.0f;
const float kVertexGrid = 1024.0f;
const float kPitch = 18.0f;  // from building to building
const float kReach = 12.0f;  // how far agents look ahead
const float kClose = 4.0f;   // agents turn away from what is closer ahead
const float kSkin = 0.1f;    // what is left between an agent and what it would touch
const int kTurn = 1024;      // headings of a full turn
const int kCycle = 48;       // phases of a walk
const int kStrides = 4;      // a move is up to this many strides
const uint kBuckets = 1u << 15;
const float kCell = 5.5f;  // side of the cells in which claims are found, at least the widest claim

struct Agent {
  vec3 place;
  float clear;   // free distance ahead, at most kReach
  vec3 from;     // the point of the agent that will touch something,
  float speed;   // metres a frame
  vec3 contact;  // where it will, if `clear` is below kReach,
  float radius;  // of a sphere around `place` that contains the agent in any pose
  vec3 normal;   // and the surface's normal there
  int heading;
  uint body;    // its object's mesh
  uint sensor;  // the mesh with which it asks for room: the same, or a walker's in the next phase of its walk
  int phase;
  uint advanced;  // the last frame in which it took the pose of the next phase
  uint stuck;     // frames in which it will not turn, since there was no room
  int side;       // to which it turns while something is close ahead
  uint goal;      // the number of the place that it goes to
};

// What an agent would like to do in this frame, and the sphere in which it does so.
struct Claim {
  vec3 centre;
  float radius;
  vec3 stride;
  int heading;
  uint keeps;     // 1: it neither turns nor walks on, but only moves
  uint priority;  // the least of those that overlap goes
  uint link;      // the next claim in the same bucket
};

const uint kWalker = 0, kDrone = 1, kBuilding = 2, kTerrain = 3;

struct Push {
  mat4 clipFromWorld;
  vec3 eye;
  uint frame;  // the last one in which agents move, counted from 1
  uint agents;
  uint walkers;  // the first ones of the agents
  uint walkerVertices;
  uint kind;   // of what is drawn
  float city;  // half its side
};

// Bindings.
const uint kAgents = 0, kClaims = 1, kGridCells = 2, kQueries = 3, kResults = 4, kTransforms = 5, kVertices = 6,
           kSkinned = 7, kBindings = 8;

#ifdef __cplusplus
static_assert(sizeof(Agent) == 92 && sizeof(Claim) == 44 && sizeof(Push) == 100);
}  // namespace example
#endif

#endif
