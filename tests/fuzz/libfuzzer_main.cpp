// A target as a program of libFuzzer. `PROGRAM --write-seeds FOLDER` writes its seeds, and its words as the dictionary
// FOLDER.dict, and ends.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "fuzz/target.h"

namespace {

void writeSeeds(const std::filesystem::path& folder) {
  const radar::fuzz::Target& target = radar::fuzz::target();
  std::filesystem::create_directories(folder);
  size_t number = 0;
  for (const std::string& seed : target.seeds()) {
    std::ofstream(folder / ("seed-" + std::to_string(number++)), std::ios::binary) << seed;
  }
  std::ofstream dictionary(folder.string() + ".dict");
  for (const std::string& word : target.words) {
    dictionary << '"';
    for (const char c : word) {
      const auto byte = static_cast<uint8_t>(c);
      constexpr char kDigits[] = "0123456789abcdef";
      dictionary << "\\x" << kDigits[byte >> 4] << kDigits[byte & 15];
    }
    dictionary << "\"\n";
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (*argc != 3 || std::string_view((*argv)[1]) != "--write-seeds") return 0;
  writeSeeds((*argv)[2]);
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  radar::fuzz::target().run({reinterpret_cast<const char*>(data), size});
  return 0;
}
