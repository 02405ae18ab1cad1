// The paper's teapots in flight, all at once, for one step: whoever touches something stays there. Contacts are
// predicted while all move; then they happen.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radar/radar.h"
#include "workloads/workload.h"

namespace radar::tools {

/// One that flies. Times are fractions of the step.
struct Flyer {
  ObjectId object = kNone;
  uint32_t mesh = kNone;
  Transform start;
  std::array<double, 3> way{};  ///< during the whole step
  double stops = 1;
  Result contact;  ///< where it stays; invalid if it flies to the end
  /// Whether surfaces are apart just before the contact, and not just after it.
  bool isVerified = false;
  Transform poseAt(double time) const;
};

/// What is expected from a time on, until the next forecast; by flyer. Those that have stopped stay as they are.
struct Forecast {
  double from = 0;
  std::vector<double> stops;  ///< infinite: not during the step
  std::vector<Result> contacts;
};

struct Flight {
  Workload workload;  ///< one scene: what rests, then what flies
  std::vector<Flyer> flyers;
  std::vector<Forecast> forecasts;
};

Flight fly();

/// A line for each flyer.
std::string tableOf(const Flight& flight);

/// Draws the flight, picture by picture into `frames` and all of them into `film`.
void drawFlight(const Flight& flight, const Device& device, const std::filesystem::path& frames,
                const std::filesystem::path& film);

}  // namespace radar::tools
