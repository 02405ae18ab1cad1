// What the program's pictures are drawn with.
#pragma once

#include <cairo.h>

#include <filesystem>
#include <memory>
#include <string>

#include "cyber_radar/colour_map.h"

namespace radar::tools {

/// A white picture; coordinates in pixels from the upper left corner.
class Canvas {
 public:
  Canvas(double width, double height);

  cairo_t* get() const { return cairo_.get(); }
  void colour(const Colour& colour) const;
  void fill(double x, double y, double width, double height) const;
  void outline(double x, double y, double width, double height) const;  ///< around that area, thin and grey
  void text(double x, double baseline, double size, const std::string& words) const;
  /// As PNG. Throws std::runtime_error if it cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo_;
};

}  // namespace radar::tools
