// In what a device's answer differs from the CPU's.
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>

#include "proof/checks.h"

namespace radar {

namespace {

std::string nameOf(Status status) {
#define RADAR_NAME(name, value) \
  if (status == Status::name) return #name;
  RADAR_STATUSES(RADAR_NAME)
#undef RADAR_NAME
  return std::to_string(static_cast<uint32_t>(status)) + ", which is none";
}

std::string wordsOf(uint32_t number) {
  return number == kNone ? "none" : std::to_string(number);
}

// Doubles that follow each other have numbers that do.
int64_t placeOf(double x) {
  const auto bits = std::bit_cast<int64_t>(x);
  return bits < 0 ? std::numeric_limits<int64_t>::min() - bits : bits;
}

uint64_t ulpsBetween(double x, double y) {
  const int64_t p = placeOf(x), q = placeOf(y);
  return p < q ? static_cast<uint64_t>(q) - static_cast<uint64_t>(p)
               : static_cast<uint64_t>(p) - static_cast<uint64_t>(q);
}

class Comparison {
 public:
  void add(const char* name, uint32_t found, uint32_t exact) {
    if (found != exact) tell(name, wordsOf(found), wordsOf(exact));
  }
  void add(const char* name, double found, double exact) {
    const uint64_t bits = std::bit_cast<uint64_t>(found) ^ std::bit_cast<uint64_t>(exact);
    if (bits == 0) return;
    char text[40];
    const auto words = [&](double x) {
      std::snprintf(text, sizeof text, "%.17g", x);
      return std::string(text);
    };
    tell(name, words(found), words(exact));
    std::snprintf(text, sizeof text, " (bits 0x%" PRIx64, bits);
    numbers_ += text;
    if (!std::isnan(found) && !std::isnan(exact)) numbers_ += ", " + std::to_string(ulpsBetween(found, exact)) + " ulp";
    numbers_ += ")";
  }
  void tell(const char* name, const std::string& found, const std::string& exact) {
    numbers_ += (numbers_.empty() ? "" : "; ") + std::string(name) + " " + found + ", expected " + exact;
  }
  const std::string& numbers() const { return numbers_; }

 private:
  std::string numbers_;
};

}  // namespace

std::string nameOf(Stage stage, bool places) {
  switch (stage) {
    case Stage::none:
      return "";
    case Stage::describing:
      return places ? "placing or describing" : "describing";
    case Stage::solving:
      return places ? "placing or solving" : "solving";
    case Stage::searching:
      break;
  }
  return places ? "placing, searching or solving" : "searching or solving";
}

AnswerDifference differenceOf(const Result& found, const Result& exact) {
  Comparison all;
  Stage stage = Stage::none;
  const auto end = [&](Stage of) {
    if (stage == Stage::none && !all.numbers().empty()) stage = of;
  };
  if (found.status != exact.status) all.tell("status", nameOf(found.status), nameOf(exact.status));
  all.add("detected", static_cast<uint32_t>(found.detected), static_cast<uint32_t>(exact.detected));
  all.add("resolution", found.resolution, exact.resolution);
  all.add("flags", found.flags, exact.flags);
  all.add("object", found.object, exact.object);
  all.add("triB", found.triB, exact.triB);
  all.add("triA", found.triA, exact.triA);
  end(Stage::searching);
  all.add("featureB", static_cast<uint32_t>(found.featureB), static_cast<uint32_t>(exact.featureB));
  all.add("featureA", static_cast<uint32_t>(found.featureA), static_cast<uint32_t>(exact.featureA));
  end(Stage::solving);
  all.add("t", found.t, exact.t);
  all.add("lo", found.lo, exact.lo);
  all.add("hi", found.hi, exact.hi);
  all.add("fraction", found.fraction, exact.fraction);
  const char* const points[] = {"point x", "point y", "point z"};
  const char* const normals[] = {"normal x", "normal y", "normal z"};
  for (size_t k = 0; k < 3; ++k) all.add(points[k], found.point[k], exact.point[k]);
  for (size_t k = 0; k < 3; ++k) all.add(normals[k], found.normal[k], exact.normal[k]);
  all.add("gap", found.gap, exact.gap);
  all.add("paperMinL", found.paperMinL, exact.paperMinL);
  end(Stage::describing);
  return {stage, all.numbers()};
}

}  // namespace radar
