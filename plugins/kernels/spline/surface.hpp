// SPDX-License-Identifier: MIT
/// Evaluation of spline surfaces of any degree to 15, polynomial or rational, with first and second derivatives.
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
  /// In: where to look first for (u, v); out: the cells that hold them. Hand the last point in again and the look-up
  /// costs nothing while the parameters stay in their spans. Any value is allowed.
  alignas(32) std::array<std::int32_t, 2> span{0, 0};
};

/// How a surface is stored.
enum class Form : std::uint8_t {
  kTable,  ///< power-basis coefficients for each knot span: fastest
  kNet     ///< control points alone (Cox-de Boor): smallest, and exact to rounding for any weights
};

/// A surface ready for evaluation; constant after construction, so that all threads may share it.
/// Parameters outside the domain, and those that are not a number, are moved to its boundary.
class Surface {
 public:
  /// [main] A surface of no extent at the origin; assign a real one before evaluation.
  Surface() = default;
  /// [main] Checks and stores a surface. `kTable` is a wish: where the power basis would lose digits (weights that
  /// differ much within a span, some high degrees) the surface keeps the net form; form() tells.
  /// @throws std::invalid_argument as validate() does.
  explicit Surface(const SurfaceData& data, Form form = Form::kTable,
                   Instructions instructions = Instructions::kFastest);

  /// [any] S, Su, Sv at (u, v); Suu, Suv, Svv are left as they are.
  void evaluate1(double u, double v, SurfacePoint& out) const noexcept { evaluate<1>(u, v, out); }
  /// [any] S and all first and second derivatives at (u, v). At a knot: those of the span to its right.
  /// Source: Piegl & Tiller, The NURBS Book, A2.3 and A4.4 (with the mixed derivative), about a local origin.
  void evaluate2(double u, double v, SurfacePoint& out) const noexcept { evaluate<2>(u, v, out); }

  /// [any] The cell that holds an evaluated point.
  TableCell cellOf(const SurfacePoint& at) const noexcept;

  /// [any] Parameter range [lo, hi] along axis 0 (u) or 1 (v).
  std::array<double, 2> domain(int axis) const noexcept { return {breaks(axis).front(), breaks(axis).back()}; }
  /// [any] The distinct knots of the domain, ascending: boundaries of the spans, smooth in between.
  std::span<const double> breaks(int axis) const noexcept { return axes_[static_cast<std::size_t>(axis)].breaks(); }
  int degree(int axis) const noexcept { return axes_[static_cast<std::size_t>(axis)].degree(); }
  bool rational() const noexcept { return rational_; }
  bool reversed() const noexcept { return reversed_; }
  const std::string& name() const noexcept { return name_; }
  /// [any] The form in use.
  Form form() const noexcept { return table_.cells.empty() ? Form::kNet : Form::kTable; }
  /// [any] Memory behind this surface, in bytes.
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
  const Quad* tableCell(const SurfacePoint& at) const noexcept {
    return table_.cells.data() + at.span[0] * table_.row_stride + at.span[1] * table_.stride;
  }
  NetWindow netWindow(const Cell& cu, const Cell& cv) const noexcept;
  void rescale(int order, SurfacePoint& out) const noexcept;

  std::array<TableKernel, 2> table_kernel_{};
  std::array<NetKernel, 2> net_kernel_{};
  std::array<Axis, 2> axes_;
  Table table_;
  std::vector<Quad> net_;  ///< empty in table form
  double scale_ = 1;       ///< a power of two: coordinates = scale_ * stored ones
  bool rational_ = false, reversed_ = false;
  std::string name_;
};

}  // namespace hapticd::spline
