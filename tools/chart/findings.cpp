#include "chart/findings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/print.h"

namespace radar::tools {

namespace {

constexpr std::array kPaper{PaperRow{10'000, 14.73, 11.27}, PaperRow{30'000, 31.52, 85.48}};

std::pair<double, double> rankOf(const Cell& cell) {
  return {wrongShare(cell), flooredError(cell)};
}

const Cell* methodIn(const std::vector<const Cell*>& cells, const std::string& method) {
  const auto found = std::find_if(cells.begin(), cells.end(), [&](const Cell* cell) { return cell->method == method; });
  return found == cells.end() ? nullptr : *found;
}

}  // namespace

bool isOurs(const std::string& family) {
  return std::find(kOurFamilies.begin(), kOurFamilies.end(), family) != kOurFamilies.end();
}

double flooredError(const Cell& cell) {
  return std::isnan(cell.errorWorst) ? kErrorFloor : std::max(cell.errorWorst, kErrorFloor);
}

double wrongShare(const Cell& cell) {
  return static_cast<double>(cell.misses + cell.falseHits) / cell.queries;
}

std::vector<const Cell*> shownCells(const Record& record, const std::string& section, const std::string& workload) {
  std::vector<const Cell*> cells;
  for (const Cell& cell : record.cells) {
    if (cell.section != section || cell.workload != workload || !cell.failed.empty()) continue;
    const auto same = std::find_if(cells.begin(), cells.end(), [&](const Cell* other) {
      return other->method == cell.method && other->x == cell.x;
    });
    if (same == cells.end()) {
      cells.push_back(&cell);
    } else if (cell.us < (*same)->us) {
      *same = &cell;
    }
  }
  return cells;
}

std::vector<const Cell*> frontOf(std::span<const Cell* const> cells) {
  std::vector<const Cell*> sorted(cells.begin(), cells.end()), front;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Cell* a, const Cell* b) {
    return std::pair(a->us, rankOf(*a)) < std::pair(b->us, rankOf(*b));
  });
  for (const Cell* cell : sorted) {
    if (front.empty() || rankOf(*cell) < rankOf(*front.back())) front.push_back(cell);
  }
  return front;
}

bool isContactOnFrontBesideSampling(std::span<const Cell* const> cells) {
  std::vector<const Cell*> compared;
  for (const Cell* cell : cells) {
    const std::string& family = cell->family;
    const bool samples = family == "sampled" || family.starts_with("Embree") || family.ends_with("steps");
    if (samples || family == "contact") compared.push_back(cell);
  }
  return methodIn(frontOf(compared), "contact") != nullptr;
}

double slopeOf(std::span<const Point> points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const Point& point : points) {
    const double u = std::log(point.x), v = std::log(point.y);
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  const auto n = static_cast<double>(points.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

std::vector<Series> seriesOf(const Record& record, const std::string& section, const std::string& workload) {
  std::vector<Series> all;
  for (const Cell* cell : shownCells(record, section, workload)) {
    auto series =
        std::find_if(all.begin(), all.end(), [&](const Series& one) { return one.first->method == cell->method; });
    if (series == all.end()) series = all.insert(series, {cell, {}});
    series->times.push_back({cell->x, cell->us});
  }
  return all;
}

std::vector<Point> contactTimes(const Record& record, const std::string& section, const std::string& workload) {
  for (const Series& series : seriesOf(record, section, workload)) {
    if (series.first->method == "contact") return series.times;
  }
  return {};
}

std::string inWords(double value) {
  return std::isnan(value) ? "-" : print(value < 1000 ? "%.3g" : "%.0f", value);
}

std::string timeInWords(double us) {
  return us < 1000 ? inWords(us) + " µs" : inWords(us / 1000) + " ms";
}

std::string fastestRight(const Record& record, const std::string& workload) {
  const std::vector<const Cell*> cells = shownCells(record, "front", workload);
  const Cell* contact = methodIn(cells, "contact");
  if (contact == nullptr) return "";
  const Cell* fastest = nullptr;
  for (const Cell* cell : cells) {
    if (wrongShare(*cell) == 0 && (fastest == nullptr || cell->us < fastest->us)) fastest = cell;
  }
  if (fastest == nullptr) return "No method answers every query correctly.";
  const std::string text = "Fastest without a wrong answer: " + fastest->method + ", " + timeInWords(fastest->us);
  return fastest == contact ? text + "." : text + " (contact: " + timeInWords(contact->us) + ").";
}

std::vector<std::string> table1Findings(const Record& record) {
  std::vector<std::string> findings;
  const std::vector<Point> contact = contactTimes(record, "table1", "boxes");
  if (contact.size() < 2) return findings;
  const Point &few = contact.front(), &many = contact.back();
  findings.push_back("Mode contact takes " + timeInWords(few.y) + " per query among " + grouped(few.x) + " boxes and " +
                     timeInWords(many.y) + " among " + grouped(many.x) +
                     print(": %.2f times as long.", many.y / few.y));
  const PaperRow &first = kPaper.front(), &last = kPaper.back();
  findings.push_back(print(
      "On the paper's machine, its Cyber Radar took %.2f ms and then %.2f ms (%.2f times as long), OPCODE %.2f ms "
      "and then %.2f ms (%.2f times): Cyber Radar was faster only among many boxes.",
      first.cyberRadar, last.cyberRadar, last.cyberRadar / first.cyberRadar, first.opcode, last.opcode,
      last.opcode / first.opcode));
  return findings;
}

std::vector<std::string> growthFindings(const Record& record) {
  std::vector<std::string> findings;
  for (const char* axis : {"boxes", "sensors", "triangles"}) {
    const std::vector<Point> points = contactTimes(record, "growth", axis);
    if (points.size() < 2) continue;
    findings.push_back("From " + grouped(points.front().x) + " to " + grouped(points.back().x) + " " + axis +
                       ", mode contact goes from " + timeInWords(points.front().y) + " to " +
                       timeInWords(points.back().y) + " per query (" + axis + print("^%.2f).", slopeOf(points)));
  }
  return findings;
}

std::span<const PaperRow> paperTable1() {
  return kPaper;
}

}  // namespace radar::tools
