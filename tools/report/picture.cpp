#include "report/picture.h"

#include <cairo.h>
#include <librsvg/rsvg.h>

#include <memory>
#include <stdexcept>

#include "batch/whole_file.h"
#include "report/colours.h"

namespace radar::tools {

namespace {

constexpr double kWidth = 1240;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem) {
  throw std::runtime_error(file.string() + ": cannot be drawn: " + problem);
}

void writePng(const std::filesystem::path& file, const std::string& svg) {
  GError* error = nullptr;
  const std::unique_ptr<RsvgHandle, void (*)(void*)> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error), g_object_unref);
  if (!handle) {
    const std::string problem = error->message;
    g_error_free(error);
    fail(file, problem);
  }
  RsvgRectangle box{};
  rsvg_handle_get_intrinsic_dimensions(handle.get(), nullptr, nullptr, nullptr, nullptr, nullptr, &box);
  const double height = kWidth * box.height / box.width;
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(kWidth), static_cast<int>(height)),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, void (*)(cairo_t*)> canvas(cairo_create(surface.get()), cairo_destroy);
  const RsvgRectangle whole{0, 0, kWidth, height};
  if (!rsvg_handle_render_document(handle.get(), canvas.get(), &whole, &error)) {
    const std::string problem = error->message;
    g_error_free(error);
    fail(file, problem);
  }
  const cairo_status_t status = cairo_surface_write_to_png(surface.get(), file.c_str());
  if (status != CAIRO_STATUS_SUCCESS) fail(file, cairo_status_to_string(status));
}

}  // namespace

std::string standalone(const std::string& svg) {
  const size_t start = svg.find("<svg ") + 5, inside = svg.find('>', start) + 1;
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + svg.substr(start, inside - start) + "<style>" +
         standaloneRules() + "</style><rect width=\"100%\" height=\"100%\" class=\"paper\"/>\n" + svg.substr(inside);
}

void writePicture(const std::filesystem::path& folder, const std::string& name, const std::string& svg) {
  const std::string whole = standalone(svg);
  writeWhole(folder / (name + ".svg"), whole);
  writePng(folder / (name + ".png"), whole);
}

}  // namespace radar::tools
