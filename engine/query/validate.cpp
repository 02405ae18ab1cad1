// Validation of queries, and the initial values of a Result.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "math/float_environment.h"
#include "math/frame.h"
#include "math/number_text.h"
#include "query/hits.h"
#include "scene/scene.h"

namespace radar {

namespace {

// Lengths of directions up to this do not overflow, if they cannot be scaled exactly.
constexpr double kMostLength = 0x1p1023;

// Of turns, as of poses: products of a few of them do not overflow.
constexpr double kMostCentre = 0x1p800, kMostAngle = 0x1p16;

// Of the sensor's size or, if that is more, of the clearance: a larger slack would let shapes pass each other.
constexpr double kMostSlack = 0.1;

std::string validateTurn(const Query& query) {
  const Turn& turn = *query.turn;
  if (!std::isfinite(turn.angle) || std::abs(turn.angle) > kMostAngle) {
    return "expected a finite angle of at most 2^16, got " + textOf(turn.angle);
  }
  for (const double value : turn.axis) {
    if (!std::isfinite(value)) return "expected an axis of 3 finite numbers, got " + textOf(value);
  }
  if (turn.angle != 0 && turn.axis == Vector{}) return "expected an axis that is not zero";
  for (const double value : turn.centre) {
    if (!(std::abs(value) <= kMostCentre)) return "expected a centre up to 2^800, got " + textOf(value);
  }
  for (const double value : query.motion.value_or(Vector{})) {
    if (!(std::abs(value) <= kMostCentre)) return "expected a motion up to 2^800 beside it, got " + textOf(value);
  }
  if (query.ignoreLeaving && query.clearance > 0 && turn.angle != 0) {
    return "expected no ignoreLeaving beside it and a clearance";
  }
  return {};
}

// Checks where a query's sensor goes.
std::string validateCourse(const Query& query, const Scene::Impl& scene) {
  if (query.motion || query.turn) {
    const std::string name = query.turn ? "turn" : "motion";
    if (query.direction != std::array<double, 3>{} || query.distance != 0) {
      return name + ": expected no direction and no distance beside it";
    }
    if (query.turn) {
      if (std::string wrong = validateTurn(query); !wrong.empty()) return "turn: " + wrong;
    }
    const std::string wrong = validateMotion(query.motion.value_or(Vector{}));
    return wrong.empty() ? wrong : "motion: " + wrong;
  }
  double largest = 0;
  for (double value : query.direction) {
    if (!std::isfinite(value)) return "direction: expected 3 finite numbers, got " + textOf(value);
    largest = std::max(largest, std::abs(value));
  }
  if (largest == 0) return "direction: expected a vector that is not zero";
  if (largest >= kMostLength / 2 && !(lengthOf(scaledDirection(query.direction)) < kMostLength)) {
    return "direction: expected a length below 2^1023 beside a component below 2^-1020";
  }
  if (!std::isfinite(query.distance) || query.distance < 0) {
    return "distance: expected a finite number of 0 or more, got " + textOf(query.distance);
  }
  if (scene.moving > 0 && query.distance > kMostMotion) {
    return "distance: expected at most 2^1000 where objects move, got " + textOf(query.distance);
  }
  return {};
}

// Checks what else a query asks of a cutter.
std::string validateCutter(const Query& query, Mode mode) {
  if (std::string wrong = validateRigid(query.worldFromMesh); !wrong.empty()) return "sensor: a cutter: " + wrong;
  for (const auto& [name, isGiven] :
       {std::pair{"turn", query.turn.has_value()}, std::pair{"ignoreLeaving", query.ignoreLeaving},
        std::pair{"skipOverlapping", query.skipOverlapping}, std::pair{"closest", query.closest},
        std::pair{"exit", query.exit}}) {
    if (isGiven) return name + std::string(": expected none with a cutter");
  }
  return mode == Mode::sampled ? "mode: expected contact with a cutter, got sampled" : "";
}

}  // namespace

std::string validate(const Query& query, const Scene& scene, Mode mode) {
  const FloatEnvironment floats;
  if (!scene.hasMesh(query.mesh)) return "sensor: mesh " + std::to_string(query.mesh) + " does not exist";
  if (std::string wrong = validate(query.worldFromMesh); !wrong.empty()) return "sensor: " + wrong;
  if (std::string wrong = validateCourse(query, scene.impl()); !wrong.empty()) return wrong;
  if (!scene.impl().meshes[query.mesh].parts.empty()) {
    if (std::string wrong = validateCutter(query, mode); !wrong.empty()) return wrong;
  }
  for (ObjectId object : query.exclude) {
    if (!scene.hasObject(object)) return "exclude: object " + std::to_string(object) + " does not exist";
  }
  if (query.slack && !(std::isfinite(*query.slack) && *query.slack >= 0)) {
    return "slack: expected a finite number of 0 or more, got " + textOf(*query.slack);
  }
  if (query.slack && *query.slack > 0) {
    const Box box = boxOf(scene.impl().meshes[query.mesh], query.worldFromMesh.m);
    const double size =
        std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2], query.clearance});
    // A bare point has no size to compare with.
    if (size > 0 && *query.slack > kMostSlack * size) {
      return "slack: expected at most a tenth of the sensor's size or of the clearance, the greater of which is " +
             textOf(static_cast<float>(size)) + ", got " + textOf(*query.slack);
    }
  }
  if (!std::isfinite(query.clearance) || query.clearance < 0) {
    return "clearance: expected a finite number of 0 or more, got " + textOf(query.clearance);
  }
  if (query.tolerance && !(std::isfinite(*query.tolerance) && *query.tolerance >= 0)) {
    return "tolerance: expected a finite number of 0 or more, got " + textOf(*query.tolerance);
  }
  if (query.hits == 0) return "hits: expected 1 or more, got 0";
  if (query.hits > 1 && query.anyHit) return "hits: expected 1 with anyHit, got " + std::to_string(query.hits);
  if ((query.closest || query.exit) && (query.turn || query.ignoreLeaving)) {
    return std::string(query.closest ? "closest" : "exit") + ": expected neither a turn nor ignoreLeaving beside it";
  }
  if (mode == Mode::sampled && (query.ignoreLeaving || query.clearance > 0 || hasLists(query))) {
    return "mode: expected contact with ignoreLeaving, skipOverlapping, clearance, closest, exit or several hits, got "
           "sampled";
  }
  if (mode == Mode::sampled && isStep(query, scene.impl())) {
    return "mode: expected contact with a motion, of the query or of objects, got sampled";
  }
  if (query.resolution > kMaxResolution) {
    return "resolution: expected 0 to " + std::to_string(kMaxResolution) + ", got " + std::to_string(query.resolution);
  }
  return {};
}

Result::Result() {
  t = lo = hi = fraction = gap = paperMinL = std::numeric_limits<double>::quiet_NaN();
  point.fill(std::numeric_limits<double>::quiet_NaN());
  normal.fill(std::numeric_limits<double>::quiet_NaN());
}

Result::Result(Status noContact) : Result() {
  status = noContact;
  if (status != Status::clear && status != Status::undecided) return;
  t = lo = hi = fraction = std::numeric_limits<double>::infinity();
}

}  // namespace radar
