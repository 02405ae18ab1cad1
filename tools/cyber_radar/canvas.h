// Draws the program's pictures.
#pragma once

#include <cairo.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace radar::tools {

using Colour = std::array<double, 3>;  ///< red, green, blue in [0, 1]

/// The viridis map (S. van der Walt and N. Smith, 2015): even steps look even, in grey and to colour-blind eyes too.
/// `where` in [0, 1], from dark violet to yellow.
Colour viridis(double where);

/// A white picture; coordinates in pixels from the upper left corner.
class Canvas {
 public:
  Canvas(double width, double height);

  cairo_t* get() const { return cairo_.get(); }
  void colour(const Colour& colour) const;
  void fill(double x, double y, double width, double height) const;
  void outline(double x, double y, double width, double height) const;  ///< around that area, thin and grey
  void text(double x, double baseline, double size, const std::string& words) const;
  uint32_t width() const;
  /// Rows from above, in the form 0xRRGGBB; the highest byte has no meaning.
  std::vector<uint32_t> pixels() const;
  /// As PNG. Throws std::runtime_error if it cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo_;
};

/// The bytes of a PNG file of rows of pixels in the form 0xAARRGGBB, the colours multiplied by the opacity AA.
std::string pngOf(const std::vector<uint32_t>& pixels, uint32_t width);

}  // namespace radar::tools
