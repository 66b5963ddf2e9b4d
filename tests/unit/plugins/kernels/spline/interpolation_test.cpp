// SPDX-License-Identifier: MIT
#include "kernels/spline/interpolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "kernels/spline/basis.hpp"

namespace hapticd::spline {
namespace {

Eigen::MatrixXd randomData(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-1, 1);
  Eigen::MatrixXd data(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < columns; ++k) data(i, k) = noise(random) * std::pow(10.0, k - 1);
    data(i, 0) += 0.5 * i;
  }
  return data;
}

Eigen::RowVectorXd valueAt(const std::vector<double>& knots, int degree, const Eigen::MatrixXd& control, double t) {
  const int span = findSpan(knots, degree, t);
  std::array<double, kMaxDegree + 1> N;
  basisFunctions(knots, degree, span, t, N);
  Eigen::RowVectorXd value = Eigen::RowVectorXd::Zero(control.cols());
  for (int k = 0; k <= degree; ++k) value += N[static_cast<std::size_t>(k)] * control.row(span - degree + k);
  return value;
}

TEST(InterpolateCurve, PassesThroughAllDataInSevenDimensions) {
  for (int degree = 1; degree <= 7; ++degree) {
    for (int count : {degree + 1, degree + 2, 40}) {
      const Eigen::MatrixXd data = randomData(count, 7, static_cast<unsigned>(degree));
      const CurveFit fit = interpolateCurve(data, degree);
      for (int i = 0; i < count; ++i) {
        const auto value = valueAt(fit.knots, degree, fit.control, fit.parameters[static_cast<std::size_t>(i)]);
        for (int k = 0; k < 7; ++k) EXPECT_NEAR(value[k], data(i, k), 1e-12 * data.col(k).cwiseAbs().maxCoeff());
      }
    }
  }
}

TEST(InterpolateCurve, IsLinearInTheDataForFixedParameters) {
  const Eigen::MatrixXd data = randomData(12, 3, 8);
  Eigen::MatrixXd wider(12, 5);
  wider << data, 2 * data.col(0) - data.col(2), Eigen::VectorXd::Constant(12, 3.0);
  const CurveFit fit = interpolateCurve(wider, 3);
  EXPECT_LT((fit.control.col(3) - (2 * fit.control.col(0) - fit.control.col(2))).norm(), 1e-12);
  EXPECT_LT((fit.control.col(4).array() - 3).abs().maxCoeff(), 1e-13) << "constants stay constant";
}

TEST(InterpolateCurve, MeasuresChordsOnThePositionsAlone) {
  Eigen::MatrixXd data(3, 4);
  data << 0, 0, 0, 500, 1, 0, 0, 900, 3, 0, 0, 100;
  EXPECT_NEAR(chordParameters(data)[1], 1.0 / 3, 1e-16);
  EXPECT_NE(chordParameters(data, 0)[1], 1.0 / 3);
}

TEST(InterpolateCurve, WorksForCoordinatesOfAnyMagnitude) {
  for (double scale : {1e-300, 1e300}) {
    const Eigen::MatrixXd data = randomData(8, 3, 9);
    const CurveFit fit = interpolateCurve(scale * data, 3), plain = interpolateCurve(data, 3);
    EXPECT_LT((fit.control / scale - plain.control).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(InterpolateCurve, SolvesTenThousandPointsInTheBand) {
  const Eigen::MatrixXd data = randomData(10000, 5, 10);
  const CurveFit fit = interpolateCurve(data, 3);
  const auto value = valueAt(fit.knots, 3, fit.control, fit.parameters[5000]);
  EXPECT_LT((value - data.row(5000)).norm(), 1e-9 * data.norm());
}

TEST(InterpolateGrid, PassesThroughAllData) {
  const std::array<int, 2> count{7, 5}, degree{3, 2};
  Eigen::MatrixXd data(35, 5);
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 5; ++j) data.row(i * 5 + j) << 0.1 * i, 0.1 * j, std::sin(i + j), 0.01 * (i + 1), 100 + i * j;
  }
  const GridFit fit = interpolateGrid(data, count, degree);
  for (int i = 0; i < 7; ++i) {
    Eigen::MatrixXd line(7, 5);
    for (int j = 0; j < 5; ++j) {
      for (int k = 0; k < 7; ++k) {
        line.row(k) =
            valueAt(fit.knots[1], 2, fit.control.middleRows(k * 5, 5), fit.parameters[1][static_cast<std::size_t>(j)]);
      }
      const auto value = valueAt(fit.knots[0], 3, line, fit.parameters[0][static_cast<std::size_t>(i)]);
      EXPECT_LT((value - data.row(i * 5 + j)).norm(), 1e-12 * data.norm());
    }
  }
}

TEST(InterpolateGrid, AcceptsASideThatIsOnePoint) {
  Eigen::MatrixXd data(16, 3);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) data.row(i * 4 + j) << i * std::cos(j), i * std::sin(j), i;
  }
  const GridFit fit = interpolateGrid(data, {4, 4}, {3, 3});
  EXPECT_TRUE(fit.control.allFinite());
  EXPECT_TRUE(fit.control.topRows(4).isZero(1e-14)) << "the collapsed side stays one point";
}

TEST(Interpolation, SaysWhyItCannot) {
  const auto message = [](auto&& run) -> std::string {
    try {
      run();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  Eigen::MatrixXd data = randomData(6, 3, 1);
  EXPECT_NE(message([&] { interpolateCurve(data, 6); }).find("needs at least 7"), std::string::npos);
  EXPECT_NE(message([&] { interpolateCurve(data, 0); }).find("expected 1 to 15"), std::string::npos);
  EXPECT_NE(message([&] { interpolateCurve(Eigen::MatrixXd(1, 3), 1); }).find("interpolation:"), std::string::npos);
  EXPECT_NE(message([&] { interpolateGrid(data, {2, 2}, {1, 1}); }).find("grid of 2 x 2"), std::string::npos);
  data.row(3) = data.row(2);
  EXPECT_NE(message([&] { interpolateCurve(data, 3); }).find("2 and 3 coincide"), std::string::npos);
  data(1, 1) = std::nan("");
  EXPECT_NE(message([&] { interpolateCurve(data, 3); }).find("data point 1"), std::string::npos);
}

TEST(Collocation, RefusesParametersThatLeaveAControlPointUndetermined) {
  const std::vector<double> knots = {0, 0, 0, 0, 0.5, 1, 1, 1, 1};
  EXPECT_THROW(Collocation({0, 0.01, 0.02, 0.03, 0.04}, knots, 3), std::invalid_argument);
  EXPECT_NO_THROW(Collocation({0, 0.2, 0.5, 0.8, 1}, knots, 3));
}

}  // namespace
}  // namespace hapticd::spline
