#include <optional>

#include "import/readers.h"

namespace radar::tools {

namespace {

void skipComments(Text& text) {
  while (Text(text).token().starts_with('#')) text.lineOfText();
}

uint64_t readCount(Text& text, const char* what) {
  skipComments(text);
  const std::string_view word = text.token();
  const std::optional<uint64_t> count = wholeNumber(word);
  if (!count) text.expected(what, word);
  return *count;
}

/// The next line with a vertex or a face.
Text dataLine(Text& text, const char* what, uint64_t i, uint64_t count) {
  while (!text.atEnd()) {
    const size_t number = text.line();
    const std::string_view line = text.lineOfText(), data = line.substr(0, line.find('#'));
    if (data.find_first_not_of(kBlanks) != data.npos) return {text.file(), data, number};
  }
  text.refuse(std::string(what) + " " + std::to_string(i),
              "expected " + std::to_string(count) + " in all, the file ends");
}

void readVertex(Text line, bool homogeneous, std::vector<double>& positions) {
  double weight = 1;
  if (homogeneous) {
    Text ahead = line;
    for (int k = 0; k < 4; ++k) weight = ahead.number(ahead.token());
  }
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = line.token();
    positions.push_back(weight == 1 ? line.coordinate(word) : line.number(word) / weight);
  }
}

/// Reads the word that the file begins with, such as COFF; a file may leave it out. Returns whether vertices have a
/// fourth coordinate.
bool readHeader(Text& text) {
  skipComments(text);
  Text after = text;
  const std::string_view word = after.token();
  if (wholeNumber(word)) return false;
  std::string_view kind = word;
  for (const std::string_view prefix : {"ST", "C", "N"}) {
    if (kind.starts_with(prefix)) kind.remove_prefix(prefix.size());
  }
  const bool homogeneous = kind == "4OFF";
  if (!homogeneous && kind != "OFF") text.expected("a file that begins with OFF, COFF, NOFF, STOFF or 4OFF", word);
  text = after;
  return homogeneous;
}

}  // namespace

MeshFile readOff(Text text) {
  const bool homogeneous = readHeader(text);
  const uint64_t vertices = readCount(text, "the number of vertices");
  const uint64_t faces = readCount(text, "the number of faces");
  readCount(text, "the number of edges");
  text.lineOfText();
  MeshFile file{{{}}, {{"<OFFRoot>", {}, {0}}}};
  MeshFile::Part& part = file.parts.front();
  for (uint64_t i = 0; i < vertices; ++i) {
    readVertex(dataLine(text, "vertex", i, vertices), homogeneous, part.positions);
  }
  std::vector<uint32_t> corners;
  for (uint64_t i = 0; i < faces; ++i) {
    Text line = dataLine(text, "face", i, faces);
    const auto next = [&](const char* what, uint64_t least, uint64_t end) {
      const std::string_view word = line.token();
      const std::optional<uint64_t> value = wholeNumber(word);
      if (value && *value >= least && *value < end) return *value;
      line.expected("face " + std::to_string(i) + " to have " + what, word);
    };
    corners.resize(next("1 corner or more, as many as the line has", 1, line.rest().size()));
    for (uint32_t& corner : corners) corner = static_cast<uint32_t>(next("numbers of vertices, from 0", 0, vertices));
    part.addFace(corners);
  }
  return file;
}

}  // namespace radar::tools
