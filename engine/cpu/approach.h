// When two triangles, one of them in motion, come within a given distance of each other: certified bounds in doubles.
#pragma once

#include <optional>

#include "exact/contact.h"
#include "exact/translation.h"

namespace radar::cpu {

/// Where two triangles are nearest to each other.
struct Separation {
  double distance;           ///< world units; off by rounding, but exactly 0 if they touch
  Vector point;              ///< of the resting triangle, nearest to the moving one; a corner is given exactly
  Vector normal;             ///< unit, towards the moving one; NaN if they touch, as far as doubles tell
  exact::Features features;  ///< on which the nearest points are
};
Separation separationOf(const exact::Triangle& a, const exact::Triangle& b);

/// Whether they certainly are within the clearance once a has moved by `displacement`.
bool certainlyWithin(const exact::Triangle& a, const exact::Triangle& b, const Vector& displacement, double clearance);

/// Whether their extents along `normal`, of length 1 to 2, certainly keep them farther apart than the clearance until
/// a has moved by `displacement`.
bool stayApart(const exact::Triangle& a, const exact::Triangle& b, const Vector& normal, const Vector& displacement,
               double clearance);

/// Whether the triangles certainly are farther apart than `slack` at the start, and triangle a, in motion along `unit`,
/// never comes nearer by more than that, because all of it is ahead of b or level with it. Quick.
bool staysLevel(const exact::Triangle& a, const exact::Triangle& b, const Vector& unit, double slack);

struct Approach {
  double lo;        ///< world units: the triangles are farther apart before this
  double hi;        ///< they certainly are within the distance by this; infinite if rounding leaves it open
  Separation atLo;  ///< if `hi` is known
};

/// After how much of its motion, world units, triangle a comes within `clearance` > 0 of b; none if it certainly does
/// not, or, it may be, not before t = `latest`: then `across` is set along their gap at some time. hi - lo is at most
/// `tolerance`, if rounding allows.
std::optional<Approach> approach(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion,
                                 double clearance, double tolerance, double latest, Vector* across = nullptr);

/// The last of its motion, world units, at which triangle a is within `clearance` > 0 of b: from `lo`, -infinity if
/// rounding leaves it open whether it ever is, to `hi`; both are the end if they are within it there. None if it
/// certainly never is. `atLo`: if `lo` is known, about then.
std::optional<Approach> leaving(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion,
                                double clearance, double tolerance);

/// How near two triangles come to each other.
struct Passage {
  double lo, hi;  ///< world units: their least distance is in there
  double way;     ///< of the motion, world units, where it is at most `hi`
  Separation at;  ///< there
};
/// On the whole motion of triangle a past b; none if they certainly do not come nearer than `reach`.
std::optional<Passage> passage(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion,
                               double reach);

/// How exact::blocksWithin decides, as far as double-doubles tell.
enum class Nearing {
  yes,      ///< the triangles block
  no,       ///< they do not
  pressed,  ///< they are no farther apart than `slack` at the start: what exact::blocks says
  open
};
Nearing nearingOf(const exact::Triangle& a, const exact::Triangle& b, const Vector& direction, double clearance,
                  double slack);

}  // namespace radar::cpu
