// Checks of poses and motions.
#include <cmath>

#include "math/float_environment.h"
#include "math/number_text.h"
#include "scene/scene.h"

namespace radar {

namespace {

// Vertices that poses up to this place do not overflow, nor do differences of such vertices.
constexpr double kMostPose = 0x1p800;

}  // namespace

// Columns of length 1 make rows of at most sqrt(3), so the scaled determinant loses at most a factor of 5.2.
bool isSurelyValid(const Transform& pose) {
  double squares = 1;
  for (int k = 0; k < 3; ++k) {
    squares *= pose.m[k] * pose.m[k] + pose.m[4 + k] * pose.m[4 + k] + pose.m[8 + k] * pose.m[8 + k];
  }
  const double volume = determinant(pose);
  const double position = std::abs(pose.m[3]) + std::abs(pose.m[7]) + std::abs(pose.m[11]);
  return squares > 1e-250 && squares < 1e250 && volume * volume > 1e-20 * squares && position <= kMostPose;
}

std::string validate(const Transform& pose) {
  const FloatEnvironment floats;
  if (isSurelyValid(pose)) return {};
  for (double value : pose.m) {
    if (!(std::abs(value) <= kMostPose)) {
      return "expected 12 finite numbers of at most 2^800, got " + textOf(value);
    }
  }
  // Columns, then rows are scaled to length 1, so that a scale of 1e-5 along one axis does not look singular.
  Transform scaled = pose;
  for (int k = 0; k < 3; ++k) {
    const double length = std::hypot(pose.m[k], pose.m[4 + k], pose.m[8 + k]);
    if (length == 0) return "expected an invertible matrix, got a singular one, with a zero column";
    for (int i = 0; i < 3; ++i) scaled.m[4 * i + k] /= length;
  }
  for (int i = 0; i < 3; ++i) {
    double* r = &scaled.m[4 * i];
    const double length = std::hypot(r[0], r[1], r[2]);
    if (length == 0) return "expected an invertible matrix, got a singular one, with a zero row";
    for (int k = 0; k < 3; ++k) r[k] /= length;
  }
  if (std::abs(determinant(scaled)) < 1e-12) return "expected an invertible matrix, got a singular one";
  return {};
}

std::string validateRigid(const Transform& pose) {
  constexpr double kRigid = 1e-6;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double sum = pose.m[i] * pose.m[k] + pose.m[4 + i] * pose.m[4 + k] + pose.m[8 + i] * pose.m[8 + k];
      if (!(std::abs(sum - (i == k ? 1 : 0)) <= kRigid)) {
        return "expected a rigid pose: the products of its columns differ from 0 and 1 by at most 1e-6, got " +
               textOf(sum) + " of columns " + std::to_string(i) + " and " + std::to_string(k);
      }
    }
  }
  return {};
}

std::string validateMotion(const std::array<double, 3>& motion) {
  for (double value : motion) {
    if (!(std::abs(value) <= kMostMotion)) {
      return "expected 3 finite numbers of at most 2^1000, got " + textOf(value);
    }
  }
  return {};
}

}  // namespace radar
