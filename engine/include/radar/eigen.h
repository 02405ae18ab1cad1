// For hosts that use Eigen, 3.4 or later: matrices to meshes and poses, and answers as matrices. Header-only; nothing
// else includes it, and the library does not need Eigen.
//
// What goes in is copied, so that neither Eigen's alignment nor the flags of a host's compiler reach the engine.
// Matrices may be Maps, Blocks and other expressions, by rows or by columns, of fixed or dynamic size.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>
#include <type_traits>
#include <utility>

#include "radar/answers.h"

namespace radar {

namespace detail {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(17);
  (text << ... << parts);
  throw Error(text.str());
}

/// The numbers of a matrix of 3 columns, row by row. `convert` returns none for a number that is not as expected.
template <class To, class Matrix, class Convert>
std::vector<To> converted(const char* call, const Eigen::MatrixBase<Matrix>& matrix, const std::string& expected,
                          const Convert& convert) {
  const auto& given = matrix.eval();
  if (given.cols() != 3) refuse(call, ": expected 3 columns, got ", given.cols());
  std::vector<To> out;
  out.reserve(static_cast<size_t>(given.size()));
  for (Eigen::Index row = 0; row < given.rows(); ++row) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::optional<To> number = convert(given(row, k));
      if (!number) refuse(call, ": row ", row, ": expected ", expected, ", got ", +given(row, k));
      out.push_back(*number);
    }
  }
  return out;
}

}  // namespace detail

/// A pose from its matrix, of floats or doubles: 4x4 with the last row 0 0 0 1, or 3x4 without it. Throws Error if the
/// matrix has another size or last row. The calls that take the pose refuse it if it is singular or not finite.
template <class Matrix>
Transform transformOf(const Eigen::MatrixBase<Matrix>& worldFromMesh) {
  if (worldFromMesh.cols() != 4 || (worldFromMesh.rows() != 3 && worldFromMesh.rows() != 4)) {
    detail::refuse("transformOf: expected a matrix of 4x4 or 3x4, got ", worldFromMesh.rows(), "x",
                   worldFromMesh.cols());
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor, 4, 4> rows = worldFromMesh.template cast<double>();
  if (rows.rows() == 4 && rows.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    detail::refuse("transformOf: expected the last row 0 0 0 1, got ", rows(3, 0), " ", rows(3, 1), " ", rows(3, 2),
                   " ", rows(3, 3));
  }
  Transform pose;
  std::copy_n(rows.data(), pose.m.size(), pose.m.begin());
  return pose;
}

/// The same of an Isometry3d, an Affine3d, or another of Eigen's transforms.
template <class Scalar, int Mode, int Options>
Transform transformOf(const Eigen::Transform<Scalar, 3, Mode, Options>& worldFromMesh) {
  return transformOf(worldFromMesh.matrix());
}

/// Vertices, N x 3, of floats or doubles, for Scene::addMesh and Scene::setPositions: 3 floats per vertex. Throws Error
/// if a double is no float, naming its row, or if there are not 3 columns.
template <class Matrix>
std::vector<float> positionsOf(const Eigen::MatrixBase<Matrix>& vertices) {
  using Scalar = typename Matrix::Scalar;
  using Bits = std::conditional_t<std::is_same_v<Scalar, float>, uint32_t, uint64_t>;
  static_assert(std::is_same_v<Scalar, float> || std::is_same_v<Scalar, double>, "expected floats or doubles");
  const auto exactly = [](Scalar number) {
    const Scalar rounded = static_cast<float>(number);
    // Compares bits: a host's -ffast-math cannot simplify that.
    const bool isFloat = std::bit_cast<Bits>(rounded) == std::bit_cast<Bits>(number);
    return isFloat ? std::optional(static_cast<float>(number)) : std::nullopt;
  };
  return detail::converted<float>("positionsOf", vertices, "a float (roundedPositionsOf rounds)", exactly);
}

struct RoundedPositions {
  std::vector<float> positions;  ///< 3 per vertex, the nearest floats
  double largestError = 0;       ///< the largest |float - number given|, mesh units
};

/// The same, rounded. Throws Error if a double is beyond the greatest float, naming its row, or if there are not 3
/// columns.
template <class Matrix>
RoundedPositions roundedPositionsOf(const Eigen::MatrixBase<Matrix>& vertices) {
  double largestError = 0;
  const auto rounded = [&](double number) -> std::optional<float> {
    if (std::abs(number) > std::numeric_limits<float>::max()) return std::nullopt;
    const float nearest = static_cast<float>(number);
    largestError = std::max(largestError, std::abs(nearest - number));
    return nearest;
  };
  std::vector<float> positions =
      detail::converted<float>("roundedPositionsOf", vertices, "at most the greatest float", rounded);
  return {std::move(positions), largestError};
}

/// Triangles, M x 3, of integers of any type, for Scene::addMesh: 3 vertex numbers per triangle. Throws Error if one is
/// negative or not below `vertexCount`, naming its row, or if there are not 3 columns.
template <class Matrix>
std::vector<uint32_t> indicesOf(const Eigen::MatrixBase<Matrix>& triangles, Eigen::Index vertexCount) {
  const auto vertex = [&](auto number) {
    const bool exists = std::in_range<uint32_t>(number) && std::cmp_less(number, vertexCount);
    return exists ? std::optional(static_cast<uint32_t>(number)) : std::nullopt;
  };
  return detail::converted<uint32_t>("indicesOf", triangles,
                                     "one of " + std::to_string(vertexCount) + " vertices, from 0", vertex);
}

/// Adds a mesh of N vertices (N x 3) and M triangles (M x 3), such as libigl's V and F. Throws Error as positionsOf,
/// indicesOf and Scene::addMesh do.
template <class Vertices, class Triangles>
MeshId addMesh(Scene& scene, const Eigen::MatrixBase<Vertices>& vertices,
               const Eigen::MatrixBase<Triangles>& triangles) {
  return scene.addMesh(positionsOf(vertices), indicesOf(triangles, vertices.rows()));
}

struct RoundedMesh {
  MeshId mesh = kNone;
  double largestError = 0;  ///< see RoundedPositions
};

/// The same, with vertices rounded to the nearest floats, which are then the geometry that all answers are exact for.
template <class Vertices, class Triangles>
RoundedMesh addRoundedMesh(Scene& scene, const Eigen::MatrixBase<Vertices>& vertices,
                           const Eigen::MatrixBase<Triangles>& triangles) {
  const RoundedPositions rounded = roundedPositionsOf(vertices);
  return {scene.addMesh(rounded.positions, indicesOf(triangles, vertices.rows())), rounded.largestError};
}

/// Numbers of N answers where they are, without a copy: valid until the answers are changed, moved or destroyed.
using ResultVectors = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>, Eigen::Unaligned,
                                 Eigen::OuterStride<sizeof(Result) / sizeof(double)>>;
using ResultNumbers =
    Eigen::Map<const Eigen::VectorXd, Eigen::Unaligned, Eigen::InnerStride<sizeof(Result) / sizeof(double)>>;

/// Result::point of each, N x 3, world units; NaN where absent.
inline ResultVectors pointsOf(std::span<const Result> results) {
  return {results.empty() ? nullptr : results.front().point.data(), static_cast<Eigen::Index>(results.size()), 3};
}
/// Result::normal of each, N x 3; NaN where absent.
inline ResultVectors normalsOf(std::span<const Result> results) {
  return {results.empty() ? nullptr : results.front().normal.data(), static_cast<Eigen::Index>(results.size()), 3};
}
/// Result::t of each, N x 1, world units; +infinity where no contact is certain.
inline ResultNumbers distancesOf(std::span<const Result> results) {
  return {results.empty() ? nullptr : &results.front().t, static_cast<Eigen::Index>(results.size())};
}
// The map would outlive what it shows.
ResultVectors pointsOf(std::vector<Result>&& results) = delete;
ResultVectors normalsOf(std::vector<Result>&& results) = delete;
ResultNumbers distancesOf(std::vector<Result>&& results) = delete;

}  // namespace radar
