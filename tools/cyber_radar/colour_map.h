#pragma once

#include <array>

namespace radar::tools {

using Colour = std::array<double, 3>;  ///< red, green, blue in [0, 1]

/// The viridis map (S. van der Walt and N. Smith, 2015): even steps look even, in grey and to colour-blind eyes too.
/// `where` in [0, 1], from dark violet to yellow.
Colour viridis(double where);

}  // namespace radar::tools
