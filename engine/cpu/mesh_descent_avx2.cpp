// The search of two meshes' trees once more, with eight lanes, for processors that have AVX2. This file is compiled for
// AVX2 as a whole, as functions that hand vectors to each other must be. Not without optimisation: then inline
// functions that other files share would be, too.
#include "cpu/mesh_descent.h"

#if defined(__AVX2__) && defined(__OPTIMIZE__)

#define RADAR_LANES 8
#define RADAR_WIDTH lanes8_avx2
#define RADAR_DESCENT avx2Descent
#define RADAR_INSTRUCTIONS "AVX2"

#include "cpu/leaf_test.cpp"
#include "cpu/mesh_descent.cpp"
#include "cpu/node_test.cpp"
#include "cpu/path_test.cpp"

#else

const radar::cpu::MeshDescent* radar::cpu::avx2Descent() {
  return nullptr;
}

#endif
