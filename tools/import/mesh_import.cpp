#include "import/mesh_import.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cfenv>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <set>
#include <sstream>

#include "child/in_child.h"
#include "import/faces.h"
#include "import/gltf_document.h"
#include "import/readers.h"
#include "import/regular_file.h"
#include "workloads/vectors.h"

namespace radar::tools {

namespace {

/// Numbers are read as the nearest floats whatever the caller's floating-point environment, which is restored at the
/// end.
class DefaultFloats {
 public:
  DefaultFloats() {
    std::fegetenv(&caller_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloats() { std::fesetenv(&caller_); }
  DefaultFloats(const DefaultFloats&) = delete;
  DefaultFloats& operator=(const DefaultFloats&) = delete;

 private:
  std::fenv_t caller_;
};

/// Own readers number vertices with 32 bits; none stores more than one in 2 bytes.
constexpr uint64_t kMostBytes = uint64_t(1) << 33;

/// Of a mesh that nodes place several times, vertices and triangles.
constexpr uint64_t kMostCopied = uint64_t(1) << 27;

constexpr unsigned kMostSeconds = 600;  // of assimp

std::string placeOf(const MeshFile::Node& node) {
  return "node \"" + node.name + "\"";
}

// Assimp crashes on some broken files, and is led to take any amount of memory by others.
MeshFile readInChild(const std::filesystem::path& file) {
  const auto work = [&] {
    try {
      return bytesOf(readWithAssimp(file));
    } catch (const std::bad_alloc&) {
      throw InputError(file.string(), "", "expected a mesh file, got one that takes half of this machine's memory");
    }
  };
  const auto memory = static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
  const ChildOutcome outcome = inChild(work, {.seconds = kMostSeconds, .bytes = memory / 2});
  if (outcome.threw) throw InputError(outcome.failed);
  if (outcome.failed.empty()) return meshFileFrom(outcome.bytes);
  throw InputError(file.string(), "", "expected a mesh file that assimp reads, but it " + outcome.failed);
}

/// OBJ and OFF files are text, PLY files begin with it. UTF-16 and UTF-32 have zeros between letters.
void requireUtf8(const std::string& file, const std::string& extension, std::string_view text) {
  const std::string_view head = text.substr(0, 4);
  const bool hasMark = head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff");
  if (extension == ".3mf") return;
  if (extension != ".stl" ? hasMark || head.find('\0') != head.npos
                          : hasMark && text.substr(0, 16).find('\0') != text.npos) {
    throw InputError(file, "", "expected text in ASCII or UTF-8, got UTF-16, UTF-32 or none: save it as UTF-8");
  }
}

MeshFile readFile(const std::filesystem::path& file) {
  using Reader = MeshFile (*)(Text);
  static const std::map<std::string, Reader> kReaders{{".obj", readObj}, {".stl", readStl},     {".ply", readPly},
                                                      {".off", readOff}, {".3mf", readThreeMf}, {".gltf", readGltf},
                                                      {".glb", readGltf}};
  const std::string name = file.string();
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  requireRegular(file, "a mesh file");
  const auto reader = kReaders.find(extension);
  if (reader == kReaders.end()) return readInChild(file);
  if (std::filesystem::file_size(file) > kMostBytes) throw InputError(name, "", "expected at most 8 GiB, got more");
  const std::string content = readRegularFile(file, "a mesh file");
  if (content.empty()) throw InputError(name, "", "expected a mesh file, got an empty one");
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::string_view text = content;
  requireUtf8(name, extension, text);
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (reader->second == readGltf && isGltf1(text)) return readInChild(file);
  return reader->second({name, text});
}

/// What stands in the file, with its faces split.
MeshFile openFile(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  MeshFile file = readFile(path);
  OddFaces odd;
  for (MeshFile::Part& part : file.parts) splitFaces(path.string(), part, odd);
  const std::string name = printable(path.string());
  if (file.isOddUnit) {
    warnings.push_back(name + ": its unit is " + printable(file.unit, 40) +
                       ", not millimeter as usual: its numbers stay as they are");
  }
  if (odd.bent > 0) {
    std::ostringstream most;
    most << odd.most;
    warnings.push_back(name + ": the corners of " + counted(odd.bent, "face") + " do not lie in a plane, by up to " +
                       most.str() + ": their triangles may differ from those of other programs");
  }
  if (odd.crossing > 0) {
    warnings.push_back(name + ": " +
                       counted(odd.crossing, "face crosses itself and is", "faces cross themselves and are") +
                       " split into a fan from the first corner");
  }
  return file;
}

/// As transformPoint() places a vertex.
std::array<double, 3> placed(const Transform& pose, const double* p) {
  const auto& m = pose.m;
  std::array<double, 3> result{};
  for (size_t i = 0; i < 3; ++i)
    result[i] = ((m[4 * i] * p[0] + m[4 * i + 1] * p[1]) + m[4 * i + 2] * p[2]) + m[4 * i + 3];
  return result;
}

/// The triangles of nodes of a file, as one mesh.
struct Collector {
  const std::string& name;
  const MeshFile& file;
  double scale;
  std::vector<double> positions{};
  std::vector<uint32_t> indices{};
  uint64_t points = 0, lines = 0;

  /// What was added since the last call.
  FileMesh take(const std::string& meshName, std::vector<std::string>& warnings);

  void add(const MeshFile::Node& node, const Transform& meshFromNode);
  void add(const MeshFile::Part& part, const Transform& meshFromPart, const std::string& place);
};

void Collector::add(const MeshFile::Node& node, const Transform& meshFromNode) {
  for (const uint32_t number : node.parts) {
    add(file.parts[number], meshFromNode, placeOf(node) + ": mesh " + std::to_string(number));
  }
}

void Collector::add(const MeshFile::Part& part, const Transform& meshFromPart, const std::string& place) {
  const size_t first = positions.size() / 3, count = part.positions.size() / 3;
  for (size_t i = 0; i < count; ++i) {
    const double* vertex = &part.positions[3 * i];
    for (const double unscaled : placed(meshFromPart, vertex)) {
      const double coordinate = scale * unscaled;
      if (!std::isfinite(static_cast<float>(coordinate))) {
        std::ostringstream problem;
        problem << "expected 3 finite numbers, got " << vertex[0] << " " << vertex[1] << " " << vertex[2]
                << " before the node's transform" << (scale == 1 ? "" : " and the scale " + inShortest(scale));
        throw InputError(name, place + ": vertex " + std::to_string(i), problem.str());
      }
      positions.push_back(coordinate);
    }
  }
  for (size_t i = 0; i < part.indices.size(); ++i) {
    const uint32_t index = part.indices[i];
    if (index >= count) {
      throw InputError(name, place + ": triangle " + std::to_string(i / 3),
                       "expected vertices below " + std::to_string(count) + ", got " + std::to_string(index));
    }
    indices.push_back(static_cast<uint32_t>(first + index));
  }
  if (mirrors(meshFromPart)) {
    for (size_t i = indices.size() - part.indices.size(); i < indices.size(); i += 3) {
      std::swap(indices[i + 1], indices[i + 2]);
    }
  }
  points += part.points;
  lines += part.lines;
}

FileMesh Collector::take(const std::string& meshName, std::vector<std::string>& warnings) {
  FloatVertices vertices = floatVertices(positions, indices);
  if (vertices.isSpoilt) {
    std::ostringstream most;
    most << vertices.change;
    warnings.push_back(printable(meshName) + ": floats, which vertices become, change its numbers by up to " +
                       most.str());
  }
  FileMesh mesh{{meshName, std::move(vertices.positions), std::move(indices)}, vertices.base};
  positions.clear();
  indices.clear();
  return mesh;
}

/// Refuses, before anything is copied, what would be too large: a few bytes for a node may place a large mesh again.
/// `shared`: nodes that place the same parts share one copy.
void requireSize(const std::string& name, const MeshFile& file, bool shared) {
  uint64_t stored = 0, placed = 0;
  const auto sizeOf = [](const MeshFile::Part& part) {
    return std::max(part.positions.size(), part.indices.size()) / 3;
  };
  for (const MeshFile::Part& part : file.parts) stored += sizeOf(part);
  std::set<std::vector<uint32_t>> known;
  for (const MeshFile::Node& node : file.nodes) {
    if (shared && !known.insert(node.parts).second) continue;
    for (const uint32_t number : node.parts) placed += sizeOf(file.parts.at(number));
  }
  constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max() / 3;
  const uint64_t limit = std::min(std::max(stored, kMostCopied), kMost);
  if (placed <= limit) return;
  throw InputError(name, "",
                   "expected at most " + std::to_string(limit) +
                       " vertices and triangles, counted as often as nodes place them, got " + std::to_string(placed));
}

void warnOfDropped(const Collector& collected, std::vector<std::string>& warnings) {
  if (collected.points + collected.lines == 0) return;
  warnings.push_back(printable(collected.name) + ": dropped " + counted(collected.points, "point") + " and " +
                     counted(collected.lines, "line") + ", which are no surface");
}

void requireScale(const std::string& name, double scale) {
  if (scale > 0 && std::isfinite(scale)) return;
  throw InputError(name, "scale", "expected a finite number above 0, got " + inShortest(scale));
}

void requireTriangles(bool some, const Collector& collected) {
  if (some) return;
  throw InputError(collected.name, "",
                   "expected at least one triangle, got " + counted(collected.points, "point") + " and " +
                       counted(collected.lines, "line"));
}

FileMesh wholeOf(const std::filesystem::path& path, const MeshFile& file, std::vector<std::string>& warnings,
                 double scale) {
  const std::string name = path.string();
  requireSize(name, file, false);
  Collector collector{name, file, scale};
  for (const MeshFile::Node& node : file.nodes) collector.add(node, node.fileFromNode);
  requireTriangles(!collector.indices.empty(), collector);
  warnOfDropped(collector, warnings);
  return collector.take(path.filename().string(), warnings);
}

Assembly assemblyOf(const std::filesystem::path& path, const MeshFile& file, std::vector<std::string>& warnings,
                    double scale) {
  const std::string name = path.string();
  requireSize(name, file, true);
  Assembly assembly;
  Collector collector{name, file, scale};
  std::map<std::vector<uint32_t>, uint32_t> known;  // what nodes place -> its mesh
  for (const MeshFile::Node& node : file.nodes) {
    auto found = known.find(node.parts);
    if (found == known.end()) {
      collector.add(node, {});
      const std::string meshName = path.filename().string() + "#" + std::to_string(assembly.parts.size());
      FileMesh mesh = collector.take(meshName, warnings);
      if (mesh.indices.empty()) continue;
      found = known.emplace(node.parts, static_cast<uint32_t>(assembly.meshes.size())).first;
      assembly.meshes.push_back(std::move(mesh));
    }
    Transform fileFromNode = node.fileFromNode;
    for (size_t row = 0; row < 3; ++row) fileFromNode.m[4 * row + 3] *= scale;
    if (std::string wrong = validate(fileFromNode); !wrong.empty()) throw InputError(name, placeOf(node), wrong);
    assembly.parts.push_back({node.name, found->second, fileFromNode});
  }
  requireTriangles(!assembly.parts.empty(), collector);
  warnOfDropped(collector, warnings);
  return assembly;
}

}  // namespace

Assembly readAssembly(const std::filesystem::path& path, std::vector<std::string>& warnings, double scale) {
  const DefaultFloats floats;
  requireScale(path.string(), scale);
  return assemblyOf(path, openFile(path, warnings), warnings, scale);
}

FileContent readContent(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  const DefaultFloats floats;
  const MeshFile file = openFile(path, warnings);
  FileContent content{file.unit, wholeOf(path, file, warnings, 1), {}};
  std::vector<std::string> more;
  content.assembly = assemblyOf(path, file, more, 1);
  for (std::string& warning : more) {
    if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(std::move(warning));
  }
  return content;
}

uint32_t Assembly::numberOf(const std::string& file, const std::string& node) const {
  if (node.find_first_not_of("0123456789") == node.npos) {
    uint32_t number = 0;
    const auto [end, error] = std::from_chars(node.data(), node.data() + node.size(), number);
    if (node.empty() || error != std::errc() || number >= parts.size()) {
      throw InputError(file + "#" + node, "", "expected one of the " + counted(parts.size(), "node") + ", from 0");
    }
    return number;
  }
  const auto isIt = [&](const Part& part) { return part.name == node; };
  const auto count = std::ranges::count_if(parts, isIt);
  if (count != 1) {
    throw InputError(file + "#" + node, "",
                     "expected the name that one node with triangles has, or a node's number, got a name that " +
                         (count == 0 ? "none has" : std::to_string(count) + " have"));
  }
  return static_cast<uint32_t>(std::ranges::find_if(parts, isIt) - parts.begin());
}

MeshName splitMeshName(const std::filesystem::path& name) {
  std::error_code error;
  if (std::filesystem::is_regular_file(name, error)) return {name, {}};
  const std::string text = name.string();
  for (size_t at = text.find('#'); at != text.npos; at = text.find('#', at + 1)) {
    if (std::filesystem::is_regular_file(text.substr(0, at), error)) return {text.substr(0, at), text.substr(at + 1)};
  }
  return {name, {}};
}

FileMesh readMesh(const std::filesystem::path& name, std::vector<std::string>& warnings, double scale) {
  const DefaultFloats floats;
  const MeshName split = splitMeshName(name);
  requireScale(name.string(), scale);
  if (!split.node) return wholeOf(split.file, openFile(split.file, warnings), warnings, scale);
  FileMesh mesh = readAssembly(split.file, warnings, scale).meshOf(split.file.string(), *split.node);
  mesh.name = name.filename().string();
  return mesh;
}

}  // namespace radar::tools
