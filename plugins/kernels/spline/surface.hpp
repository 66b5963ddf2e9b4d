/// Evaluation of spline surfaces of any degree to 15, polynomial or rational, with first and second derivatives.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/spline/kernel.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// A point of a surface and its partial derivatives [m, and m per unit of the parameters].
struct SurfacePoint {
  Eigen::Vector3d S, Su, Sv, Suu, Suv, Svv;
  /// In: where to look first for (u, v); out: the spans that hold them. Hand the last point in again and the look-up
  /// costs nothing while the parameters stay in their spans. Any value is allowed.
  std::array<std::int32_t, 2> span{0, 0};
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
  Surface() = default;
  /// [main] Checks and stores a surface. `kTable` is a wish: where the power basis would lose digits (weights that
  /// differ much within a span, high degrees) the surface keeps the net form; form() tells.
  /// @throws std::invalid_argument as validate() does.
  explicit Surface(const SurfaceData& data, Form form = Form::kTable);

  /// [any] S, Su, Sv at (u, v); Suu, Suv, Svv are left as they are.
  void evaluate1(double u, double v, SurfacePoint& out) const noexcept;
  /// [any] S and all first and second derivatives at (u, v). At a knot: those of the span to its right.
  /// Source: Piegl & Tiller, The NURBS Book, A2.3 and A4.4 (with the mixed derivative), about a local origin.
  void evaluate2(double u, double v, SurfacePoint& out) const noexcept;

  /// [any] Parameter range [lo, hi] along axis 0 (u) or 1 (v).
  std::array<double, 2> domain(int axis) const noexcept {
    return {axes_[static_cast<std::size_t>(axis)].breaks.front(), axes_[static_cast<std::size_t>(axis)].breaks.back()};
  }
  /// [any] The distinct knots of the domain, ascending: boundaries of the spans, smooth in between.
  std::span<const double> breaks(int axis) const noexcept { return axes_[static_cast<std::size_t>(axis)].breaks; }
  int degree(int axis) const noexcept { return axes_[static_cast<std::size_t>(axis)].degree; }
  bool rational() const noexcept { return rational_; }
  bool reversed() const noexcept { return reversed_; }
  const std::string& name() const noexcept { return name_; }
  /// [any] The form in use.
  Form form() const noexcept { return form_; }
  /// [any] Memory behind this surface, in bytes.
  std::size_t bytes() const noexcept;

 private:
  struct Axis {
    int degree = 0;
    std::vector<double> knots;
    std::vector<double> breaks;            ///< distinct knots of the domain
    std::vector<std::int32_t> first_knot;  ///< by span: index of the knot at its low end
    std::int32_t find(double t, std::int32_t hint) const noexcept;
  };
  void buildNet(const SurfaceData& data);
  template <int kOrder>
  void evaluate(double u, double v, SurfacePoint& out) const noexcept;

  std::array<Axis, 2> axes_;
  std::vector<Quad> net_;
  double scale_ = 1;  ///< a power of two: coordinates = scale_ * stored ones
  Form form_ = Form::kNet;
  bool rational_ = false, reversed_ = false;
  std::string name_;
};

}  // namespace hapticd::spline
