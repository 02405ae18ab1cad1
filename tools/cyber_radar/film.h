// Pictures that follow each other in one PNG file, which browsers play.
#pragma once

#include <vector>

#include "cyber_radar/canvas.h"

namespace radar::tools {

class Film {
 public:
  /// Appends a picture. All have one size.
  void add(const Canvas& picture);
  /// Each picture is shown for so long, the last one for longer. Throws std::runtime_error if it cannot be written.
  void write(const std::filesystem::path& file, uint16_t milliseconds, uint16_t lastMilliseconds) const;

 private:
  std::vector<uint32_t> last_;         // pixels of the picture added last
  std::vector<std::string> pictures_;  // PNG files; transparent where the picture before is to stay
};

}  // namespace radar::tools
