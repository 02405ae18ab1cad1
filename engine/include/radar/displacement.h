// Ways as displacements, instead of a direction and a distance, and turns as poses, instead of an axis and an angle.
#pragma once

#include <array>

#include "radar/answers.h"
#include "radar/query.h"

namespace radar {

/// Lets the sensor go `way`, world units: contact at its very end counts, and none beyond. For a batch of that mode;
/// `objectsMove`: an object of the scene has a motion. Set the clearance before. Lengths round, so the query becomes a
/// step, whose end is exact, with these exceptions: along an axis it is a sweep, whose distance is exact, too; in mode
/// sampled, which has no steps, and with a clearance where no object moves, which devices answer in sweeps alone, it is
/// a sweep over the length rounded up, by at most a part in 2^49. What validate() refuses of a way it refuses still.
RADAR_API void setDisplacement(Query& query, const std::array<double, 3>& way, Mode mode, bool objectsMove);

/// The way of a valid query's sensor, world units: its motion, exactly, or D along its direction, where each component
/// is off by at most 2^-49 of itself plus 2^-1074 D.
RADAR_API std::array<double, 3> displacementOf(const Query& query);

/// What Query::turn and Query::motion say together.
struct TurnAndMotion {
  Turn turn;
  std::array<double, 3> motion{};
};

/// The motion of a body from one pose to another by which its point `about`, in the coordinates of its mesh, goes
/// straight, and the body turns by less than half a turn. It ends at `end`, to rounding. Equal linear parts give an
/// angle of 0.
///
/// Throws if a pose is no Transform that a query may have, or `about` is not finite or placed beyond 2^800; if what
/// turns the start into the end is no rotation but scales, shears or mirrors, by more than 2^-20 of lengths; and if it
/// is half a turn to within that deviation and rounding, which may go either way: state its axis and angle.
RADAR_API TurnAndMotion turnBetween(const Transform& start, const Transform& end, const std::array<double, 3>& about);

/// Makes t, lo and hi of an answer to this query distances along its sensor's way, world units: of a query with a
/// motion they are fractions of the step before, and of others distances already; with a turn they stay fractions. The
/// bracket stays certified: lo is rounded down and hi up, by at most a part in 2^49; t stays lo where it was, with hi
/// above.
RADAR_API void toDistances(const Query& query, Result& result);

}  // namespace radar
