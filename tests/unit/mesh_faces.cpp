// Faces of more than three corners: what their triangles cover.
#include <algorithm>
#include <cmath>

#include "mesh_texts.h"
#include "workloads/random.h"

using namespace radar::tools;
using namespace radar::test;

namespace {

struct Point {
  int64_t x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};
using Polygon = std::vector<Point>;

/// Twice the area, positive if counterclockwise.
int64_t cross(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

int64_t areaOf(const Polygon& p) {
  int64_t sum = 0;
  for (size_t i = 2; i < p.size(); ++i) sum += cross(p[0], p[i - 1], p[i]);
  return sum;
}

bool isOn(const Point& p, const Point& a, const Point& b) {
  return cross(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

int signOf(int64_t value) {
  return (value > 0) - (value < 0);
}

bool meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (isOn(a, c, d) || isOn(b, c, d) || isOn(c, a, b) || isOn(d, a, b)) return true;
  return signOf(cross(a, b, c)) * signOf(cross(a, b, d)) < 0 && signOf(cross(c, d, a)) * signOf(cross(c, d, b)) < 0;
}

/// How often the border runs round a point; nothing if that is on it.
std::optional<int> winding(const Polygon& border, const Point& p) {
  int number = 0;
  for (size_t i = 0; i < border.size(); ++i) {
    const Point &a = border[i], &b = border[(i + 1) % border.size()];
    if (isOn(p, a, b)) return {};
    if (a.y <= p.y && b.y > p.y && cross(a, b, p) > 0) ++number;
    if (b.y <= p.y && a.y > p.y && cross(a, b, p) < 0) --number;
  }
  return number;
}

int64_t anyOf(Random& random, int64_t below) {
  return random.below(static_cast<uint32_t>(below));
}

/// Corners round a centre that sees them all; none if it would be outside.
Polygon anyStar(Random& random, const Point& centre, int64_t radius) {
  Polygon star;
  for (uint32_t count = 3 + random.below(12); count > 0; --count) {
    star.push_back({anyOf(random, 2 * radius + 1) - radius, anyOf(random, 2 * radius + 1) - radius});
  }
  std::erase(star, Point{});
  const auto half = [](const Point& p) { return p.y < 0 || (p.y == 0 && p.x < 0); };
  const auto before = [&](const Point& p, const Point& q) {
    return half(p) != half(q) ? half(p) < half(q) : cross({}, p, q) > 0;
  };
  std::ranges::sort(star, before);
  star.erase(std::unique(star.begin(), star.end(), [&](auto& p, auto& q) { return !before(p, q) && !before(q, p); }),
             star.end());
  for (size_t i = 0; i < star.size(); ++i) {
    if (cross({}, star[i], star[(i + 1) % star.size()]) <= 0) return {};
  }
  for (Point& p : star) p = {p.x + centre.x, p.y + centre.y};
  return star;
}

/// Two chains of corners from left to right, one above the other.
Polygon anyStrip(Random& random) {
  Polygon low, high;
  for (int64_t x = 0, count = 2 + anyOf(random, 8); x < count; ++x) {
    low.push_back({128 * x, -16 * (1 + anyOf(random, 20))});
    high.insert(high.begin(), {128 * x, 16 * (1 + anyOf(random, 20))});
  }
  low.insert(low.end(), high.begin(), high.end());
  return low;
}

/// Cells of a grid, as the border of all of them with a corner at each cell.
Polygon anyStairs(Random& random) {
  Polygon border{{0, 0}, {0, 0}};
  std::vector<int64_t> heights;
  for (uint32_t count = 2 + random.below(6); count > 0; --count) heights.push_back(1 + anyOf(random, 4));
  border.clear();
  const auto columns = static_cast<int64_t>(heights.size());
  for (int64_t x = 0; x <= columns; ++x) border.push_back({64 * x, 0});
  for (int64_t x = columns; x-- > 0;) {
    const int64_t from = x + 1 < columns ? heights[size_t(x) + 1] : 0, to = heights[size_t(x)];
    for (int64_t y = from; y != to; y += to > from ? 1 : -1) {
      if (y != 0) border.push_back({64 * (x + 1), 64 * y});
    }
    border.push_back({64 * (x + 1), 64 * to});
  }
  for (int64_t y = heights[0]; y > 0; --y) border.push_back({0, 64 * y});
  border.erase(std::unique(border.begin(), border.end()), border.end());
  return border;
}

/// Whether a bridge from a corner runs into the face.
bool leadsInside(const Polygon& p, size_t corner, const Point& to) {
  const Point &before = p[(corner + p.size() - 1) % p.size()], &at = p[corner], &next = p[(corner + 1) % p.size()];
  const bool ofIn = cross(before, at, to) > 0, ofOut = cross(at, next, to) > 0;
  return cross(before, at, next) > 0 ? ofIn && ofOut : ofIn || ofOut;
}

/// Cuts a hole into a face, with a bridge to it, if there is room.
void addHole(Random& random, Polygon& face) {
  const Point centre = face[random.below(static_cast<uint32_t>(face.size()))];
  Polygon hole = anyStar(random, {centre.x + anyOf(random, 257) - 128, centre.y + anyOf(random, 257) - 128}, 40);
  if (hole.size() < 3 || areaOf(hole) <= 0) return;
  std::ranges::reverse(hole);
  for (size_t i = 0; i < hole.size(); ++i) {
    if (winding(face, hole[i]) != 1) return;
    for (size_t k = 0; k < face.size(); ++k) {
      if (meet(hole[i], hole[(i + 1) % hole.size()], face[k], face[(k + 1) % face.size()])) return;
    }
  }
  for (const Point& p : face) {
    if (winding(hole, p) != 0) return;
  }
  const auto isBridge = [&](size_t from, size_t to) {
    const Point &a = face[from], &b = hole[to];
    if (!leadsInside(face, from, b) || !leadsInside(hole, to, a)) return false;
    for (const Polygon* border : {&face, &hole}) {
      for (size_t i = 0; i < border->size(); ++i) {
        const Point &c = (*border)[i], &d = (*border)[(i + 1) % border->size()];
        const bool ends = c == a || d == a || c == b || d == b;
        if (ends ? (c != a && c != b && isOn(c, a, b)) || (d != a && d != b && isOn(d, a, b)) : meet(a, b, c, d)) {
          return false;
        }
      }
    }
    return true;
  };
  for (int tries = 0; tries < 20; ++tries) {
    const size_t from = random.below(static_cast<uint32_t>(face.size())),
                 to = random.below(static_cast<uint32_t>(hole.size()));
    if (!isBridge(from, to)) continue;
    std::ranges::rotate(hole, hole.begin() + static_cast<long>(to));
    hole.push_back(hole[0]);
    hole.push_back(face[from]);
    face.insert(face.begin() + static_cast<long>(from) + 1, hole.begin(), hole.end());
    return;
  }
}

Polygon anyFace(Random& random) {
  Polygon face;
  while (face.size() < 4 || areaOf(face) <= 0) {
    const uint32_t kind = random.below(3);
    face = kind == 0 ? anyStar(random, {}, 200) : kind == 1 ? anyStrip(random) : anyStairs(random);
  }
  for (uint32_t holes = random.below(4); holes > 0; --holes) addHole(random, face);
  for (uint32_t more = random.below(6); more > 0; --more) {
    const size_t at = random.below(static_cast<uint32_t>(face.size()));
    const Point p = face[at], q = face[(at + 1) % face.size()];
    const bool hasMiddle = (p.x + q.x) % 2 == 0 && (p.y + q.y) % 2 == 0;
    const Point middle{(p.x + q.x) / 2, (p.y + q.y) / 2};
    face.insert(face.begin() + static_cast<long>(at) + 1, hasMiddle && random.oneIn(2) ? middle : p);
  }
  std::ranges::rotate(face, face.begin() + random.below(static_cast<uint32_t>(face.size())));
  if (random.oneIn(2)) std::ranges::reverse(face);
  return face;
}

using Triangles = std::span<const uint32_t>;

/// Whether the triangles cover what the border runs round, once, and nothing else.
void requireCovered(Random& random, const Polygon& face, Triangles corners) {
  std::string words;
  for (const Point& p : face) words += " " + std::to_string(p.x) + "," + std::to_string(p.y);
  CAPTURE(words);
  const int way = signOf(areaOf(face));
  bool isFan = true;
  for (size_t i = 2; i < face.size(); ++i) isFan = isFan && way * cross(face[0], face[i - 1], face[i]) >= 0;
  int64_t area = 0;
  std::vector<Polygon> triangles;
  for (size_t i = 0; i < corners.size(); i += 3) {
    if (isFan)
      REQUIRE(std::array{corners[i], corners[i + 1], corners[i + 2]} ==
              std::array{0u, uint32_t(i / 3 + 1), uint32_t(i / 3 + 2)});
    triangles.push_back({face[corners[i]], face[corners[i + 1]], face[corners[i + 2]]});
    const int64_t part = way * areaOf(triangles.back());
    REQUIRE(part >= 0);
    area += part;
  }
  REQUIRE(area == way * areaOf(face));
  for (int i = 0; i < 30; ++i) {
    const Point& near = face[random.below(static_cast<uint32_t>(face.size()))];
    const Point p{near.x + anyOf(random, 129) - 64, near.y + anyOf(random, 129) - 64};
    const std::optional<int> expected = winding(face, p);
    int covered = 0;
    bool isOnSide = false;
    for (const Polygon& triangle : triangles) {
      const std::optional<int> number = winding(triangle, p);
      isOnSide = isOnSide || !number;
      covered += std::abs(number.value_or(0));
    }
    if (expected && !isOnSide) REQUIRE(covered == std::abs(*expected));
  }
}

/// As OBJ, each face in a plane of its own, whose coordinates are numbers of `unit`.
std::string objOf(Random& random, const std::vector<Polygon>& faces, double unit) {
  std::string text;
  for (const Polygon& face : faces) {
    int64_t axes[3][3];  // where the face begins, and its two directions, which are not parallel
    const auto minorOf = [&](size_t k) {
      return axes[1][k] * axes[2][(k + 1) % 3] - axes[1][(k + 1) % 3] * axes[2][k];
    };
    do {
      for (auto& axis : axes) {
        for (int64_t& number : axis) number = anyOf(random, 41) - 20;
      }
    } while (minorOf(0) == 0 && minorOf(1) == 0 && minorOf(2) == 0);
    for (const Point& p : face) {
      text += "v";
      for (int k = 0; k < 3; ++k) {
        const int64_t number = axes[0][k] + axes[1][k] * p.x + axes[2][k] * p.y;
        char word[64];
        snprintf(word, sizeof word, " %.9g", unit * double(number));
        text += word;
      }
      text += "\n";
    }
    text += "f";
    for (size_t i = face.size(); i > 0; --i) text += " -" + std::to_string(i);
    text += "\n";
  }
  return text;
}

void requireAllCovered(uint64_t seed, double unit, bool isRounded) {
  const ScratchFolder folder;
  Random random(seed);
  std::vector<Polygon> faces;
  while (faces.size() < 3000) faces.push_back(anyFace(random));
  const MeshData mesh = readWhole(folder.write("a.obj", objOf(random, faces, unit)));
  size_t at = 0;
  uint32_t first = 0;
  for (const Polygon& face : faces) {
    std::vector<uint32_t> corners;
    for (size_t i = 0; i < 3 * (face.size() - 2); ++i) corners.push_back(mesh.indices.at(at++) - first);
    if (!isRounded) requireCovered(random, face, corners);
    int64_t area = 0;
    for (size_t i = 0; i < corners.size(); i += 3) {
      area += std::abs(cross(face[corners[i]], face[corners[i + 1]], face[corners[i + 2]]));
    }
    CHECK(area == std::abs(areaOf(face)));
    first += static_cast<uint32_t>(face.size());
  }
  CHECK(at == mesh.indices.size());
}

}  // namespace

TEST_CASE("the triangles of any face cover what its border runs round, once and nothing else") {
  requireAllCovered(1, 1, false);
  requireAllCovered(2, 0x1p-3, false);
}

TEST_CASE("corners whose numbers are rounded, so that they are nearly on a line or in a plane, change nothing") {
  requireAllCovered(3, 0.001 / 3, true);
}

TEST_CASE("a notch stays open, and so does a window whose border a bridge joins to that of the wall") {
  const ScratchFolder folder;
  const MeshData ell =
      readWhole(folder.write("ell.obj", "v 4 0 0\nv 4 1 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\nv 0 0 0\nf 1 2 3 4 5 6\n"));
  CHECK(ell.triangleCount() == 4);
  const std::string wall =
      "v 0 0 0\nv 6 0 0\nv 6 4 0\nv 0 4 0\nv 2 1 0\nv 2 3 0\nv 4 3 0\nv 4 1 0\nf 1 2 3 4 1 5 6 7 8 5\n";
  CHECK(readWhole(folder.write("wall.obj", wall)).triangleCount() == 8);
}

TEST_CASE("a face whose corners lie in no plane, or which crosses itself, is split with a warning") {
  const ScratchFolder folder;
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 ";
  std::vector<std::string> warnings;
  const auto read = [&](const std::string& text) {
    warnings.clear();
    return readMesh(folder.write("a.obj", text), warnings);
  };
  CHECK(read(square + "0.0001\nf 1 2 3 4\n").triangleCount() == 2);
  CHECK(warnings.empty());
  CHECK(read(square + "0.1\nf 1 2 3 4\nf 4 3 2 1\n").triangleCount() == 4);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("a.obj: the corners of 2 faces do not lie in a plane"));
  CHECK(read(square + "0\nv 3 2 0\nf 1 2 4 3 5\n").indices.size() == 9);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("1 face crosses itself and is split into a fan"));
}

TEST_CASE("a face that is not convex and has too many corners to be split within seconds is refused") {
  const ScratchFolder folder;
  std::string text, face = "f";
  for (int i = 0; i < 33'000; ++i) {  // a saw
    text += "v " + std::to_string(i) + (i == 0 ? " 0 0\n" : i % 2 == 0 ? " 1 0\n" : " 2 0\n");
    face += " " + std::to_string(i + 1);
  }
  CHECK_THAT(refusalOf(folder.write("a.obj", text + face + "\n")),
             Contains("at most 32768 corners") && Contains("33000"));
}
