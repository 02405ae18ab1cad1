// The search of two meshes' trees once more, with eight lanes, for processors that have AVX2. What is included before
// the target is set is the same at every width, and keeps to the instructions that every processor has.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "cpu/certificate.h"
#include "cpu/mesh_descent.h"
#include "cpu/node_gap.h"
#include "cpu/pair_motion.h"
#include "cpu/path_part.h"

#ifdef __x86_64__

#define RADAR_LANES 8
#define RADAR_WIDTH lanes8

#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

#include "cpu/leaf_test.cpp"
#include "cpu/mesh_descent.cpp"
#include "cpu/node_test.cpp"
#include "cpu/path_test.cpp"

#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif
