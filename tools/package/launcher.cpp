// bin/PROGRAM of an archive. It runs lib/PROGRAM with those libraries of the machine that are new enough, and with
// the archive's copies of the others. It is linked statically, since it chooses the C library.
//
// A Vulkan driver is loaded into the same process and needs the libraries of its machine, or newer ones. A machine's
// copy that is too old for the program is older than the archive's, so the driver works with the archive's.

#include <elf.h>
#include <sys/auxv.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

constexpr const char* kMachineFolders[] = {
    "/lib/x86_64-linux-gnu", "/usr/lib/x86_64-linux-gnu", "/lib64", "/usr/lib64", "/lib", "/usr/lib"};
constexpr const char* kLinker = "ld-linux-x86-64.so.2";  // at /lib64 by the ABI
constexpr const char* kLibc = "libc.so.6";

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "cyber-radar: %s\n", message.c_str());
  std::exit(2);
}

/// The bytes of the machine's copy of a library, empty where it has none. /lib may hold those of another processor.
std::string machinesCopy(const std::string& library) {
  for (const fs::path folder : kMachineFolders) {
    std::ifstream stream(folder / library, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    Elf64_Ehdr header;
    if (bytes.size() < sizeof header) continue;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0 && header.e_machine == EM_X86_64) return bytes;
  }
  return {};
}

/// Which folders in `ours` the machine's own libraries can replace. Each line of the file `needed` there is a folder, a
/// library, and a name that the machine's copy of it has to contain: of a version, or of a function.
std::map<std::string, bool> replaceable(const fs::path& ours) {
  std::ifstream stream(ours / "needed");
  std::map<std::string, bool> folders;
  std::map<std::string, std::string> copies;
  std::string folder, library, name;
  while (stream >> folder >> library >> name) {
    if (!copies.contains(library)) copies[library] = machinesCopy(library);
    const bool found = copies[library].find('\0' + name + '\0') != std::string::npos;
    bool& all = folders.try_emplace(folder, true).first->second;
    all = all && found;
  }
  if (folders.empty()) fail(ours.string() + "/needed: cannot be read; the archive is not whole");
  return folders;
}

/// This program's file, through symbolic links. /proc may not be there.
fs::path ownFile() {
  const char* const started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));  // NOLINT: given as a number
  std::error_code error;
  fs::path file = fs::canonical(started, error);
  if (error) fail(std::string(started) + ": " + error.message());
  const fs::path folder = file.parent_path().parent_path();
  if (folder.string().find_first_of(":;") != std::string::npos) {
    fail(folder.string() +
         ": the dynamic linker cannot find libraries in a folder with a colon or semicolon in its name");
  }
  return file;
}

}  // namespace

int main(int, char** argv) {
  const fs::path own = ownFile(), lib = own.parent_path().parent_path() / "lib", ours = lib / "replaceable";
  fs::path linker = fs::path("/lib64") / kLinker;
  std::string search = lib;
  for (const auto& [library, replaced] : replaceable(ours)) {
    if (replaced) continue;
    search += ":" + (ours / library).string();
    if (library == kLibc) linker = ours / library / kLinker;
  }
  if (const char* given = std::getenv("LD_LIBRARY_PATH"); given != nullptr && *given != '\0') {
    search += ":" + std::string(given);
  }
  search += ":/lib64:/usr/lib64";  // the archive's linker, which is Debian's, does not look there by itself

  const fs::path program = lib / own.filename();
  std::vector<const char*> arguments{linker.c_str(), "--library-path", search.c_str(),
                                     "--argv0",      argv[0],          program.c_str()};
  for (char** argument = argv + 1; *argument != nullptr; ++argument) arguments.push_back(*argument);
  arguments.push_back(nullptr);
  execv(linker.c_str(), const_cast<char**>(arguments.data()));
  fail(linker.string() + ": " + std::strerror(errno));
}
