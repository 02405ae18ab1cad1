// Where several pairs of triangles meet first, answers of the device have the CPU's normals, also in a recording.
#include "embed/on_device.h"
#include "embed/renderer.h"
#include "unit/normal_scenes.h"

using namespace radar;
using normals::Case;
using test::sameBits;

namespace {

/// Asks a device, a recording and the CPU, and judges the answers.
template <class Fill>
normals::Judged judged(int cases, const Fill& fill) {
  normals::Judged all;
  test::Renderer renderer(test::device());
  for (int i = 0; i < cases; ++i) {
    soups::Random random(5000 + static_cast<uint64_t>(i));
    Case one;
    fill(random, one);
    Sweeper onDevice(test::device(), one.scene, {.cpuBatch = 0}), onCpu(test::device(), one.scene, {.cpuBatch = 1000});
    Recorder recorder(test::device(), one.scene, {.queries = 8});
    const std::vector<Result> cpu = onCpu.run(one.queries).results, device = onDevice.run(one.queries).results;
    renderer.record(recorder, one.queries);
    renderer.submitAndWait();
    const std::vector<Result> read = recorder.read().results;
    for (size_t q = 0; q < one.queries.size(); ++q) {
      CAPTURE(i, q);
      CHECK(sameBits(device[q], cpu[q]));
      CHECK(sameBits(read[q], cpu[q]));
      test::checkShaderResult(renderer.shaderResult(q), cpu[q]);  // as it is or unresolved, before it is read
      all.add(one.scene, one.queries[q], device[q]);
    }
  }
  return all;
}

}  // namespace

TEST_CASE("boxes on a lattice and on one floor have the CPU's normals on the device, which keep surfaces apart") {
  const bool onFloor = GENERATE(false, true);
  const normals::Judged all =
      judged(60, [&](soups::Random& random, Case& out) { normals::boxes(random, onFloor, out); });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 50);
}

TEST_CASE("triangles on a lattice and in one plane have the CPU's normals on the device, which keep surfaces apart") {
  const bool isFlat = GENERATE(false, true);
  const normals::Judged all =
      judged(80, [&](soups::Random& random, Case& out) { normals::lattices(random, isFlat, out); });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 50);
}

TEST_CASE("soups, needles and fans have the CPU's normals on the device, which keep surfaces apart") {
  const double stretch = GENERATE(0.0, 1.0, 1e4, 1e8);  // 0: fans
  CAPTURE(stretch);
  const normals::Judged all = judged(60, [&](soups::Random& random, Case& out) {
    stretch > 0 ? normals::floats(random, stretch, out) : normals::meetings(random, out);
  });
  INFO(all.words());
  CHECK(all.faults.empty());
  CHECK(all.hits > 20);
}
