// radar/eigen.h: what goes in keeps its numbers or is refused, and what comes out is not copied.
#include "radar/eigen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "support/answer.h"
#include "support/catch.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using tools::Random;

template <int Order>
using Matrix4 = Eigen::Matrix<double, 4, 4, Order>;
using ByRows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

ByRows randomVertices(Random& random, Eigen::Index count) {
  ByRows vertices(count, 3);
  for (double& x : vertices.reshaped()) x = float(random.uniform(-9, 9));
  return vertices;
}

Eigen::MatrixXi randomTriangles(Random& random, Eigen::Index count, Eigen::Index vertices) {
  Eigen::MatrixXi triangles(count, 3);
  for (int& vertex : triangles.reshaped()) vertex = int(random.below(uint32_t(vertices)));
  return triangles;
}

/// By another way than the header's.
std::vector<float> floatsOf(const ByRows& vertices) {
  return {vertices.data(), vertices.data() + vertices.size()};
}

}  // namespace

TEST_CASE("a pose of Eigen keeps its numbers, in every type of transform and matrix") {
  Random random(71);
  for (int i = 0; i < 200; ++i) {
    const Transform expected = random.affine(random.inCube(100));
    Matrix4<Eigen::RowMajor> rows = Matrix4<Eigen::RowMajor>::Identity();
    std::copy(expected.m.begin(), expected.m.end(), rows.data());
    const Matrix4<Eigen::ColMajor> columns = rows;
    Eigen::MatrixXd large = Eigen::MatrixXd::Constant(9, 9, NAN);
    large.block(2, 3, 4, 4) = rows;
    CHECK(transformOf(rows) == expected);
    CHECK(transformOf(columns) == expected);
    CHECK(transformOf(large.block(2, 3, 4, 4)) == expected);
    CHECK(transformOf(columns.topRows<3>()) == expected);
    CHECK(transformOf(Eigen::Map<const Matrix4<Eigen::ColMajor>>(rows.data()).transpose()) == expected);
    CHECK(transformOf(columns * Eigen::Matrix4d::Identity()) == expected);
    CHECK(transformOf(Eigen::Isometry3d(columns)) == expected);
    CHECK(transformOf(Eigen::Affine3d(columns)) == expected);
    CHECK(transformOf(Eigen::AffineCompact3d(columns)) == expected);
    CHECK(transformOf(Eigen::Transform<double, 3, Eigen::Projective, Eigen::RowMajor>(columns)) == expected);
    const Transform floats = transformOf(Eigen::Affine3f(columns.cast<float>()));
    for (size_t k = 0; k < 12; ++k) CHECK(floats.m[k] == double(float(expected.m[k])));
  }
}

TEST_CASE("a matrix that is no pose is refused, and what is singular or not finite is left to the engine") {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(3, 2) = 0.1;
  CHECK_THROWS_WITH(transformOf(matrix), "transformOf: expected the last row 0 0 0 1, got 0 0 0.10000000000000001 1");
  CHECK_THROWS_AS(transformOf(Eigen::Projective3d(matrix)), Error);
  for (const double last : {0.0, -1.0, 1 + 0x1p-52, double{NAN}}) {
    matrix.row(3) << 0, 0, -0.0, last;
    CHECK_THROWS_AS(transformOf(matrix), Error);
  }
  matrix(3, 3) = 1;
  CHECK(transformOf(matrix) == Transform{});
  for (const auto& [rows, columns] : {std::pair{2, 4}, {5, 4}, {4, 3}, {4, 5}, {0, 0}}) {
    const std::string size = std::to_string(rows) + "x" + std::to_string(columns);
    CHECK_THROWS_WITH(transformOf(Eigen::MatrixXd::Identity(rows, columns)),
                      "transformOf: expected a matrix of 4x4 or 3x4, got " + size);
  }
  matrix(0, 3) = INFINITY;
  CHECK_THAT(validate(transformOf(matrix)), test::Contains("expected 12 finite numbers"));
  CHECK_THAT(validate(transformOf(Eigen::Matrix4d(Eigen::Vector4d(1, 0, 1, 1).asDiagonal()))),
             test::Contains("singular"));
}

TEST_CASE("a mesh of Eigen keeps its numbers, of any type, by rows or columns, in maps, blocks and expressions") {
  Random random(72);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Index count = 3 + random.below(40);
    const ByRows rows = randomVertices(random, count);
    const Eigen::MatrixXi triangles = randomTriangles(random, 1 + random.below(60), count);
    const Eigen::MatrixXd columns = rows;
    Eigen::MatrixXd large = Eigen::MatrixXd::Constant(count + 5, 7, NAN);
    large.block(4, 2, count, 3) = rows;
    const Eigen::Map<const Eigen::Matrix3Xd> points(rows.data(), 3, count);
    const std::vector<float> expected = floatsOf(rows);
    CHECK(positionsOf(rows) == expected);
    CHECK(positionsOf(columns) == expected);
    CHECK(positionsOf(columns.cast<float>()) == expected);
    CHECK(positionsOf(large.block(4, 2, count, 3)) == expected);
    CHECK(positionsOf(points.transpose()) == expected);
    CHECK(positionsOf(columns * Eigen::Matrix3d::Identity()) == expected);
    const RoundedPositions rounded = roundedPositionsOf(columns);
    CHECK(rounded.positions == expected);
    CHECK(rounded.largestError == 0);

    const Eigen::Matrix<uint64_t, Eigen::Dynamic, 3, Eigen::RowMajor> longs = triangles.cast<uint64_t>();
    const std::vector<uint32_t> indices(longs.data(), longs.data() + longs.size());
    CHECK(indicesOf(triangles, count) == indices);
    CHECK(indicesOf(longs, count) == indices);
    CHECK(indicesOf(triangles.cast<int8_t>(), count) == indices);

    Scene scene;
    for (const MeshId mesh : {addMesh(scene, columns, triangles), addMesh(scene, rows.cast<float>(), longs),
                              addRoundedMesh(scene, rows, triangles).mesh}) {
      CHECK(std::ranges::equal(scene.mesh(mesh).positions, expected));
      CHECK(std::ranges::equal(scene.mesh(mesh).indices, indices));
    }
  }
}

TEST_CASE("a double that is no float is refused, naming row and value, or rounded, telling the largest error") {
  Random random(73);
  const Eigen::MatrixXi triangle = Eigen::RowVector3i(0, 1, 2);
  Scene scene;
  for (const double number : {0.1, 1 + 0x1p-52, 0x1p-150, 0x1p-1074, -1e38 / 3, 1e300}) {
    ByRows vertices = randomVertices(random, 20);
    const auto row = Eigen::Index(random.below(20));
    vertices(row, random.below(3)) = number;
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", number);
    const std::string where = ": row " + std::to_string(row) + ": expected ", got = std::string(", got ") + text;
    CHECK_THROWS_WITH(addMesh(scene, vertices, triangle),
                      "positionsOf" + where + "a float (roundedPositionsOf rounds)" + got);
    if (number > std::numeric_limits<float>::max()) {
      CHECK_THROWS_WITH(addRoundedMesh(scene, vertices, triangle),
                        "roundedPositionsOf" + where + "at most the greatest float" + got);
      continue;
    }
    const RoundedMesh rounded = addRoundedMesh(scene, vertices, triangle);
    CHECK(rounded.largestError == std::abs(float(number) - number));
    CHECK(std::ranges::equal(scene.mesh(rounded.mesh).positions, floatsOf(vertices)));
  }
  ByRows many(200, 3);
  for (double& x : many.reshaped()) x = random.uniform(-9, 9);
  const double expected = (many.cast<float>().cast<double>() - many).cwiseAbs().maxCoeff();
  CHECK(roundedPositionsOf(many).largestError == expected);
  // Floats of every kind are kept, -0 and subnormal ones included.
  for (const double number : {-0.0, 0x1p-149, 0x1.fffffep127, -0x1p-126}) {
    const std::vector<float> kept = positionsOf(Eigen::RowVector3d(number, 0, 0));
    CHECK((kept[0] == number && std::signbit(kept[0]) == std::signbit(number)));
  }
}

TEST_CASE("what is not finite is left to the engine, and a matrix of another width is refused") {
  Scene scene;
  Eigen::MatrixXd vertices = Eigen::MatrixXd::Identity(3, 3);
  const Eigen::MatrixXi triangle = Eigen::RowVector3i(0, 1, 2);
  vertices(1, 2) = NAN;
  CHECK_THROWS_WITH(addMesh(scene, vertices, triangle), test::Contains("vertex 1 is not finite"));
  CHECK_THROWS_WITH(addRoundedMesh(scene, vertices, triangle), test::Contains("vertex 1 is not finite"));
  vertices(1, 2) = INFINITY;
  CHECK_THROWS_WITH(addMesh(scene, vertices, triangle), test::Contains("vertex 1 is not finite"));
  vertices(1, 2) = 0;
  CHECK_THROWS_WITH(addMesh(scene, vertices.leftCols(2), triangle), "positionsOf: expected 3 columns, got 2");
  CHECK_THROWS_WITH(addRoundedMesh(scene, vertices.leftCols(2), triangle),
                    "roundedPositionsOf: expected 3 columns, got 2");
  CHECK_THROWS_WITH(addMesh(scene, vertices, Eigen::MatrixXi(5, 4)), "indicesOf: expected 3 columns, got 4");
  CHECK_THROWS_WITH(addMesh(scene, vertices, Eigen::MatrixXi(0, 3)), test::Contains("at least one triangle"));
  CHECK(scene.meshLimit() == 0);
}

TEST_CASE("an index of no vertex is refused, naming its row") {
  Random random(74);
  Scene scene;
  const ByRows vertices = randomVertices(random, 9);
  for (const int64_t wrong : {int64_t{-1}, int64_t{9}, int64_t{1} << 32, std::numeric_limits<int64_t>::min()}) {
    Eigen::Matrix<int64_t, Eigen::Dynamic, 3> triangles = randomTriangles(random, 30, 9).cast<int64_t>();
    const auto row = Eigen::Index(random.below(30));
    triangles(row, random.below(3)) = wrong;
    CHECK_THROWS_WITH(
        addMesh(scene, vertices, triangles),
        "indicesOf: row " + std::to_string(row) + ": expected one of 9 vertices, from 0, got " + std::to_string(wrong));
    // A 32-bit number beyond the vertices stays so, whatever is said of their number.
    CHECK_THROWS_AS(indicesOf(Eigen::Matrix<int64_t, 1, 3>(0, 1, int64_t{1} << 32), int64_t{1} << 40), Error);
  }
}

TEST_CASE("the numbers of answers are seen in place") {
  std::vector<Result> results;
  for (int i = 0; i < 5; ++i) {
    results.push_back(test::madeUpAnswer(Status::hit, i, i, i));
    results.back().point = {1.0 * i, 2.0 * i, 3.0 * i};
    results.back().normal = {-1.0 * i, -2.0 * i, -3.0 * i};
  }
  const ResultVectors points = pointsOf(results), normals = normalsOf(results);
  const ResultNumbers distances = distancesOf(results);
  CHECK((points.rows() == 5 && normals.rows() == 5 && distances.rows() == 5));
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double x = double(i);
    CHECK(points.row(i) == Eigen::RowVector3d(x, 2 * x, 3 * x));
    CHECK(normals.row(i) == -points.row(i));
    CHECK(distances[i] == x);
    CHECK(points.data() + i * points.rowStride() == results[size_t(i)].point.data());
  }
  results[3].point[1] = 17;
  CHECK(points(3, 1) == 17);
  CHECK(pointsOf(std::span(results).subspan(2, 2)) == points.middleRows(2, 2));
  CHECK(distances.maxCoeff() == 4);
  CHECK(pointsOf(std::span<const Result>{}).rows() == 0);
  CHECK(distancesOf(std::span<const Result>{}).size() == 0);
}

TEST_CASE("a sweep of Eigen's arrays answers as one of the engine's own") {
  Random random(75);
  Scene scene;
  const ByRows vertices = randomVertices(random, 30);
  const MeshId mesh = addMesh(scene, vertices, randomTriangles(random, 40, 30));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX())).pretranslate(Eigen::Vector3d(0, 0, 50));
  scene.addObject({.mesh = mesh, .worldFromMesh = transformOf(pose)});
  const std::vector<Result> results{test::answer(scene, {.mesh = mesh, .direction = {0, 0, 2}, .distance = 100})};
  REQUIRE(results[0].status == Status::hit);
  // The point lies on the triangle that was touched.
  const MeshView view = scene.mesh(mesh);
  Eigen::Matrix3d corners;
  for (int i = 0; i < 3; ++i) corners.col(i) = vertices.row(view.indices[3 * results[0].triB + size_t(i)]);
  const Eigen::Vector3d inMesh = pose.inverse() * pointsOf(results).row(0).transpose();
  const Eigen::Vector3d normal = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).normalized();
  CHECK(std::abs(normal.dot(inMesh - corners.col(0))) < 1e-12 * 50);
  CHECK(normalsOf(results).row(0).norm() == Approx(1).epsilon(1e-15));
}
