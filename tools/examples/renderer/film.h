// Pictures as PNG, and a film as an animated GIF. A file appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct GifFileType;

namespace example {

/// A file that is written under another name until commit(), without which it is removed. Both throw radar::Error
/// naming it.
class PartFile {
 public:
  explicit PartFile(const std::filesystem::path& path);
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile();
  std::ofstream& stream() { return stream_; }
  void commit();

 private:
  std::filesystem::path path_, part_;
  std::ofstream stream_;
};

/// `pixels`: RGBA, 4 bytes each, by rows from the top. Throws radar::Error naming the file.
void writePicture(const std::filesystem::path& path, std::span<const std::byte> pixels, uint32_t width,
                  uint32_t height);

class Film {
 public:
  /// Of pictures of this size, shown at half of it. Throws radar::Error, as all below.
  Film(const std::filesystem::path& path, uint32_t width, uint32_t height);
  void add(std::span<const std::byte> pixels);
  /// Completes the file.
  void close();

 private:
  struct Close {
    void operator()(GifFileType* gif) const;
  };
  PartFile file_;
  uint32_t stride_, width_, height_;
  std::unique_ptr<GifFileType, Close> gif_;
  std::vector<uint8_t> last_;
};

}  // namespace example
