#include "cyber_radar/film.h"

#include <stdexcept>
#include <string_view>

#include "batch/atomic_file.h"

namespace radar::tools {

namespace {

constexpr size_t kSignature = 8, kHeader = 25;  // bytes of a PNG file's signature and of its chunk IHDR

std::string bigEndian(uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> 8 * i);
  return text;
}

std::string chunk(const std::string& kind, const std::string& data) {
  const std::string checked = kind + data;
  uint32_t sum = ~0u;  // CRC-32
  for (const char byte : checked) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (0xedb88320u & (0u - (sum & 1)));
  }
  return bigEndian(static_cast<uint32_t>(data.size()), 4) + checked + bigEndian(~sum, 4);
}

uint32_t numberAt(const std::string& png, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(png[at + i]);
  return value;
}

/// What a PNG file's chunks IDAT hold, together.
std::string imageData(const std::string& png) {
  std::string data;
  for (size_t at = kSignature; at + 12 <= png.size();) {
    const size_t bytes = numberAt(png, at);
    if (png.compare(at + 4, 4, "IDAT") == 0) data += png.substr(at + 8, bytes);
    at += 12 + bytes;
  }
  return data;
}

}  // namespace

void Film::add(const Canvas& picture) {
  std::vector<uint32_t> pixels = picture.pixels();
  for (uint32_t& pixel : pixels) pixel |= 0xff000000u;  // opaque
  std::vector<uint32_t> shown = pixels;
  for (size_t i = 0; i < last_.size(); ++i) {
    if (shown[i] == last_[i]) shown[i] = 0;
  }
  pictures_.push_back(pngOf(shown, picture.width()));
  last_ = std::move(pixels);
}

void Film::write(const std::filesystem::path& file, uint16_t milliseconds, uint16_t lastMilliseconds) const {
  if (pictures_.empty()) throw std::runtime_error(file.string() + ": expected a picture at least, got none");
  const std::string& first = pictures_.front();
  const std::string size = first.substr(kSignature + 8, 8);  // width and height
  std::string all = first.substr(0, kSignature + kHeader);
  all += chunk("acTL", bigEndian(static_cast<uint32_t>(pictures_.size()), 4) + bigEndian(0, 4));
  uint32_t number = 0;
  for (size_t i = 0; i < pictures_.size(); ++i) {
    const uint16_t time = i + 1 < pictures_.size() ? milliseconds : lastMilliseconds;
    // At the origin, for time / 1000 seconds; it stays, and covers what is below where it is opaque.
    all += chunk("fcTL", bigEndian(number++, 4) + size + bigEndian(0, 4) + bigEndian(0, 4) + bigEndian(time, 2) +
                             bigEndian(1000, 2) + bigEndian(0, 1) + bigEndian(i == 0 ? 0 : 1, 1));
    const std::string data = imageData(pictures_[i]);
    all += i == 0 ? chunk("IDAT", data) : chunk("fdAT", bigEndian(number++, 4) + data);
  }
  writeAtomically(file, all + chunk("IEND", ""));
}

}  // namespace radar::tools
