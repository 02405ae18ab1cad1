#include "batch/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "import/input_error.h"
#include "import/regular_file.h"

namespace radar::tools {

MappedFile::MappedFile(const std::filesystem::path& file, const char* kind) {
  requireRegular(file, kind);
  const auto refuse = [&] {
    throw InputError(file.string(), "", std::string("expected ") + kind + ", got " + std::strerror(errno));
  };
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) refuse();
  struct stat status {};
  if (fstat(descriptor, &status) != 0) {
    close(descriptor);
    refuse();
  }
  const auto size = static_cast<size_t>(status.st_size);
  void* const data = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
  close(descriptor);
  if (data == MAP_FAILED) refuse();
  bytes_ = {static_cast<const char*>(data), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

}  // namespace radar::tools
