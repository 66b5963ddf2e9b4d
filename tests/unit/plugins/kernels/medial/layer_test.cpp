// SPDX-License-Identifier: MIT
#include "kernels/medial/layer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::medial {
namespace {

double kappa(double tip_over_thickness, double nu) {
  const double tip = 5e-3;
  return layerStiffness({1e4, nu, tip / tip_over_thickness}, tip) * (1 - nu * nu) / (2 * 1e4 * tip);
}

TEST(Layer, AThickOneIsAHalfSpace) {
  for (const double nu : {0.0, 0.3, 0.5}) {
    EXPECT_NEAR(kappa(1e-4, nu), 1, 2e-4) << nu;
    EXPECT_GT(kappa(1e-2, nu), 1) << nu;
  }
}

/// Axisymmetric quadrilaterals of CalculiX 2.20, 1 um deep in a disc of 24 tips; its mesh makes it 0.5 % too stiff.
TEST(Layer, AgreesWithAFiniteElementSolver) {
  struct Case {
    double ratio, nu, kappa;
  };
  for (const Case& one : {Case{1, .3, 2.4913}, Case{.25, .3, 1.2728}, Case{.1, .3, 1.1027}, Case{1, .45, 3.1010},
                          Case{.25, .45, 1.3347}, Case{1, .49, 3.4971}, Case{.25, .49, 1.3650}})
    EXPECT_NEAR(kappa(one.ratio, one.nu), one.kappa, .01 * one.kappa) << one.ratio << " " << one.nu;
}

/// Under a wide tip the layer is squeezed without a way out: M pi a^2 / h, M = E (1 - nu) / (1 + nu) / (1 - 2 nu), and
/// an edge that weighs less the wider the tip.
TEST(Layer, AThinOneIsSqueezed) {
  for (const double nu : {0.0, 0.2, 0.3}) {
    const double modulus = (1 - nu) / (1 + nu) / (1 - 2 * nu);
    const auto excess = [&](double ratio) {
      return kappa(ratio, nu) * 2 / (1 - nu * nu) / (M_PI * ratio * modulus) - 1;
    };
    EXPECT_GT(excess(10), 0) << nu;
    EXPECT_LT(excess(10), .15) << nu;
    EXPECT_NEAR(excess(5) / excess(10), 2, .2) << nu;
  }
}

TEST(Layer, IsStifferTheThinnerAndTheLessItCanBeCompressed) {
  double thicker = 0;
  for (const double ratio : {.01, .1, .3, 1.0, 3.0, 10.0}) {
    double softer = 0;
    for (const double nu : {0.0, .2, .4, .5}) {
      const double k = layerStiffness({1, nu, 5e-3 / ratio}, 5e-3);
      EXPECT_GT(k, softer) << ratio << " " << nu;
      softer = k;
    }
    EXPECT_GT(softer, thicker) << ratio;
    thicker = softer;
  }
}

TEST(Layer, StiffnessIsProportionalToTheModulusAndToTheScale) {
  const double k = layerStiffness({1e4, .45, .02}, .005);
  EXPECT_NEAR(layerStiffness({3e4, .45, .02}, .005), 3 * k, 1e-9 * k);
  EXPECT_NEAR(layerStiffness({1e4, .45, .04}, .01), 2 * k, 1e-9 * k);
}

}  // namespace
}  // namespace hapticd::medial
