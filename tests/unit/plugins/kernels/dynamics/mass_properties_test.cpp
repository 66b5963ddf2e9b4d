// SPDX-License-Identifier: MIT
#include "kernels/dynamics/mass_properties.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace hapticd::dynamics {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The six faces of a box by two Gauss points a direction: exact for the integrals of a box.
SolidIntegral integralOf(const AlignedBox3d& box, const Vector3d& origin) {
  SolidIntegral integral(origin);
  const Vector3d half = box.sizes() / 2;
  const double node = 1 / std::sqrt(3.0);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (const double s : {-node, node})
        for (const double t : {-node, node}) {
          const int j = (axis + 1) % 3, k = (axis + 2) % 3;
          Vector3d at = box.center();
          at[axis] += side * half[axis];
          at[j] += s * half[j];
          at[k] += t * half[k];
          integral.add(at, side * half[j] * half[k] * Vector3d::Unit(axis));
        }
  return integral;
}

TEST(MassProperties, SurfaceIntegralsOfABoxAreThoseOfItsVolumeWhereverItStands) {
  const AlignedBox3d box(Vector3d(1, -2, 3), Vector3d(1.5, -1, 3.2));
  const MassProperties truth = boxProperties(box);
  for (const Vector3d& origin : {Vector3d(0, 0, 0), Vector3d(1.2, -1.4, 3.1)}) {
    const SolidIntegral integral = integralOf(box, origin);
    EXPECT_NEAR(integral.volume(), box.volume(), 1e-14);
    const MassProperties found = integral.properties();
    EXPECT_LT((found.center - truth.center).norm(), 1e-12);
    EXPECT_LT((found.inertia - truth.inertia).norm(), 1e-10);
  }
}

TEST(MassProperties, ABoxOfKnownSidesHasTheMomentsOfTheTextbook) {
  const MassProperties box = boxProperties(AlignedBox3d(Vector3d(0, 0, 0), Vector3d(1, 2, 3)));
  EXPECT_EQ(box.center, Vector3d(0.5, 1, 1.5));
  EXPECT_LT((box.inertia - Matrix3d(Vector3d(13, 10, 5).asDiagonal()) / 12).norm(), 1e-15);
}

TEST(MassProperties, AnInertiaThatNoSolidHasIsRefusedWithItsMoments) {
  const auto complaint = [](const Matrix3d& inertia) -> std::string {
    try {
      validateSolid(inertia);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(Vector3d(1, 2, 3).asDiagonal()), "") << "a flat plate";
  EXPECT_NE(complaint(Vector3d(1, 2, 3.1).asDiagonal()).find("1, 2, 3.1 kg m^2, expected no moment above the sum"),
            std::string::npos);
  EXPECT_NE(complaint(Vector3d(1, -2, 3).asDiagonal()).find("expected all above 0"), std::string::npos);
  Matrix3d skew = Matrix3d::Identity();
  skew(0, 1) = 0.1;
  EXPECT_NE(complaint(skew).find("symmetric"), std::string::npos);
  skew(1, 0) = 0.1;
  EXPECT_EQ(complaint(skew), "");
  EXPECT_NE(complaint(Matrix3d::Constant(NAN)).find("finite"), std::string::npos);
}

}  // namespace
}  // namespace hapticd::dynamics
