// SPDX-License-Identifier: MIT
/// A scalar field over a rectangle of parameters, such as a radius or a stiffness, that does not overshoot its samples.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace hapticd::medial {

/// An interpolation with continuous first derivatives (C1). It is never negative if the samples are not, and along a
/// grid line it stays between neighbouring samples (Fritsch & Carlson 1980). A cubic spline does not: through the radii
/// 0, 0.05, 1 it would fall to -0.27. If all samples are equal, the field stores only their value.
class ScalarField {
 public:
  ScalarField() = default;
  /// [main] Takes a sample for every pair of parameters. @throws std::invalid_argument for a negative or non-finite
  /// sample.
  ScalarField(const std::array<std::vector<double>, 2>& parameters, const std::vector<double>& samples);

  /// [main] Adds a constant >= 0 to the whole field. Larger samples would not do this, because slopes are limited near
  /// small samples.
  void raise(double constant);

  /// Value with first and second derivatives. The second derivatives jump at the samples.
  struct Value {
    double f = 0, fu = 0, fv = 0, fuu = 0, fuv = 0, fvv = 0;
  };
  /// [any] Returns the value and the first derivatives; the second derivatives are left 0.
  Value evaluate(double u, double v) const noexcept { return nodes_.empty() ? flat() : blend<1>(u, v); }
  /// [any] Returns the value with first and second derivatives.
  Value evaluate2(double u, double v) const noexcept { return nodes_.empty() ? flat() : blend<2>(u, v); }

  bool constant() const noexcept { return nodes_.empty(); }  ///< [any] true if all samples are equal
  double least() const noexcept { return range_[0]; }        ///< [any] least sample
  double greatest() const noexcept { return range_[1]; }     ///< [any] greatest sample
  std::size_t bytes() const noexcept;                        ///< [any] memory that this field has allocated

 private:
  struct Node {
    double f;
    float fu, fv;  ///< floats suffice: rounding of a slope changes the field by 1e-8 of the difference of two samples
  };
  Value flat() const noexcept { return {range_[0], 0, 0, 0, 0, 0}; }
  void limitSlopes();
  template <int kOrder>
  Value blend(double u, double v) const noexcept;

  std::array<double, 2> range_{0, 0};
  std::array<std::vector<double>, 2> parameters_;
  std::vector<Node> nodes_;  ///< empty if the field is constant
};

}  // namespace hapticd::medial
