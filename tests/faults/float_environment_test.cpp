// A host may round in any direction, flush subnormal numbers to zero, or trap on exceptions: answers keep their bits,
// and the host its environment.
#include <cfenv>
#include <cmath>
#include <functional>
#include <string>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "faults/scenario.h"
#include "gpu/submission.h"
#include "import/mesh_import.h"
#include "radar/cpu_sweeper.h"
#include "radar/host.h"
#include "radar/pool.h"
#include "support/catch.h"
#include "support/scratch_folder.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using test::sameBits;

struct Environment {
  const char* name;
  std::function<void()> set;
};

std::vector<Environment> environments() {
  std::vector<Environment> all{{"upwards", [] { std::fesetround(FE_UPWARD); }},
                               {"downwards", [] { std::fesetround(FE_DOWNWARD); }},
                               {"towards zero", [] { std::fesetround(FE_TOWARDZERO); }}};
#if defined(__SSE2__)
  all.push_back({"flushing to zero", [] { _mm_setcsr(_mm_getcsr() | 0x8040); }});  // FTZ and DAZ
#endif
#if defined(__GLIBC__)
  all.push_back({"trapping", [] {
                   std::feclearexcept(FE_ALL_EXCEPT);
                   feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW | FE_UNDERFLOW | FE_INEXACT);
                 }});
#endif
  return all;
}

// What this thread's environment is, by what it does.
std::string described() {
  std::string text = std::to_string(std::fegetround());
#if defined(__SSE2__)
  text += " " + std::to_string(_mm_getcsr() & ~0x3fu);
#endif
  return text;
}

/// Runs functions of the engine in an environment, which they must keep, and everything else in the default one.
class InEnvironment {
 public:
  explicit InEnvironment(const Environment& environment) : environment_(environment) {}
  template <class Work>
  auto operator()(const Work& work) const {
    const Entered entered(environment_);
    return work();
  }

 private:
  struct Entered {
    explicit Entered(const Environment& environment) {
      std::fegetenv(&before);
      environment.set();
      set = described();
    }
    ~Entered() {
      const std::string left = described();
      std::fesetenv(&before);
      CHECK(set == left);
    }
    std::fenv_t before;
    std::string set;
  };
  const Environment& environment_;
};

// A mesh whose coordinates are subnormal floats, and one that is far from its origin.
void addOddMeshes(Scene& scene) {
  constexpr float kTiny = 0x1p-140f;
  constexpr float small[] = {0, 0, 0, kTiny, 0, 0, 0, kTiny, 3 * kTiny};
  constexpr float far[] = {1e6f, 1e6f, 0, 1e6f + 1, 1e6f, 0, 1e6f, 1e6f + 1, 0.1f};
  const uint32_t triangle[] = {0, 1, 2};
  scene.addObject({.mesh = scene.addMesh(small, triangle), .worldFromMesh = {{1, 0, 0, 0.3, 0, 1, 0, 0, 0, 0, 1, 2}}});
  scene.addObject(
      {.mesh = scene.addMesh(far, triangle), .worldFromMesh = {{1, 0, 0, -1e6, 0, 1, 0, -1e6, 0, 0, 1, 5}}});
}

struct AllAnswers {
  Answers cpu, contact, recorded, pool;
  std::vector<Result> sampled;
  std::array<double, 3> point;
  std::string wrong;
};

// The answers of everything, all of it made in the environment.
AllAnswers answersIn(const InEnvironment& in) {
  const test::SceneEdits edits;
  Scene scene;
  in([&] { edits.make(scene); });
  in([&] { addOddMeshes(scene); });
  const std::vector<Query> queries = test::contactQueries(), drawn = test::sampledQueries(),
                           recorded = test::recordableQueries();
  AllAnswers answers;
  CpuSweeper cpu(scene);
  answers.cpu = in([&] { return cpu.run(queries); });
  const Device device = in([] { return Device::open(test::deviceOptions()); });
  CHECK(device.doubles() == test::device().doubles());
  for (const ArithmeticCheck& check : in([&] { return checkArithmetic(device); })) CHECK(check.passed());
  Sweeper sweeper = in([&] { return Sweeper(device, scene, {.cpuBatch = 0}); });
  answers.contact = in([&] { return sweeper.run(queries); });
  CHECK(answers.contact.stats.submissions > 0);
  answers.sampled = in([&] { return sweeper.run(drawn, Mode::sampled).results; });
  Recorder recorder = in([&] { return Recorder(device, scene, test::kScenarioRoom); });
  gpu::Submission submission(device.impl(), false);
  const gpu::Commands commands = submission.begin();
  in([&] { recorder.record(commands, recorded); });
  submission.submitAndWait();
  answers.recorded = in([&] { return recorder.read(); });
  std::vector<Device> devices;
  devices.push_back(in([&] { return Device::open(test::deviceOptions()); }));
  Scene posed;  // a pool reads no other than its own
  in([&] { edits.make(posed); });
  in([&] { addOddMeshes(posed); });
  const auto pool = in([&] { return std::make_unique<Pool>(devices, posed, SweeperOptions{.cpuBatch = 0}); });
  answers.pool = in([&] { return pool->submit(queries).get(); });
  const float vertex[] = {0.1f, 0.2f, 0.3f};
  const Transform pose{{0.4, -0.5, 0.6, 0.1, 0.7, 1.1, -1.2, 0.2, 1.3, 0.8, 0.9, 0.3}};
  answers.point = in([&] { return transformPoint(pose, vertex); });
  answers.wrong = in([&] { return validate(Transform{{1e-160, 0, 0, 0, 0, 1e-160, 0, 0, 0, 0, 1e-160, 0}}); });
  return answers;
}

}  // namespace

TEST_CASE("answers have the same bits whatever the floating-point environment of the calling thread, which keeps it") {
  const Environment usual{"the default", [] {}};
  const AllAnswers expected = answersIn(InEnvironment(usual));
  CHECK(expected.wrong.empty());
  for (const Environment& environment : environments()) {
    CAPTURE(environment.name);
    const AllAnswers found = answersIn(InEnvironment(environment));
    CHECK(sameBits(found.cpu, expected.cpu));
    CHECK(sameBits(found.contact, expected.contact));
    CHECK(sameBits(found.recorded, expected.recorded));
    CHECK(sameBits(found.pool, expected.pool));
    CHECK(sameBits({found.sampled, {}}, {expected.sampled, {}}));
    CHECK(found.point == expected.point);
    CHECK(found.wrong == expected.wrong);
  }
}

TEST_CASE(
    "numbers of mesh files are the nearest floats whatever the floating-point environment of the calling thread") {
  const test::ScratchFolder folder;
  const std::string file = folder.write("numbers.obj",
                                        "v 0.1 1.1754942e-38 8e-46\nv 16777217 0.3333333333333333333333 1e-40\n"
                                        "v 8388608.5 -0.7 123456789\nf 1 2 3\n");
  std::vector<std::string> warnings;
  const tools::MeshData expected = tools::readMesh(file, warnings);
  CHECK(expected.positions[2] == 0x1p-149f);
  for (const Environment& environment : environments()) {
    CAPTURE(environment.name);
    CHECK(InEnvironment(environment)([&] { return tools::readMesh(file, warnings).positions; }) == expected.positions);
  }
}
