#include "import/regular_file.h"

#include <fstream>

#include "import/input_error.h"

namespace radar::tools {

namespace {

const char* inWords(std::filesystem::file_type type) {
  switch (type) {
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::not_found:
      return "no such file";
    case std::filesystem::file_type::fifo:
      return "a pipe";
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return "a device";
    default:
      return "no readable file";
  }
}

}  // namespace

void requireRegular(const std::filesystem::path& file, const char* kind) {
  std::error_code error;
  const std::filesystem::file_type type = std::filesystem::status(file, error).type();
  if (type == std::filesystem::file_type::regular) return;
  throw InputError(file.string(), "", std::string("expected ") + kind + ", got " + inWords(type));
}

std::string readRegularFile(const std::filesystem::path& file, const char* kind) {
  requireRegular(file, kind);
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (!stream || error) throw InputError(file.string(), "", std::string("expected ") + kind + ", got no readable file");
  std::string content(size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(size));
  content.resize(static_cast<size_t>(stream.gcount()));
  return content;
}

}  // namespace radar::tools
