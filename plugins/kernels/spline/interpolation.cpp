// SPDX-License-Identifier: MIT
#include "kernels/spline/interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/spline/basis.hpp"

namespace hapticd::spline {
namespace {

[[noreturn]] void fail(const std::string& why) {
  throw std::invalid_argument("interpolation: " + why);
}

int chordColumns(const Eigen::MatrixXd& data, int chord_dimensions) {
  const int columns = static_cast<int>(data.cols());
  return chord_dimensions <= 0 ? columns : std::min(chord_dimensions, columns);
}

/// Returns the distances between neighbours along a line of data; empty if the line has no length.
std::vector<double> chords(const Eigen::MatrixXd& line, int columns) {
  std::vector<double> lengths;
  double total = 0;
  for (Eigen::Index i = 1; i < line.rows(); ++i) {
    lengths.push_back((line.row(i).head(columns) - line.row(i - 1).head(columns)).stableNorm());
    total += lengths.back();
  }
  if (!(total > 0)) lengths.clear();
  return lengths;
}

void checkData(const Eigen::MatrixXd& data) {
  if (data.cols() < 1) fail("the data points have no coordinates");
  for (Eigen::Index i = 0; i < data.rows(); ++i) {
    if (!data.row(i).allFinite()) fail("data point " + std::to_string(i) + " holds a number that is not finite");
  }
}

/// Adds the share of each chord in the line's length to `shares`. Returns false if the line has no length.
bool addShares(const Eigen::MatrixXd& line, int columns, std::vector<double>& shares) {
  const std::vector<double> lengths = chords(line, columns);
  if (lengths.empty()) return false;
  double total = 0;
  for (double length : lengths) total += length;
  for (std::size_t i = 0; i < lengths.size(); ++i) shares[i] += lengths[i] / total;
  return true;
}

/// Returns the partial sums of `lengths`, scaled so that the last one is exactly 1.
std::vector<double> accumulate(const std::vector<double>& lengths, const char* what) {
  std::vector<double> parameters{0};
  for (double length : lengths) parameters.push_back(parameters.back() + length);
  const double total = parameters.back();
  if (!(total > 0) || !std::isfinite(total)) fail(std::string(what) + " have no finite length");
  for (double& parameter : parameters) parameter /= total;
  parameters.back() = 1;
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    if (!(parameters[i] > parameters[i - 1])) {
      fail(std::string(what) + " " + std::to_string(i - 1) + " and " + std::to_string(i) +
           " coincide; move one of them, or leave it out");
    }
  }
  return parameters;
}

/// Returns row `index` (axis 1) or column `index` (axis 0) of a grid, as consecutive rows of a matrix.
Eigen::MatrixXd gridLine(const Eigen::MatrixXd& grid, const std::array<int, 2>& count, int axis, int index) {
  const int first = axis == 0 ? index : index * count[1];
  const int step = axis == 0 ? count[1] : 1;
  Eigen::MatrixXd line(count[static_cast<std::size_t>(axis)], grid.cols());
  for (Eigen::Index k = 0; k < line.rows(); ++k) line.row(k) = grid.row(first + k * step);
  return line;
}

void setGridLine(Eigen::MatrixXd& grid, const std::array<int, 2>& count, int axis, int index,
                 const Eigen::MatrixXd& line) {
  const int first = axis == 0 ? index : index * count[1];
  const int step = axis == 0 ? count[1] : 1;
  for (Eigen::Index k = 0; k < line.rows(); ++k) grid.row(first + k * step) = line.row(k);
}

/// Averages the chord shares over all lines of the grid along an axis (Piegl & Tiller A9.3).
std::vector<double> gridParameters(const Eigen::MatrixXd& data, const std::array<int, 2>& count, int axis,
                                   int columns) {
  const auto a = static_cast<std::size_t>(axis);
  std::vector<double> shares(static_cast<std::size_t>(std::max(count[a] - 1, 0)), 0.0);
  for (int line = 0; line < count[1 - a]; ++line) addShares(gridLine(data, count, axis, line), columns, shares);
  return accumulate(shares, axis == 0 ? "grid lines along u" : "grid lines along v");
}

}  // namespace

std::vector<double> chordParameters(const Eigen::MatrixXd& data, int chord_dimensions) {
  checkData(data);
  if (data.rows() < 2) fail(std::to_string(data.rows()) + " data points; expected at least 2");
  return accumulate(chords(data, chordColumns(data, chord_dimensions)), "data points");
}

std::vector<double> averagedKnots(const std::vector<double>& parameters, int degree) {
  const int count = static_cast<int>(parameters.size());
  if (degree < 1 || degree > kMaxDegree) fail("degree " + std::to_string(degree) + "; expected 1 to 15");
  if (count < degree + 1) {
    fail(std::to_string(count) + " data points; degree " + std::to_string(degree) + " needs at least " +
         std::to_string(degree + 1));
  }
  const auto stalls = [](double a, double b) { return !(a < b); };
  if (std::adjacent_find(parameters.begin(), parameters.end(), stalls) != parameters.end()) {
    fail("the parameters do not increase; expected each to be greater than the one before");
  }
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, parameters.front());
  for (int j = 1; j < count - degree; ++j) {
    double sum = 0;
    for (int i = j; i < j + degree; ++i) sum += parameters[static_cast<std::size_t>(i)];
    knots.push_back(sum / degree);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, parameters.back());
  return knots;
}

Collocation::Collocation(const std::vector<double>& parameters, const std::vector<double>& knots, int degree)
    : degree_(degree) {
  validateKnots(knots, degree, parameters.size(), "interpolation: knots");
  const int count = static_cast<int>(parameters.size());
  band_ = Eigen::MatrixXd::Zero(count, 2 * degree + 1);
  for (int row = 0; row < count; ++row) {
    const double t = parameters[static_cast<std::size_t>(row)];
    const int span = findSpan(knots, degree, t);
    std::array<double, kMaxDegree + 1> basis;
    basisFunctions(knots, degree, span, t, basis);
    for (int k = 0; k <= degree; ++k) {
      const int column = span - degree + k;
      const double value = basis[static_cast<std::size_t>(k)];
      if (std::abs(column - row) <= degree) {
        at(row, column) = value;
      } else if (value != 0) {
        fail("parameter " + std::to_string(row) +
             " lies outside the knot range of its control point; expected knots that fit the parameters");
      }
    }
  }
  factor();
}

void Collocation::factor() {
  for (int k = 0; k < size(); ++k) {
    const double pivot = at(k, k);
    if (!(pivot > 0)) fail("no data point determines control point " + std::to_string(k));
    const int last = std::min(size() - 1, k + degree_);
    for (int row = k + 1; row <= last; ++row) {
      const double factor = at(row, k) /= pivot;
      if (factor == 0) continue;
      for (int column = k + 1; column <= last; ++column) at(row, column) -= factor * at(k, column);
    }
  }
}

void Collocation::solve(Eigen::Ref<Eigen::MatrixXd> data) const noexcept {
  for (int row = 1; row < size(); ++row) {
    for (int k = std::max(0, row - degree_); k < row; ++k) data.row(row) -= at(row, k) * data.row(k);
  }
  for (int row = size() - 1; row >= 0; --row) {
    for (int k = row + 1; k <= std::min(size() - 1, row + degree_); ++k) data.row(row) -= at(row, k) * data.row(k);
    data.row(row) /= at(row, row);
  }
}

CurveFit interpolateCurve(const Eigen::MatrixXd& data, int degree, int chord_dimensions) {
  CurveFit fit;
  fit.degree = degree;
  fit.parameters = chordParameters(data, chord_dimensions);
  fit.knots = averagedKnots(fit.parameters, degree);
  fit.control = data;
  Collocation(fit.parameters, fit.knots, degree).solve(fit.control);
  return fit;
}

GridFit interpolateGrid(const Eigen::MatrixXd& data, const std::array<int, 2>& count, const std::array<int, 2>& degree,
                        int chord_dimensions) {
  checkData(data);
  if (count[0] < 2 || count[1] < 2 || data.rows() != static_cast<Eigen::Index>(count[0]) * count[1]) {
    fail(std::to_string(data.rows()) + " data points for a grid of " + std::to_string(count[0]) + " x " +
         std::to_string(count[1]));
  }
  GridFit fit{degree, count, {}, {}, data};
  for (std::size_t a = 0; a < 2; ++a) {
    const int axis = static_cast<int>(a);
    fit.parameters[a] = gridParameters(data, count, axis, chordColumns(data, chord_dimensions));
    fit.knots[a] = averagedKnots(fit.parameters[a], degree[a]);
    const Collocation collocation(fit.parameters[a], fit.knots[a], degree[a]);
    for (int index = 0; index < count[1 - a]; ++index) {
      Eigen::MatrixXd line = gridLine(fit.control, count, axis, index);
      collocation.solve(line);
      setGridLine(fit.control, count, axis, index, line);
    }
  }
  return fit;
}

}  // namespace hapticd::spline
