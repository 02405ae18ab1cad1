// The gnuplot scripts of this folder, as text. Their first lines name their arguments.
#pragma once

namespace radar::tools {

extern const char *const kStyleScript, *const kFrontScript, *const kTimesScript, *const kScaleScript;

}  // namespace radar::tools
