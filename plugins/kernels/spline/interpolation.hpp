// SPDX-License-Identifier: MIT
/// Splines through given points in any number of dimensions, such as positions alone, or positions with radii and
/// material.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace hapticd::spline {

/// A spline curve in any dimension: the control points are the rows of `control`.
struct CurveFit {
  int degree = 1;
  std::vector<double> parameters;  ///< parameters of the data points, from 0 to 1
  std::vector<double> knots;       ///< number of control points + degree + 1 values
  Eigen::MatrixXd control;
};

/// A tensor-product spline in any dimension: control point (i, j) is row i * count[1] + j.
struct GridFit {
  std::array<int, 2> degree{1, 1};
  std::array<int, 2> count{0, 0};
  std::array<std::vector<double>, 2> parameters, knots;
  Eigen::MatrixXd control;
};

/// [main] Returns chord-length parameters from 0 to 1 (Piegl & Tiller 9.5).
/// @param chord_dimensions number of columns, from the first on, that are positions; 0 means all columns. Distances are
/// measured in these columns only, so that radii or stiffnesses in later columns do not stretch the parameters
/// @throws std::invalid_argument if two neighbours coincide or a number is not finite.
std::vector<double> chordParameters(const Eigen::MatrixXd& data, int chord_dimensions = 3);

/// [main] Returns clamped knots from averaged parameters (Piegl & Tiller 9.8). With these knots the interpolation has
/// exactly one solution.
/// @throws std::invalid_argument if there are fewer than degree + 1 parameters or they do not increase.
std::vector<double> averagedKnots(const std::vector<double>& parameters, int degree);

/// The collocation matrix of a clamped spline, factored once. The matrix is banded and totally positive, so elimination
/// needs no pivots and stays in the band (de Boor & Pinkus 1977). Factoring takes n * degree^2 operations and n *
/// degree numbers of memory.
class Collocation {
 public:
  /// [main] @throws std::invalid_argument if the parameters and knots do not determine every control point
  /// (Schoenberg-Whitney condition).
  Collocation(const std::vector<double>& parameters, const std::vector<double>& knots, int degree);

  /// [any] Replaces the data points (one per row) by the control points. Allocates nothing.
  void solve(Eigen::Ref<Eigen::MatrixXd> data) const noexcept;
  int size() const noexcept { return static_cast<int>(band_.rows()); }

 private:
  double& at(int row, int column) noexcept { return band_(row, column - row + degree_); }
  double at(int row, int column) const noexcept { return band_(row, column - row + degree_); }
  void factor();

  int degree_;
  Eigen::MatrixXd band_;  ///< row i holds columns i - degree to i + degree of the matrix
};

/// [main] Returns the spline of `degree` through all rows of `data`. @throws std::invalid_argument if there are too few
/// points for the degree, two neighbours coincide or a number is not finite.
CurveFit interpolateCurve(const Eigen::MatrixXd& data, int degree, int chord_dimensions = 3);

/// [main] Returns the tensor-product spline through a grid of data, where point (i, j) is row i * count[1] + j (Piegl &
/// Tiller A9.4). Parameters are chord lengths averaged over all rows and columns of the grid. Rows and columns without
/// length (collapsed to a point) are left out of the average.
/// @throws std::invalid_argument under the same conditions as interpolateCurve().
GridFit interpolateGrid(const Eigen::MatrixXd& data, const std::array<int, 2>& count, const std::array<int, 2>& degree,
                        int chord_dimensions = 3);

}  // namespace hapticd::spline
