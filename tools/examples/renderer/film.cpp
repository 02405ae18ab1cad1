#include "film.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gif_lib.h>
#include <png.h>

#include "radar/error.h"

namespace example {

namespace {

// A fixed palette: levels of brightness, and of two differences of colour, most of which are small in daylight.
constexpr std::array<double, 10> kBrightness{0, 28, 56, 84, 113, 141, 170, 198, 226, 255};
constexpr std::array<double, 5> kDifference{-84, -20, 0, 20, 84};
constexpr uint8_t kUnchanged = 255;  // shows the previous frame's pixel
constexpr int kHundredths = 4;       // of a second that a frame is shown

struct Colour {
  double bright, blue, red;
};

std::vector<GifColorType> makePalette() {
  std::vector<GifColorType> palette(256);
  const auto byte = [](double x) { return static_cast<GifByteType>(std::clamp(std::lround(x), 0l, 255l)); };
  auto* next = palette.data();
  for (const double bright : kBrightness) {
    for (const double blue : kDifference) {
      for (const double red : kDifference)
        *next++ = {byte(bright + 1.402 * red), byte(bright - 0.344 * blue - 0.714 * red), byte(bright + 1.772 * blue)};
    }
  }
  return palette;
}

/// From 0 to 1 in an 8 x 8 pattern, for ordered dithering (Bayer).
double threshold(uint32_t x, uint32_t y) {
  const uint32_t both = x ^ y;
  return ((both & 1) << 5 | (y & 1) << 4 | (both & 2) << 2 | (y & 2) << 1 | (both & 4) >> 1 | (y & 4) >> 2) / 64.0;
}

/// The number of the level below the value, or, in proportion, of the one above.
template <size_t kLevels>
size_t level(const std::array<double, kLevels>& levels, double value, double threshold) {
  const auto above = std::upper_bound(levels.begin() + 1, levels.end() - 1, value);
  const double part = (value - *(above - 1)) / (*above - *(above - 1));
  return static_cast<size_t>(above - levels.begin()) - (part > threshold ? 0 : 1);
}

uint8_t indexOf(const Colour& colour, uint32_t x, uint32_t y) {
  const size_t bright = level(kBrightness, colour.bright, threshold(x, y));
  const size_t blue = level(kDifference, colour.blue, threshold(x + 3, y + 5));
  const size_t red = level(kDifference, colour.red, threshold(y, x + 1));
  return static_cast<uint8_t>((bright * kDifference.size() + blue) * kDifference.size() + red);
}

int write(GifFileType* gif, const GifByteType* bytes, int count) {
  auto& stream = *static_cast<std::ofstream*>(gif->UserData);
  return stream.write(reinterpret_cast<const char*>(bytes), count) ? count : 0;
}

void expect(bool success) {
  if (!success) throw radar::Error("cannot write the film");
}

}  // namespace

PartFile::PartFile(const std::filesystem::path& path)
    : path_(path), part_(path.string() + ".part"), stream_(part_, std::ios::binary) {
  if (!stream_) throw radar::Error("cannot write " + path_.string());
}

PartFile::~PartFile() {
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void PartFile::commit() {
  stream_.close();
  std::error_code error;
  if (stream_) std::filesystem::rename(part_, path_, error);
  if (!stream_ || error) throw radar::Error("cannot write " + path_.string());
}

void writePicture(const std::filesystem::path& path, std::span<const std::byte> pixels, uint32_t width,
                  uint32_t height) {
  std::vector<std::byte> opaque;
  for (size_t i = 0; i < pixels.size(); ++i)
    if (i % 4 != 3) opaque.push_back(pixels[i]);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<char> file(size);
  if (png_image_write_to_memory(&image, file.data(), &size, 0, opaque.data(), 0, nullptr) == 0)
    throw radar::Error("cannot write " + path.string() + ": " + image.message);
  PartFile part(path);
  part.stream().write(file.data(), static_cast<std::streamsize>(size));
  part.commit();
}

void Film::Close::operator()(GifFileType* gif) const {
  EGifCloseFile(gif, nullptr);
}

Film::Film(const std::filesystem::path& path, uint32_t width, uint32_t height)
    : file_(path), stride_(width), width_(width / 2), height_(height / 2) {
  int error = 0;
  gif_.reset(EGifOpen(&file_.stream(), write, &error));
  expect(gif_ != nullptr);
  ColorMapObject* map = GifMakeMapObject(256, makePalette().data());
  EGifSetGifVersion(gif_.get(), true);
  const int begun = EGifPutScreenDesc(gif_.get(), static_cast<int>(width_), static_cast<int>(height_), 8, 0, map);
  GifFreeMapObject(map);
  const uint8_t forEver[] = {1, 0, 0};
  expect(begun == GIF_OK && EGifPutExtensionLeader(gif_.get(), APPLICATION_EXT_FUNC_CODE) == GIF_OK &&
         EGifPutExtensionBlock(gif_.get(), 11, "NETSCAPE2.0") == GIF_OK &&
         EGifPutExtensionBlock(gif_.get(), sizeof(forEver), forEver) == GIF_OK &&
         EGifPutExtensionTrailer(gif_.get()) == GIF_OK);
}

void Film::add(std::span<const std::byte> pixels) {
  std::vector<uint8_t> frame, changes;
  for (uint32_t i = 0; i < width_ * height_; ++i) {
    const uint32_t x = i % width_, y = i / width_;
    const auto mean = [&](size_t channel) {  // of four pixels
      double sum = 0;
      for (size_t k = 0; k < 4; ++k)
        sum += std::to_integer<int>(pixels[4 * ((2 * y + k / 2) * size_t{stride_} + 2 * x + k % 2) + channel]);
      return sum / 4;
    };
    const double red = mean(0), blue = mean(2), bright = 0.299 * red + 0.587 * mean(1) + 0.114 * blue;
    const uint8_t index = indexOf({bright, 0.564 * (blue - bright), 0.713 * (red - bright)}, x, y);
    frame.push_back(index);
    changes.push_back(!last_.empty() && last_[i] == index ? kUnchanged : index);
  }
  last_ = std::move(frame);
  const uint8_t control[] = {1 << 2 | 1, kHundredths, 0, kUnchanged};  // leaves the previous frame below this one
  const auto width = static_cast<int>(width_), height = static_cast<int>(height_);
  expect(EGifPutExtension(gif_.get(), GRAPHICS_EXT_FUNC_CODE, sizeof(control), control) == GIF_OK &&
         EGifPutImageDesc(gif_.get(), 0, 0, width, height, false, nullptr) == GIF_OK);
  for (uint32_t y = 0; y < height_; ++y) expect(EGifPutLine(gif_.get(), &changes[size_t{y} * width_], width) == GIF_OK);
}

void Film::close() {
  expect(EGifCloseFile(gif_.release(), nullptr) == GIF_OK);
  file_.commit();
}

}  // namespace example
