// The soak by command: random edits, batches, devices, recorders and faults, each answer checked. Exit status 1 if
// anything was wrong.
#include <chrono>
#include <cmath>
#include <cstdio>

#include "command/command.h"
#include "commit/commit.h"
#include "embed/host.h"
#include "faults/host_memory.h"
#include "soak/answerers.h"
#include "soak/memory.h"
#include "soak/moved_answerers.h"
#include "support/resident.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using namespace radar::soak;

constexpr uint64_t kMostWrong = 20;

/// All tested devices that are usable, each twice: what one thread uses, and what the pool does, which has at least
/// two.
struct Hosts {
  Hosts() {
    const std::vector<DeviceReport> reports = listDevices();
    const std::vector<uint32_t>& tested = test::testedDevices();
    for (uint32_t i = 0; i < tested.size(); ++i) {
      const DeviceReport& report = reports[tested[i]];
      if (!report.usable()) continue;
      const Mode mode = report.sampledReasons.empty() ? Mode::sampled : Mode::contact;
      std::printf("device %s, driver %s\n", report.name.c_str(), report.driver.c_str());
      single.push_back(std::make_unique<test::Host>(mode, i));
      pooled.push_back(std::make_unique<test::Host>(mode, i));
    }
    if (single.empty()) throw Error("no device is usable");
    if (pooled.size() == 1) pooled.push_back(std::make_unique<test::Host>());
  }
  std::vector<std::unique_ptr<test::Host>> single, pooled;
};

/// Devices made from the hosts': for one thread, and for a pool.
struct Devices {
  Devices(const Hosts& hosts, uint64_t epoch, tools::Random& random)
      : doubles(!random.oneIn(4)), single(adopt(*hosts.single[epoch % hosts.single.size()])) {
    for (const auto& host : hosts.pooled) pooled.push_back(adopt(*host));
  }
  Device adopt(const test::Host& host) const {
    HostDevice handles = host.withoutMemory();
    handles.doubles = handles.doubles && doubles;
    return Device::adopt(handles);
  }
  bool doubles;
  Device single;
  std::vector<Device> pooled;
};

struct Options {
  double minutes = 0;
  uint64_t rounds = 0, seed = 1, first = 0;
  uint64_t ofScene = 20, ofEpoch = 200;
  std::string ownLengths() const {
    return " --scene-rounds " + std::to_string(ofScene) + " --epoch-rounds " + std::to_string(ofEpoch);
  }
};

class Soak {
 public:
  explicit Soak(const Options& options) : options_(options), start_(Clock::now()), line_(start_) {}

  int run() {
    std::printf("commit %s, seed %llu\n", tools::commit(), number(options_.seed));
    for (uint64_t epoch = options_.first; goesOn(); ++epoch) {
      {
        const test::EngineWork counting;
        runEpoch(epoch);
      }
      ++tally_.epochs;
      left_.push_back(leftNow());
    }
    printLine();
    return summary();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static unsigned long long number(uint64_t value) { return value; }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool goesOn() const {
    if (tally_.wrong >= kMostWrong) return false;
    return options_.rounds > 0 ? tally_.rounds < options_.rounds : seconds() < 60 * options_.minutes;
  }

  /// Makes devices, and then one scene after the other. Only the hosts' VkDevices are older.
  void runEpoch(uint64_t epoch) {
    tools::Random random(options_.seed * 1'000'003 + epoch);
    std::string what = "setting up";
    uint64_t round = 0;
    try {
      const Devices devices(hosts_, epoch, random);
      while (round < options_.ofEpoch && goesOn()) {
        tools::Random own(options_.seed * 1'000'033 + epoch * 1'009 + round);
        if (own.oneIn(4)) {
          what = "a host's geometry";
          MovedAnswerers moved(devices.single, own, tally_);
          runScene(moved, round);
        } else {
          what = "making a scene";
          const std::unique_ptr<World> world = own.oneIn(4) ? makeWildWorld(own) : makeHardWorld(own);
          what = world->name();
          Answerers answerers(devices.single, devices.pooled, *world, own, tally_);
          runScene(answerers, round);
        }
      }
    } catch (const std::exception& error) {
      const test::OthersWork others;
      ++tally_.wrong;
      std::printf("WRONG: epoch %llu, %s, round %llu: %s; --seed %llu --first-epoch %llu --rounds %llu%s\n",
                  number(epoch), what.c_str(), number(round), error.what(), number(options_.seed), number(epoch),
                  number(round), options_.ownLengths().c_str());
    }
  }

  template <class Answering>
  void runScene(Answering& answering, uint64_t& round) {
    for (uint64_t i = 0; i < options_.ofScene && round < options_.ofEpoch && goesOn(); ++i) {
      ++round;
      oneRound(answering);
    }
  }

  template <class Answering>
  void oneRound(Answering& answering) {
    ++tally_.rounds;
    answering.round();
    const test::OthersWork others;
    for (const std::string& message : test::takeValidationMessages()) throw std::logic_error("validation: " + message);
    if (options_.rounds == 0 && Clock::now() - line_ > std::chrono::minutes(1)) printLine();
  }

  void printLine() {
    line_ = Clock::now();
    std::printf("%6.1f min: %llu answers, %llu wrong, faults:", seconds() / 60, number(tally_.allAnswers()),
                number(tally_.wrong));
    for (size_t i = 0; i < kFaults.size(); ++i) std::printf(" %s %llu,", kFaults[i], number(tally_.faults[i]));
    std::printf(" resident %zu MiB\n", test::residentBytes() >> 20);
    std::fflush(stdout);
  }

  int summary() const {
    std::printf("%llu epochs, %llu rounds, %.0f s\n", number(tally_.epochs), number(tally_.rounds), seconds());
    for (size_t i = 0; i < kWho.size(); ++i) {
      std::printf("%12llu  %-18s %8.1f s\n", number(tally_.answers[i]), kWho[i], tally_.seconds[i]);
    }
    std::printf("%12llu  answers in all (%.0f a second)\n", number(tally_.allAnswers()),
                static_cast<double>(tally_.allAnswers()) / seconds());
    std::printf("%12llu  of them invalid because of a fault\n", number(tally_.invalid));
    std::printf("%12llu  recordings with a limit that was too small\n", number(tally_.limited));
    std::printf("%12llu  faults\n%12llu  wrong\n", number(tally_.allFaults()), number(tally_.wrong));
    const Medians medians = mediansOf(left_);
    if (left_.size() >= kEpochsToJudge) {
      std::printf("resident after an epoch: %zu MiB in the second quarter, %zu MiB in the last\n", medians.second >> 20,
                  medians.last >> 20);
    }
    const std::string leak = leakIn(left_);
    std::printf("%s\n", leak.empty() ? "no leak" : ("LEAK: " + leak).c_str());
    return tally_.wrong == 0 && leak.empty() ? 0 : 1;
  }

  Options options_;
  Clock::time_point start_, line_;
  Hosts hosts_;
  Tally tally_;
  std::vector<Left> left_;
};

}  // namespace

int main(int argc, char** argv) try {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  radar::tools::Program program("radar_soak",
                                "Random edits, batches, devices, recorders and faults: every answer is checked");
  Options options;
  const auto minutes = program.option("--minutes", &options.minutes, "How long").within(0.001, HUGE_VAL);
  const auto rounds = program.option("--rounds", &options.rounds, "Or how many rounds").within(1, HUGE_VAL);
  program.option("--seed", &options.seed, "Another seed, other scenes");
  program.option("--first-epoch", &options.first, "To ask one again");
  program.option("--scene-rounds", &options.ofScene, "Rounds with one scene").within(1, HUGE_VAL);
  program.option("--epoch-rounds", &options.ofEpoch, "Rounds with the same devices").within(1, HUGE_VAL);
  if (const std::optional<int> ended = program.parse(argc, argv)) return *ended;
  if (minutes.given() == rounds.given()) throw std::invalid_argument("expected either --minutes or --rounds");
  return Soak(options).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_soak: %s\n", error.what());
  return 2;
}
