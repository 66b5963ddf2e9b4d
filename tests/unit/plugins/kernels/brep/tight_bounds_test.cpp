// SPDX-License-Identifier: MIT
/// The size of parts whose control points and turned boxes reach farther than they do.
#include "kernels/brep/search/tight_bounds.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sample_solids.hpp"
#include "sample_splines.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns random rotations, the same in each run.
std::vector<Matrix3d> turns() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Matrix3d> turns;
  for (int i = 0; i < 20; ++i)
    turns.push_back(Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                        .normalized()
                        .toRotationMatrix());
  return turns;
}

void expectBox(const Model& model, const Vector3d& low, const Vector3d& high) {
  const Eigen::AlignedBox3d box = tightBounds(model), loose = model.bounds();
  const double slack = 1e-5 * (high - low).norm();
  const Eigen::AlignedBox3d alone = tightBounds(model, 0);
  EXPECT_LT((alone.min() - low).cwiseAbs().maxCoeff(), slack) << "as the only body";
  EXPECT_LT((alone.max() - high).cwiseAbs().maxCoeff(), slack) << "as the only body";
  EXPECT_LT((box.min() - low).cwiseAbs().maxCoeff(), slack) << box.min().transpose() << " not " << low.transpose();
  EXPECT_LT((box.max() - high).cwiseAbs().maxCoeff(), slack) << box.max().transpose() << " not " << high.transpose();
  EXPECT_TRUE(loose.contains(box));
}

TEST(TightBounds, OfASphereOfSplinesAreThoseOfTheSphere) {
  const ModelFile file = readModelFile(HAPTICD_SOURCE_DIR "/config/models/sphere.yaml");
  const Vector3d centre(0.3, -0.2, 0.1), half = Vector3d::Constant(0.05);
  for (const Matrix3d& turn : turns()) {
    std::vector<spline::SurfaceData> surfaces = file.surfaces;
    for (spline::SurfaceData& data : surfaces)
      for (Vector3d& point : data.points) point = turn * point + centre;
    expectBox(Model(samples::sheetOf(surfaces)), centre - half, centre + half);
  }
}

TEST(TightBounds, OfATurnedInstanceAreThoseOfItsCorners) {
  const Vector3d size(0.03, 0.02, 0.01);
  for (const Matrix3d& turn : turns()) {
    Part part = samples::prism({{0, 0}, {30, 0}, {30, 20}, {0, 20}}, 10);
    Instance& instance = part.instances.front();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        instance.pose[static_cast<std::size_t>(4 * row + column)] = turn(row, column);
    Eigen::AlignedBox3d truth;
    for (int corner = 0; corner < 8; ++corner)
      truth.extend(turn * Vector3d(corner & 1 ? size.x() : 0, corner & 2 ? size.y() : 0, corner & 4 ? size.z() : 0));
    expectBox(Model(std::move(part)), truth.min(), truth.max());
  }
}

TEST(TightBounds, OfATiltedTorusAreThoseOfItsTube) {
  constexpr double kRadius = 0.03, kTube = 0.008;  // [m]
  for (const Matrix3d& turn : turns()) {
    Part part = samples::torus(30, 8);
    Instance& instance = part.instances.front();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        instance.pose[static_cast<std::size_t>(4 * row + column)] = turn(row, column);
    const Vector3d axis = turn.col(2);
    const Vector3d half = kRadius * (1 - axis.array().square()).sqrt() + kTube;
    expectBox(Model(std::move(part)), -half, half);
  }
}

TEST(TightBounds, OfATinyAndAHugePartAreAsTight) {
  const ModelFile file = readModelFile(HAPTICD_SOURCE_DIR "/config/models/sphere.yaml");
  for (const double scale : {1e-3, 1e3}) {
    std::vector<spline::SurfaceData> surfaces = file.surfaces;
    for (spline::SurfaceData& data : surfaces)
      for (Vector3d& point : data.points) point = scale * (turns().front() * point);
    expectBox(Model(samples::sheetOf(surfaces)), Vector3d::Constant(-0.05 * scale), Vector3d::Constant(0.05 * scale));
  }
}

}  // namespace
}  // namespace hapticd::brep
