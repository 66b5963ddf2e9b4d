// SPDX-License-Identifier: MIT
/// Evaluation of the surfaces and curves of a part, of every kind.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kernels/brep/part.hpp"
#include "kernels/spline/curve.hpp"
#include "kernels/spline/surface.hpp"

namespace hapticd::brep {

inline Eigen::Vector3d vec(const Vector& v) {
  return {v[0], v[1], v[2]};
}
inline Eigen::Vector2d vec(const Vector2& v) {
  return {v[0], v[1]};
}

/// A point of a curve in the parameter plane, and its derivative.
struct PlanePoint {
  Eigen::Vector2d c, c1;
};

/// [any] A B-spline of a part as the spline kernel wants it. Only for records of kind kSpline.
spline::SurfaceData splineOf(const Part& part, const Surface& surface);
spline::CurveData splineOf(const Part& part, const Curve3& curve);

/// Constant after construction: all threads may share it.
class Geometry {
 public:
  /// [main] For a part that checkPart() passed; the part must outlive it. @throws std::bad_alloc
  Geometry(const Part& part, spline::Form form);

  /// [any] Point and derivatives to second order. Of an offset the first derivatives are exact, the second ones those
  /// of its basis.
  void surface(std::uint32_t index, double u, double v, spline::SurfacePoint& out) const noexcept;
  /// [any] Point and derivatives to second order.
  void curve(std::uint32_t index, double t, spline::CurvePoint& out) const noexcept;
  /// [any] Point and first derivative of a curve in a parameter plane.
  PlanePoint planeCurve(std::uint32_t index, double t) const noexcept;
  /// [any] Unit Su x Sv of a face's surface, whichever side is out. Where the tangents vanish: the normal a little
  /// nearer to the middle of the face, 0 if there is none either.
  Eigen::Vector3d normal(const Face& face, const Eigen::Vector2d& uv) const noexcept;

  /// [any] Only for splines.
  const spline::Surface& splineSurface(std::uint32_t index) const noexcept {
    return spline_surfaces_[static_cast<std::size_t>(surface_slot_[index])];
  }
  const spline::Curve& splineCurve(std::uint32_t index) const noexcept {
    return spline_curves_[static_cast<std::size_t>(curve_slot_[index])];
  }
  /// [any] The distinct knots of a curve in a parameter plane; empty if it is not a spline.
  std::span<const double> planeKnots(std::uint32_t index) const noexcept;
  const Part& part() const noexcept { return part_; }
  std::size_t bytes() const noexcept;

 private:
  void offset(const Surface& s, double u, double v, spline::SurfacePoint& out) const noexcept;

  const Part& part_;
  std::vector<spline::Surface> spline_surfaces_;
  std::vector<spline::Curve> spline_curves_, plane_splines_;
  std::vector<std::int32_t> surface_slot_, curve_slot_, plane_slot_;
};

}  // namespace hapticd::brep
