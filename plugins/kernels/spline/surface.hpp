// SPDX-License-Identifier: MIT
/// Evaluation of spline surfaces of degree 1 to 15, polynomial or rational, with first and second derivatives.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/spline/axis.hpp"
#include "kernels/spline/kernel.hpp"
#include "kernels/spline/surface_data.hpp"
#include "kernels/spline/table.hpp"

namespace hapticd::spline {

/// A point of a surface and its partial derivatives [m, and m per unit of the parameters].
struct SurfacePoint {
  alignas(32) Eigen::Vector3d S;
  alignas(32) Eigen::Vector3d Su;
  alignas(32) Eigen::Vector3d Sv;
  alignas(32) Eigen::Vector3d Suu;
  alignas(32) Eigen::Vector3d Suv;
  alignas(32) Eigen::Vector3d Svv;
  /// In: the cells to try first for u and v (any value is allowed). Out: the cells that contain them. If the last point
  /// is passed in again, the look-up costs almost nothing while the parameters stay in their spans.
  alignas(32) std::array<std::int32_t, 2> span{0, 0};
};

/// A surface that is ready for evaluation. Constant after construction, so all threads may share it. Parameters outside
/// the domain are moved to its boundary, and NaN to its low end.
class Surface {
 public:
  /// [main] Makes an empty object. Assign a surface to it before evaluation.
  Surface() = default;
  /// [main] Checks and stores a surface. kTable is only a preference: if the power basis would lose digits (weights
  /// that differ much within a span, some high degrees), the surface uses kNet. form() returns the form in use.
  /// @throws std::invalid_argument as validate() does.
  explicit Surface(const SurfaceData& data, Form form = Form::kTable,
                   Instructions instructions = Instructions::kFastest);

  /// [any] Computes S, Su, Sv at (u, v); Suu, Suv, Svv stay unchanged.
  void evaluate1(double u, double v, SurfacePoint& out) const noexcept { evaluate<1>(u, v, out); }
  /// [any] Computes S and all first and second derivatives at (u, v). At a knot, the derivatives are those of the span
  /// to its right. Source: Piegl & Tiller, The NURBS Book, A2.3 and A4.4 (with the mixed derivative). Coordinates are
  /// relative to a local origin, to keep precision.
  void evaluate2(double u, double v, SurfacePoint& out) const noexcept { evaluate<2>(u, v, out); }

  /// [any] Returns the cell that contains an evaluated point.
  TableCell cellOf(const SurfacePoint& at) const noexcept;

  /// [any] Returns the parameter range [lo, hi] along axis 0 (u) or 1 (v).
  std::array<double, 2> domain(int axis) const noexcept { return {breaks(axis).front(), breaks(axis).back()}; }
  /// [any] Returns the distinct knots of the domain, ascending. The surface is smooth between them.
  std::span<const double> breaks(int axis) const noexcept { return axes_[static_cast<std::size_t>(axis)].breaks(); }
  int degree(int axis) const noexcept { return axes_[static_cast<std::size_t>(axis)].degree(); }
  bool rational() const noexcept { return rational_; }
  bool reversed() const noexcept { return reversed_; }
  const std::string& name() const noexcept { return name_; }
  /// [any] Returns the form in use.
  Form form() const noexcept { return table_.cells.empty() ? Form::kNet : Form::kTable; }
  /// [any] Returns the memory that this surface has allocated, in bytes.
  std::size_t bytes() const noexcept;

 private:
  template <int kOrder>
  void evaluate(double u, double v, SurfacePoint& out) const noexcept {
    u = axes_[0].locate(u, out.span[0]);
    v = axes_[1].locate(v, out.span[1]);
    const Cell &cu = axes_[0].cell(out.span[0]), &cv = axes_[1].cell(out.span[1]);
    if (table_kernel_[kOrder - 1] != nullptr) {
      table_kernel_[kOrder - 1](tableCell(out), table_.size_u, table_.size_v, u - cu.origin, v - cv.origin,
                                out.S.data());
    } else {
      net_kernel_[kOrder - 1](netWindow(cu, cv), u, v, out.S.data());
    }
    if (scale_ != 1) [[unlikely]] {
      rescale(kOrder, out);
    }
  }
  const double* tableCell(const SurfacePoint& at) const noexcept {
    return table_.cells.data() + at.span[0] * table_.row_stride + at.span[1] * table_.stride;
  }
  NetWindow netWindow(const Cell& cu, const Cell& cv) const noexcept;
  void rescale(int order, SurfacePoint& out) const noexcept;

  std::array<TableKernel, 2> table_kernel_{};
  std::array<NetKernel, 2> net_kernel_{};
  std::array<Axis, 2> axes_;
  Table table_;
  std::vector<Quad> net_;  ///< empty in table form
  double scale_ = 1;       ///< a power of two: coordinates = scale_ * stored coordinates
  bool rational_ = false, reversed_ = false;
  std::string name_;
};

}  // namespace hapticd::spline
