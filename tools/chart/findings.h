// What a run shows: the front of speed against accuracy, crossings, slopes, in numbers and in words.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "chart/record.h"

namespace radar::tools {

/// Errors below this, in sizes of the sensor, are drawn at it and count as equal.
inline constexpr double kErrorFloor = 1e-13;

inline constexpr std::array kOurFamilies{"sampled", "drawing all", "contact", "contact on device", "reference"};
/// Whether the method is Cyber Radar's, not another library's.
bool isOurs(const std::string& family);

/// The worst error, at least kErrorFloor.
double flooredError(const Cell& cell);

/// Share of answers that are wrong: a contact missed, or told where there is none.
double wrongShare(const Cell& cell);

/// The cells of a workload that have numbers, each method once: in the number of threads in which it was fastest.
std::vector<const Cell*> shownCells(const Record& record, const std::string& section, const std::string& workload);
/// Those that have none.
std::vector<const Cell*> failedCells(const Record& record, const std::string& section, const std::string& workload);

/// What frontOf does, for readers.
inline constexpr const char* kFrontInWords =
    "The front holds the methods that no other method beats in both speed and accuracy. A wrong answer outweighs any "
    "error: fewer wrong answers rank first, then the smaller worst error.";

/// Those to which no other is both as fast and as right, by rising time. Fewer wrong answers are better; of equal
/// shares, a lesser worst error, down to kErrorFloor.
std::vector<const Cell*> frontOf(std::span<const Cell* const> cells);

/// Whether the method looks at pixels, rays or steps only, and so sees samples of the shapes or of the motion.
bool isSampling(const Cell& cell);

/// Mode contact beside the methods that sample, not beside other certain ones.
struct BesideSampling {
  const Cell* contact = nullptr;  ///< null: not measured
  const Cell* better = nullptr;   ///< of those as fast and as right, the fastest; null: mode contact is on the front
};
BesideSampling besideSampling(std::span<const Cell* const> cells);

struct Point {
  double x = 0, y = 0;
};
/// The exponent p of the power law y = c x^p that fits best, by least squares of logarithms. At least two different x.
double slopeOf(std::span<const Point> points);

/// Where the first line crosses below the second for good, linear between the points; both over the same x. Nothing
/// where it does not, or is below from the start.
std::optional<double> crossing(std::span<const Point> first, std::span<const Point> second);

/// The methods of a workload that have numbers, in the order of the record.
std::vector<std::string> methodsOf(const Record& record, const std::string& section, const std::string& workload);

/// The times of one method over x, as of shownCells. `method`: Cell::method.
std::vector<Point> timesOver(const Record& record, const std::string& section, const std::string& workload,
                             const std::string& method);

/// Three digits, or whole; a dash where there is no number.
std::string inWords(double value);
/// "5.27 µs".
std::string timeInWords(double us);
/// The names of methods in a row, a family's members as one: "sampled 16/64/1024".
std::vector<std::string> namesOf(const std::vector<const Cell*>& cells);

/// The fastest method of a workload without a wrong answer, and mode contact beside it: one sentence, empty without
/// mode contact.
std::string fastestRight(const Record& record, const std::string& workload);
/// One sentence each.
std::vector<std::string> table1Findings(const Record& record);
std::vector<std::string> growthFindings(const Record& record);

/// The least time of Table 1 in the paper, and its greatest: for 10,000 and 30,000 boxes, milliseconds.
struct PaperRow {
  double boxes, cyberRadar, opcode;
};
std::span<const PaperRow> paperTable1();

}  // namespace radar::tools
