// SPDX-License-Identifier: MIT
/// Evaluation of spline curves of degree 1 to 15, polynomial or rational, with first and second derivatives.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/spline/axis.hpp"
#include "kernels/spline/curve_data.hpp"
#include "kernels/spline/kernel.hpp"
#include "kernels/spline/table.hpp"

namespace hapticd::spline {

/// A point of a curve and its derivatives [m, m per unit of the parameter].
struct CurvePoint {
  Eigen::Vector3d C, C1, C2;
  /// In: the span to try first (any value is allowed); out: the span that contains the parameter.
  std::int32_t span = 0;
};

/// A curve that is ready for evaluation. Constant after construction, so all threads may share it. Parameters outside
/// the domain are moved to its ends, and NaN to its low end.
class Curve {
 public:
  /// [main] Checks and stores a curve. kTable is only a preference: if the power basis would lose digits (as in very
  /// narrow spans), the curve uses kNet. form() returns the form in use.
  /// @throws std::invalid_argument as validate() does.
  explicit Curve(const CurveData& data, Form form = Form::kNet, Instructions instructions = Instructions::kFastest);

  /// [any] Computes C and C1 at u; C2 stays unchanged.
  void evaluate1(double u, CurvePoint& out) const noexcept;
  /// [any] Computes C, C1 and C2 at u. At a knot, the derivatives are those of the span to its right. Source: Piegl &
  /// Tiller A3.2 and A4.2. Coordinates are relative to a local origin, to keep precision.
  void evaluate2(double u, CurvePoint& out) const noexcept;

  /// [any] Returns the parameter range [lo, hi].
  std::array<double, 2> domain() const noexcept { return {axis_.breaks().front(), axis_.breaks().back()}; }
  /// [any] Returns the distinct knots of the domain, ascending.
  std::span<const double> breaks() const noexcept { return axis_.breaks(); }
  int degree() const noexcept { return axis_.degree(); }
  bool rational() const noexcept { return rational_; }
  const std::string& name() const noexcept { return name_; }
  /// [any] Returns the form in use.
  Form form() const noexcept { return table_.cells.empty() ? Form::kNet : Form::kTable; }
  /// [any] True if coordinates are extreme, so that they are not stored in m.
  bool scaled() const noexcept { return scale_ != 1; }
  /// [any] Returns the cell of span `span`; its kernel is null if form() is not kTable. Along v it has one coefficient.
  TableCell cell(std::int32_t span) const noexcept;
  /// [any] Returns the memory that this curve has allocated, in bytes.
  std::size_t bytes() const noexcept {
    return net_.capacity() * sizeof(Quad) + table_.cells.capacity() * sizeof(double) + axis_.bytes();
  }

 private:
  void evaluate(int order, double u, std::int32_t& span, double* out) const noexcept;

  std::array<TableKernel, 2> table_kernel_{};
  std::array<NetKernel, 2> net_kernel_{};
  Axis axis_;
  Table table_;
  std::vector<Quad> net_;  ///< empty in table form
  double scale_ = 1;
  bool rational_ = false;
  std::string name_;
};

}  // namespace hapticd::spline
