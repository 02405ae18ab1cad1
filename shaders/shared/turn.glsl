// Moves values to each other's places: a loop that indexed an array would keep it in memory.
#ifndef RADAR_TURN_GLSL
#define RADAR_TURN_GLSL

// The next becomes the first.
#define RADAR_CYCLE(Type)                           \
  void cycle(inout Type p, inout Type q, inout Type r) { \
    const Type first = p;                           \
    p = q;                                          \
    q = r;                                          \
    r = first;                                      \
  }
#define RADAR_EXCHANGE(Type)                \
  void exchange(inout Type p, inout Type q) { \
    const Type first = p;                   \
    p = q;                                  \
    q = first;                              \
  }

RADAR_CYCLE(vec3)
#ifndef RADAR_NO_DOUBLES
RADAR_CYCLE(dvec3)
#endif

#endif
