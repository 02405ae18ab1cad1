// How right answers are, against the exact ones.
#pragma once

#include <span>

#include "chart/cell.h"
#include "radar/radar.h"

namespace radar::tools {

/// What a method says of one query.
struct Told {
  enum class Kind {
    contact,  ///< at t
    none,     ///< not within D
    unseen    ///< nothing was seen, and nothing is promised
  };
  Kind kind = Kind::none;
  double t = NAN, lo = NAN, hi = NAN;  ///< bounds that it vouches for; NaN: it does not
};

/// The engine's word.
Told toldBy(const Result& result);

/// Fills the accuracy columns of a cell whose `certified` is set, but for the shares by tier. `truth` is the
/// reference's.
void judge(Cell& cell, std::span<const Told> told, std::span<const Result> truth, std::span<const double> sizes);

/// Fills the shares by tier.
void countTiers(Cell& cell, std::span<const Result> results);

}  // namespace radar::tools
