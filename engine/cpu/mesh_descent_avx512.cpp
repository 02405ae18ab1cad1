// As mesh_descent_avx2.cpp, for processors that have AVX-512 for short vectors: it has 32 registers, and masks. Sixteen
// lanes were slower, since more of the pairs of nodes that they test do not matter.
#include "cpu/mesh_descent.h"

#if defined(__AVX512VL__) && defined(__OPTIMIZE__)

#define RADAR_LANES 8
#define RADAR_WIDTH lanes8_avx512
#define RADAR_DESCENT avx512Descent
#define RADAR_INSTRUCTIONS "AVX-512"

#include "cpu/leaf_test.cpp"
#include "cpu/mesh_descent.cpp"
#include "cpu/node_test.cpp"
#include "cpu/path_test.cpp"

#else

const radar::cpu::MeshDescent* radar::cpu::avx512Descent() {
  return nullptr;
}

#endif
