// SPDX-License-Identifier: MIT
/// Inserts knots along one axis, at once for all lines of control points that run along this axis.
#pragma once
#include <vector>

#include "kernels/spline/curve_data.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// The control points of a curve (one line) or of a surface (one line for each control point across the axis). Points
/// are not multiplied by their weights. So a step of knot insertion is a weighted mean of two points, and the mean of
/// two equal points is exactly that point. Therefore collapsed sides stay collapsed bit for bit.
class LineSet {
 public:
  explicit LineSet(const CurveData& curve);
  LineSet(const SurfaceData& surface, int axis);

  /// Inserts knot t once. Source: Boehm's algorithm, Piegl & Tiller (5.15).
  void insert(double t);
  /// Raises the multiplicity of t to at least `multiplicity`.
  void raise(double t, int multiplicity);
  /// Returns the part from lo to hi, clamped at both ends, with unchanged parameters.
  LineSet part(double lo, double hi) const;

  int degree() const noexcept { return degree_; }
  std::array<double, 2> domain() const noexcept;
  /// Returns how often t occurs in the knots.
  int multiplicity(double t) const noexcept;
  /// Returns the distinct knots of the domain.
  std::vector<double> breaks() const;

  CurveData curve(std::string name) const;
  /// Returns the lines as a surface. The other axis, the name and the outward side are copied from `like`.
  SurfaceData surface(const SurfaceData& like, int axis) const;

 private:
  LineSet() = default;
  std::size_t count() const noexcept { return knots_.size() - static_cast<std::size_t>(degree_) - 1; }

  int degree_ = 1;
  std::size_t lines_ = 1;
  std::vector<double> knots_;
  std::vector<Eigen::Vector3d> points_;  ///< point i of line l at i * lines_ + l
  std::vector<double> weights_;
};

}  // namespace hapticd::spline
