#include "cyber_radar/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "batch/atomic_file.h"

namespace radar::tools {

namespace {

std::string encoded(cairo_surface_t* surface, const std::string& name) {
  std::string png;
  const auto append = [](void* to, const unsigned char* bytes, unsigned count) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  };
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface, append, &png);
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(name + ": expected a picture, got " + cairo_status_to_string(status));
  }
  return png;
}

}  // namespace

Colour viridis(double where) {
  constexpr int kSteps = 8;
  constexpr double kColours[kSteps + 1][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                              {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                              {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
  const double position = std::clamp(where, 0.0, 1.0) * kSteps;
  const int step = std::min(static_cast<int>(position), kSteps - 1);
  const double rest = position - step;
  Colour colour;
  for (int k = 0; k < 3; ++k) {
    colour[k] = (kColours[step][k] + rest * (kColours[step + 1][k] - kColours[step][k])) / 255;
  }
  return colour;
}

Canvas::Canvas(double width, double height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(std::ceil(width)), int(std::ceil(height))),
               cairo_surface_destroy),
      cairo_(cairo_create(surface_.get()), cairo_destroy) {
  colour({1, 1, 1});
  cairo_paint(get());
  cairo_select_font_face(get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

void Canvas::colour(const Colour& colour) const {
  cairo_set_source_rgb(get(), colour[0], colour[1], colour[2]);
}

void Canvas::fill(double x, double y, double width, double height) const {
  cairo_rectangle(get(), x, y, width, height);
  cairo_fill(get());
}

void Canvas::outline(double x, double y, double width, double height) const {
  colour({0.3, 0.3, 0.3});
  cairo_set_line_width(get(), 1);
  cairo_rectangle(get(), x - 0.5, y - 0.5, width + 1, height + 1);
  cairo_stroke(get());
}

void Canvas::text(double x, double baseline, double size, const std::string& words) const {
  colour({0.1, 0.1, 0.1});
  cairo_set_font_size(get(), size);
  cairo_move_to(get(), x, baseline);
  cairo_show_text(get(), words.c_str());
}

uint32_t Canvas::width() const {
  return static_cast<uint32_t>(cairo_image_surface_get_width(surface_.get()));
}

std::vector<uint32_t> Canvas::pixels() const {
  cairo_surface_flush(surface_.get());
  const unsigned char* data = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  std::vector<uint32_t> pixels(size_t{width()} * cairo_image_surface_get_height(surface_.get()));
  for (size_t row = 0; row * width() < pixels.size(); ++row) {
    std::memcpy(&pixels[row * width()], data + row * stride, sizeof(uint32_t) * width());
  }
  return pixels;
}

void Canvas::write(const std::filesystem::path& file) const {
  writeAtomically(file, encoded(surface_.get(), file.string()));
}

std::string pngOf(const std::vector<uint32_t>& pixels, uint32_t width) {
  const auto columns = static_cast<int>(width), rows = static_cast<int>(pixels.size() / width);
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, columns, rows), cairo_surface_destroy);
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int row = 0; row < rows; ++row) {
    std::memcpy(data + ptrdiff_t{row} * stride, &pixels[size_t{width} * row], sizeof(uint32_t) * width);
  }
  cairo_surface_mark_dirty(surface.get());
  return encoded(surface.get(), "a picture of a film");
}

}  // namespace radar::tools
