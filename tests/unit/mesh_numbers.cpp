// Numbers in mesh files of text become the nearest floats.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <locale>

#include "import/number_text.h"
#include "mesh_texts.h"
#include "workloads/random.h"

using namespace radar::tools;
using namespace radar::test;

namespace {

struct Number {
  std::string text;
  float nearest;
};

template <class... Arguments>
std::string print(const char* format, const Arguments&... arguments) {
  char buffer[1024];
  snprintf(buffer, sizeof buffer, format, arguments...);
  return buffer;
}

/// A finite float of any magnitude, subnormal ones and 0 included.
float anyFloat(Random& random) {
  const uint32_t exponent = random.below(255), mantissa = random.below(1u << 23), sign = random.below(2);
  return std::bit_cast<float>(sign << 31 | exponent << 23 | mantissa);
}

/// As a person or a program may write it: nothing here changes the value.
std::string rewritten(Random& random, std::string text) {
  if (random.oneIn(3) && text[0] != '-') text.insert(0, "+");
  if (random.oneIn(3)) {
    if (const size_t at = text.find('e'); at != text.npos) text[at] = 'E';
  }
  const size_t first = text.find_first_of("0123456789");
  if (random.oneIn(3)) text.insert(first, "000");
  return text;
}

/// Exactly halfway between two floats, or a trifle to one side of that, with all its digits.
Number nearHalfway(Random& random) {
  float low = anyFloat(random);
  while (std::abs(low) > std::bit_cast<float>(0x7f7ffffeu)) low = anyFloat(random);
  low = std::abs(low);
  const float high = std::nextafter(low, std::numeric_limits<float>::infinity());
  std::string text = print("%.160e", (double(low) + double(high)) / 2);  // exact: more digits than any such number has
  const size_t exponent = text.find('e');
  const bool evenLow = std::bit_cast<uint32_t>(low) % 2 == 0;
  switch (random.below(3)) {
    case 0:
      return {text, evenLow ? low : high};
    case 1:
      return {text.insert(exponent, "000000001"), high};
    default:
      // The last digit that is not 0 becomes one less, and nines follow.
      size_t last = text.find_last_not_of('0', exponent - 1);
      if (text[last] == '.') --last;
      --text[last];
      for (size_t i = last + 1; i < exponent; ++i) text[i] = text[i] == '.' ? '.' : '9';
      return {text, low};
  }
}

Number anyNumber(Random& random) {
  if (random.oneIn(4)) return nearHalfway(random);
  if (random.oneIn(3)) {
    // A double, which text need not give exactly; the float next to it is at most a rounding of it away.
    const double value = random.uniform(-1, 1) * random.magnitude(-44, 38);
    const std::string text = print(random.oneIn(2) ? "%.17g" : "%.12f", value);
    return {text, strtof(text.c_str(), nullptr)};
  }
  const float value = anyFloat(random);
  return {print(random.oneIn(2) ? "%.9g" : "%.30e", double(value)), value};
}

std::vector<Number> manyNumbers(Random& random, size_t count) {
  std::vector<Number> numbers{{"0", 0},
                              {".5", 0.5f},
                              {"5.", 5},
                              {"-.25e-0", -0.25f},
                              {"1E+2", 100},
                              {"1e-46", 0},
                              {"-1e-400", 0},
                              {"1e-99999999999999999999", 0},
                              {"7.0064923216240853e-46", 0},
                              {"7.0064923216240854e-46", std::numeric_limits<float>::denorm_min()},
                              {"0." + std::string(60, '0') + "1", 0},
                              {std::string(500, '0') + "1", 1},
                              {"340282346638528859811704183484516925440", std::numeric_limits<float>::max()}};
  while (numbers.size() < count) {
    Number number = anyNumber(random);
    number.text = rewritten(random, number.text);
    numbers.push_back(number);
  }
  return numbers;
}

using Rows = std::vector<Number>;

/// Three numbers for each vertex, three vertices for each triangle.
std::string objOf(const Rows& rows) {
  std::string text, faces;
  for (size_t i = 0; i < rows.size(); i += 3) {
    text += "v " + rows[i].text + " " + rows[i + 1].text + "\t" + rows[i + 2].text + "\n";
    faces += (i % 9 == 0 ? "\nf " : " ") + std::to_string(i / 3 + 1);
  }
  return text + faces + "\n";
}

std::string stlOf(const Rows& rows) {
  std::string text = "solid a\n";
  for (size_t i = 0; i < rows.size(); i += 3) {
    if (i % 9 == 0) text += "facet normal 0 0 0\nouter loop\n";
    text += "vertex " + rows[i].text + " " + rows[i + 1].text + " " + rows[i + 2].text + "\n";
    if (i % 9 == 6) text += "endloop\nendfacet\n";
  }
  return text + "endsolid a\n";
}

std::string linesOf(const Rows& rows) {
  std::string text;
  for (size_t i = 0; i < rows.size(); ++i) text += rows[i].text + (i % 3 == 2 ? "\n" : " ");
  for (size_t i = 0; i < rows.size() / 3; i += 3) {
    text += "3 " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  }
  return text;
}

std::string plyOf(const Rows& rows, const char* type) {
  return plyHeader(rows.size() / 3, rows.size() / 9, "ascii", type) + linesOf(rows);
}

std::string offOf(const Rows& rows) {
  return "OFF\n" + std::to_string(rows.size() / 3) + " " + std::to_string(rows.size() / 9) + " 0\n" + linesOf(rows);
}

std::string binaryStlOf(const Rows& rows) {
  std::string bytes(80, ' ');
  append(bytes, static_cast<uint32_t>(rows.size() / 9));
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i % 9 == 0) bytes.append(12, '\0');
    append(bytes, rows[i].nearest);
    if (i % 9 == 8) bytes.append(2, '\0');
  }
  return bytes;
}

std::string binaryPlyOf(const Rows& rows, bool bigEndian) {
  std::string bytes =
      plyHeader(rows.size() / 3, rows.size() / 9, bigEndian ? "binary_big_endian" : "binary_little_endian", "double");
  const auto add = [&](auto value) {
    std::string own;
    append(own, value);
    if (bigEndian) std::reverse(own.begin(), own.end());
    bytes += own;
  };
  for (const Number& number : rows) add(double(number.nearest));
  for (uint32_t i = 0; i < rows.size() / 3; ++i) {
    if (i % 3 == 0) add('\3');
    add(i);
  }
  return bytes;
}

class Commas : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

}  // namespace

TEST_CASE("a number in text becomes the nearest float, of two equally near ones the even one") {
  Random random(2024);
  size_t wrong = 0;
  for (const Number& number : manyNumbers(random, 200'000)) {
    const std::optional<float> read = nearest<float>(number.text);
    if (read && *read == number.nearest) continue;
    ++wrong;
    UNSCOPED_INFO(number.text << " became " << read.value_or(NAN));
  }
  CHECK(wrong == 0);
  CHECK(nearest<float>("-inf").value() == -std::numeric_limits<float>::infinity());
  CHECK(std::isnan(nearest<float>("nan").value()));
  CHECK(nearest<double>("0.1").value() == 0.1);
  for (const char* text : {"", "+", "-", "+-1", ".", "1,5", "1.5f", "0x10", "1e", "1e+", "1d3", "one", "1 2", "1e39",
                           "-1e99999999999999999999", "340282356779733661637539395458142568448"}) {
    CAPTURE(text);
    CHECK_FALSE(nearest<float>(text));
  }
}

TEST_CASE("every coordinate of an OBJ, STL, PLY or OFF file of text is the nearest float, as in a binary file") {
  const ScratchFolder folder;
  Random random(7);
  const Rows rows = manyNumbers(random, 9 * 700);
  std::vector<float> expected;
  for (const Number& number : rows) expected.push_back(number.nearest);
  const MeshData binary = readWhole(folder.write("binary.stl", binaryStlOf(rows)));
  CHECK(binary.positions == expected);
  // -0 is 0 here, which is the same place.
  for (const auto& [name, content] :
       {std::pair{"a.obj", objOf(rows)}, std::pair{"a.stl", stlOf(rows)}, std::pair{"a.ply", plyOf(rows, "float")},
        std::pair{"double.ply", plyOf(rows, "double")}, std::pair{"a.off", offOf(rows)},
        std::pair{"little.ply", binaryPlyOf(rows, false)}, std::pair{"big.PLY", binaryPlyOf(rows, true)}}) {
    CAPTURE(name);
    const MeshData mesh = readWhole(folder.write(name, content));
    CHECK(mesh.positions == expected);
    CHECK(mesh.indices == binary.indices);
  }
}

TEST_CASE("a locale with decimal commas changes nothing that is read") {
  const ScratchFolder folder;
  Random random(8);
  const Rows rows = manyNumbers(random, 9 * 1200);  // counts of more than 999
  std::vector<std::string> files{folder.write("a.obj", objOf(rows)), folder.write("a.stl", stlOf(rows)),
                                 folder.write("a.ply", plyOf(rows, "float")), folder.write("a.off", offOf(rows))};
  const MeshData before = readWhole(folder.write("binary.stl", binaryStlOf(rows)));
  const std::locale original = std::locale::global(std::locale(std::locale(), new Commas));
  std::vector<MeshData> meshes;
  meshes.reserve(files.size());
  for (const std::string& file : files) meshes.push_back(readWhole(file));
  std::locale::global(original);
  for (const MeshData& mesh : meshes) {
    CHECK(mesh.positions == before.positions);
    CHECK(mesh.indices == before.indices);
  }
}

TEST_CASE("homogeneous coordinates are divided, and a last coordinate of 1 rounds nothing") {
  const ScratchFolder folder;
  // Just above halfway between two floats, which a double does not show.
  const std::string odd = "1.00000005960464477539062500000001";
  const std::vector<float> expected{1.00000012f, 0.1f, 3, 0.5f, 2, -1, 0, 0, 0};
  const std::string first = odd + " 0.1 3 1\n", second = "1 4 -2 2\n", third = "0 0 0 1\n";
  CHECK(readWhole(folder.write("a.obj", "v " + first + "v " + second + "v " + third + "f 1 2 3\n")).positions ==
        expected);
  CHECK(readWhole(folder.write("a.off", "4OFF\n3 1 0\n" + first + second + third + "3 0 1 2\n")).positions == expected);
}
