// What a run shows: the front of accuracy against speed, and how times grow, in numbers and in words.
#pragma once

#include <array>
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

/// Share of answers that are wrong: a contact missed, or reported where there is none.
double wrongShare(const Cell& cell);

/// The cells of a workload that have numbers, each method once: in the number of threads in which it was fastest.
std::vector<const Cell*> shownCells(const Record& record, const std::string& section, const std::string& workload);

/// What frontOf does, for readers.
inline constexpr const char* kFrontInWords =
    "The front holds the methods that no other method beats in both speed and accuracy. A wrong answer outweighs any "
    "error: fewer wrong answers rank first, then the smaller worst error.";

/// Those to which no other is both as fast and as right, by rising time. Fewer wrong answers are better; of equal
/// shares, a lesser worst error, down to kErrorFloor.
std::vector<const Cell*> frontOf(std::span<const Cell* const> cells);

/// Whether mode contact is on the front beside the methods that sample pixels, rays or steps of the motion.
bool isContactOnFrontBesideSampling(std::span<const Cell* const> cells);

struct Point {
  double x = 0, y = 0;
};
/// The exponent p of the power law y = c x^p that fits best, by least squares of logarithms. At least two different x.
double slopeOf(std::span<const Point> points);

/// The times of one method over x.
struct Series {
  const Cell* first = nullptr;
  std::vector<Point> times;
};
/// A series for each method of shownCells(), in that order.
std::vector<Series> seriesOf(const Record& record, const std::string& section, const std::string& workload);
/// Those of mode contact; empty: it was not measured.
std::vector<Point> contactTimes(const Record& record, const std::string& section, const std::string& workload);

/// Three digits, or whole; a dash where there is no number.
std::string inWords(double value);
/// "5.27 µs".
std::string timeInWords(double us);

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
