// How right answers are, against the exact ones.
#pragma once

#include <span>

#include "chart/cell.h"
#include "stability/judge.h"

namespace radar::tools {

/// Fills the accuracy columns of a cell whose `certified` is set, but for the shares by tier. `truth` is the
/// reference's.
void judge(Cell& cell, std::span<const Claim> claims, std::span<const Result> truth, std::span<const double> sizes);

/// Fills the shares by tier.
void countTiers(Cell& cell, std::span<const Result> results);

}  // namespace radar::tools
