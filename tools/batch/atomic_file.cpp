#include "batch/atomic_file.h"

#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace radar::tools {

void writeAtomically(const std::filesystem::path& file, std::string_view content) {
  std::filesystem::path unfinished = file;
  unfinished += ".unfinished-" + std::to_string(getpid());
  std::error_code error;
  std::ofstream stream(unfinished, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (stream) std::filesystem::rename(unfinished, file, error);
  if (!stream || error) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw std::runtime_error(file.string() + ": expected a place to write to, got " +
                             (error ? error.message() : "an error while writing"));
  }
}

}  // namespace radar::tools
