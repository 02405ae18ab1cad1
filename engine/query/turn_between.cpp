// A turn from two poses.
#include <algorithm>
#include <cmath>

#include "math/float_environment.h"
#include "math/frame.h"
#include "math/number_text.h"
#include "math/rounding.h"
#include "radar/displacement.h"

namespace radar {

namespace {

using Matrix = std::array<Vector, 3>;  // rows

constexpr double kMostDeviation = 0x1p-20, kMostPlace = 0x1p800;

[[noreturn]] void refuse(const std::string& what) {
  throw Error("turnBetween: " + what);
}

Vector columnOf(const Transform& pose, size_t k) {
  return {pose.m[k], pose.m[4 + k], pose.m[8 + k]};
}

double volumeOf(const Matrix& rows) {
  return dot(rows[0], cross(rows[1], rows[2]));
}

/// By how much such rows are not of length 1 and at right angles; NaN if numbers overflow.
double deviationOf(const Matrix& rows) {
  double worst = 0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      const double off = std::abs(dot(rows[i], rows[j]) - (i == j ? 1 : 0));
      if (!(off <= worst)) worst = off;
    }
  }
  return worst;
}

/// What the start's linear part is multiplied by to be the end's, less the identity, so that a small turn loses nothing
/// and equal poses give zeros.
Matrix changeBetween(const Transform& start, const Transform& end) {
  Matrix from, change;  // columns of both by one factor each
  for (size_t k = 0; k < 3; ++k) {
    from[k] = columnOf(start, k);
    change[k] = minus(columnOf(end, k), from[k]);
    const int exponent = std::ilogb(largest(from[k]));
    for (double& value : from[k]) value = std::scalbn(value, -exponent);
    for (double& value : change[k]) value = std::scalbn(value, -exponent);
  }
  const double volume = volumeOf(from);
  Matrix out{};
  for (size_t k = 0; k < 3; ++k) {
    const Vector inverse = scaled(1 / volume, cross(from[(k + 1) % 3], from[(k + 2) % 3]));
    for (size_t i = 0; i < 3; ++i) out[i] = along(out[i], change[k][i], inverse);
  }
  return out;
}

/// cos(angle/2), not negative, and sin(angle/2) times the axis, of the identity plus this. S. W. Shepperd, "Quaternion
/// from Rotation Matrix" (1978): by the largest of the four, so that neither small turns nor large ones lose digits.
std::pair<double, Vector> halfTurned(const Matrix& change) {
  const double squares[] = {change[0][0] - change[1][1] - change[2][2], change[1][1] - change[2][2] - change[0][0],
                            change[2][2] - change[0][0] - change[1][1], 4 + change[0][0] + change[1][1] + change[2][2]};
  const Vector twist{change[2][1] - change[1][2], change[0][2] - change[2][0], change[1][0] - change[0][1]};
  const auto i = static_cast<size_t>(std::max_element(squares, squares + 4) - squares);
  const double twice = std::sqrt(squares[i]);  // of the largest
  if (i == 3) return {twice / 2, scaled(1 / (2 * twice), twist)};
  const size_t j = (i + 1) % 3, k = (i + 2) % 3;
  Vector axis;
  axis[i] = twice / 2;
  axis[j] = (change[i][j] + change[j][i]) / (2 * twice);
  axis[k] = (change[k][i] + change[i][k]) / (2 * twice);
  const double cosine = twist[i] / (2 * twice);
  return {std::abs(cosine), scaled(cosine < 0 ? -1 : 1, axis)};
}

}  // namespace

TurnAndMotion turnBetween(const Transform& start, const Transform& end, const std::array<double, 3>& about) {
  const FloatEnvironment floats;
  for (const auto& [name, pose] : {std::pair{"start: ", &start}, {"end: ", &end}}) {
    if (const std::string wrong = validate(*pose); !wrong.empty()) refuse(name + wrong);
  }
  TurnAndMotion out;
  out.turn.centre = transform(start, about);
  for (size_t k = 0; k < 3; ++k) {
    const auto moved = [&](size_t i) { return end.m[4 * k + i] - start.m[4 * k + i]; };
    out.motion[k] = moved(3) + (moved(0) * about[0] + moved(1) * about[1] + moved(2) * about[2]);
    for (const double value : {out.turn.centre[k], out.motion[k]}) {
      if (!(std::abs(value) <= kMostPlace)) refuse("about: expected a point that the poses place within 2^800");
    }
  }
  const Matrix change = changeBetween(start, end);
  Matrix turn = change;
  for (size_t i = 0; i < 3; ++i) turn[i][i] += 1;
  if (volumeOf(turn) < 0) refuse("expected an end that is the start turned and moved, got its mirror image");
  const double deviation = deviationOf(turn);
  if (!(deviation <= kMostDeviation)) {
    refuse("expected an end that is the start turned and moved, got one that is scaled or sheared, by " +
           textOf(deviation));
  }
  const auto [cosine, axis] = halfTurned(change);
  if (cosine <= 2 * deviation + 64 * kUnit) {
    refuse("expected less than half a turn, which may go either way, got one: state its axis and angle");
  }
  out.turn.axis = axis;
  out.turn.angle = 2 * std::atan2(lengthOf(axis), cosine);
  return out;
}

}  // namespace radar
