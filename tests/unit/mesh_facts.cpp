#include "import/mesh_facts.h"

#include <algorithm>

#include "mesh_texts.h"

using namespace radar::tools;
using namespace radar::test;

namespace {

/// A tetrahedron of volume 1/6, wound outwards.
const MeshData kTetrahedron{"", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}};

MeshData turnedOver(MeshData mesh) {
  for (size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  return mesh;
}

/// Both meshes as one; the second is scaled and moved by the same number along each axis.
MeshData together(MeshData a, const MeshData& b, float scale, float move) {
  for (const uint32_t index : b.indices) a.indices.push_back(index + a.vertexCount());
  for (const float x : b.positions) a.positions.push_back(scale * x + move);
  return a;
}

/// The same triangles without common vertices.
MeshData apart(const MeshData& mesh) {
  MeshData soup;
  for (const uint32_t index : mesh.indices) {
    soup.indices.push_back(static_cast<uint32_t>(soup.indices.size()));
    for (size_t k = 0; k < 3; ++k) soup.positions.push_back(mesh.positions[3 * index + k]);
  }
  return soup;
}

}  // namespace

TEST_CASE("a closed mesh is told from an open one, whether or not its triangles share vertices") {
  for (const MeshData& mesh : {kTetrahedron, apart(kTetrahedron)}) {
    const MeshFacts facts = factsOf(mesh);
    CHECK((facts.isClosed() && facts.isEven() && facts.shells == 1));
    CHECK(facts.volume == Approx(1.0 / 6));
    CHECK(inWords(facts) == "closed, wound outwards");
    MeshData open = mesh;
    open.indices.resize(9);
    CHECK(factsOf(open).borderEdges == 3);
    CHECK(inWords(factsOf(open)) == "open: 3 border edges");
  }
  MeshData negative = apart(kTetrahedron);
  for (size_t i = 0; i < 9; ++i) negative.positions[i] *= -1;  // -0; the others are another triangle's
  CHECK(factsOf(negative).borderEdges == 6);
  for (float& x : negative.positions) x = x == 0 ? -0.0f : std::abs(x);
  for (size_t i = 0; i < 9; ++i) negative.positions[i] += 0.0f;
  CHECK(factsOf(negative).isClosed());
}

TEST_CASE("a mesh that is wound inwards or unevenly is noticed, and a cavity is told apart") {
  CHECK(inWords(factsOf(turnedOver(kTetrahedron))) == "closed, wound inwards");
  CHECK(factsOf(turnedOver(kTetrahedron)).volume == Approx(-1.0 / 6));
  MeshData uneven = kTetrahedron;
  std::swap(uneven.indices[0], uneven.indices[1]);
  const MeshFacts facts = factsOf(uneven);
  CHECK((facts.isClosed() && !facts.isEven() && facts.unevenEdges == 3));
  CHECK_THAT(inWords(facts), Contains("turns over at 3 edges"));
  const MeshFacts hollow = factsOf(together(kTetrahedron, turnedOver(kTetrahedron), 0.25f, 0.125f));
  CHECK((hollow.shells == 2 && hollow.inwardShells == 1));
  CHECK(hollow.volume == Approx((1 - 1.0 / 64) / 6));
  CHECK(inWords(hollow) == "closed, 1 of 2 shells wound inwards, as only cavities should be");
  CHECK(inWords(factsOf(together(kTetrahedron, kTetrahedron, 2, 5))) == "closed, wound outwards");
}

TEST_CASE("triangles without area and triangles that are there again are counted") {
  MeshData mesh = kTetrahedron;
  mesh.indices.insert(mesh.indices.end(), {2, 1, 0, 3, 3, 1});
  const MeshFacts facts = factsOf(mesh);
  CHECK((facts.degenerate == 1 && facts.repeated == 1));
  CHECK(facts.isEven());
  CHECK(inWords(facts) == "closed, wound outwards; 1 triangle has no area; 1 triangle is there again");
  // A sheet seen from both sides: the same corners, wound both ways.
  const MeshData sheet{"", {0, 0, 1, 1, 0, 1, 0, 1, 1}, {0, 1, 2, 0, 2, 1}};
  CHECK(factsOf(sheet).repeated == 1);
  CHECK_THAT(inWords(factsOf(sheet)), Contains("encloses nothing"));
  const MeshData line{"", {1, 1, 1, 2, 2, 2, 4, 4, 4}, {0, 1, 2}};
  CHECK(factsOf(line).degenerate == 1);
  CHECK(factsOf(MeshData{}).shells == 0);
}

TEST_CASE("a box is in the numbers of the file, far from the origin, too, and of triangles alone") {
  const ScratchFolder folder;
  const FileMesh far = readWhole(
      folder.write("far.obj",
                   "v 512340.678 4512350.123 296.25\nv 512350.678 4512350.123 296.25\nv 512340.678 4512360.123 297.25\n"
                   "v 0 0 0\nf 1 2 3\n"));
  CHECK(far.base != std::array<double, 3>{});
  const Box box = boxOf(far);
  CHECK(box.low[1] == Approx(4512350.123).epsilon(0).margin(1e-6));
  CHECK(box.high[0] == Approx(512350.678).epsilon(0).margin(1e-6));
  CHECK(boxOf(far, {{1, 0, 0, -512340, 0, 1, 0, 0, 0, 0, 2, 1}}).high[2] == 2 * 297.25 + 1);
}

TEST_CASE("a file's content is what reading it whole and reading its nodes give") {
  const ScratchFolder folder;
  const std::string file = folder.write("two parts.obj",
                                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\np 1\no lid\nf 1 3 2\nf 1 2 4\n"
                                        "o box\nf 1 4 3\nf 2 3 4\n");
  std::vector<std::string> warnings, again;
  const FileContent content = readContent(file, warnings);
  CHECK(content.whole.positions == readMesh(file, again).positions);
  CHECK(warnings == again);  // once each
  CHECK(content.unit.empty());
  REQUIRE(content.assembly.parts.size() == 2);
  CHECK(content.assembly.parts[0].name == "lid");
  CHECK(factsOf(content.whole).isEven());
  CHECK(factsOf(content.assembly.meshes[1]).borderEdges == 4);
}
