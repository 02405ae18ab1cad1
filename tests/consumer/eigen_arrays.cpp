#include <iostream>
#include <vector>

#include <radar/cpu_sweeper.h>
#include <radar/eigen.h>

int main() {
  // As igl::read_triangle_mesh fills them: a pyramid that stands on its tip, at height 0.1.
  Eigen::MatrixXd V(4, 3);
  Eigen::MatrixXi F(4, 3);
  V << 0, 0, 0.1, 1, 0, 1, -1, 1, 1, -1, -1, 1;
  F << 0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2;
  Eigen::Matrix3f plate;
  plate << -9, -9, 0, 9, -9, 0, 0, 9, 0;

  radar::Scene scene;
  const radar::RoundedMesh pyramid = radar::addRoundedMesh(scene, V, F);
  scene.addObject({.mesh = radar::addMesh(scene, plate, Eigen::RowVector3i(0, 1, 2))});

  std::vector<radar::Query> queries;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Isometry3d pose(Eigen::Translation3d(i, 1, 5));
    queries.push_back(
        {.mesh = pyramid.mesh, .worldFromMesh = radar::transformOf(pose), .direction = {0, 0, -1}, .distance = 9});
  }
  radar::CpuSweeper sweeper(scene);
  const std::vector<radar::Result> results = sweeper.run(queries).results;

  std::cout << "vertices are off by at most " << pyramid.largestError << "\n";
  const auto points = radar::pointsOf(results);  // 3 x 3, and no copy
  std::cout << "the points lie about " << points.colwise().mean() << "\n";
  std::cout << "all move by " << radar::distancesOf(results).minCoeff() << "\n";
}
