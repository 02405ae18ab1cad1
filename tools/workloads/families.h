// Families of small scenes, each a way in which collision queries are known to be hard. Equal arguments give equal bits
// on every platform.
#pragma once

#include <array>
#include <cstdint>

#include "workloads/workload.h"

namespace radar::tools {

enum class Family {
  convex,        ///< boxes, balls, rods and plates
  nonConvex,     ///< teapots, rings, hooks, combs and cups
  interlocking,  ///< ring on peg, ring through ring, hook behind bar, ball in cup, comb in comb, ball inside teapot,
                 ///< key in keyhole; either as the sensor, turned a little
  open,          ///< sheets, cylinders without ends, single triangles
  crossing,      ///< meshes that pierce themselves, and meshes that hold triangles twice
  soup,          ///< every kind of Soup, near the origin or 10^1 to 10^7 units from it
  lattice,    ///< boxes and triangles with whole corners along whole directions: ties, touching, contact at exactly D
  touching,   ///< the same turned and scaled alike, some poses off by roundings: gaps and overlaps of one ulp
  farPosed,   ///< shapes of every kind, 10^1 to 10^7 units from the origin by their poses
  farBaked,   ///< the same by their vertices, placed there or back at the origin
  scales,     ///< shapes of every kind at 10^-4 to 10^4
  floor,      ///< a floor of 10^4 beside sensors of 10^-2
  directions  ///< aligned shapes along an axis, and 10^-2 to 10^-12 off it; directions of length 10^-12 to 10^12
};
inline constexpr std::array kFamilies{Family::convex,    Family::nonConvex, Family::interlocking, Family::open,
                                      Family::crossing,  Family::soup,      Family::lattice,      Family::touching,
                                      Family::farPosed,  Family::farBaked,  Family::scales,       Family::floor,
                                      Family::directions};
const char* nameOf(Family family);

/// One scene of a family, with one batch of queries.
struct FamilyScene {
  Family family = Family::convex;
  uint32_t queries = 64;
  uint64_t seed = 1;
};
Workload makeWorkload(const FamilyScene& options);

}  // namespace radar::tools
