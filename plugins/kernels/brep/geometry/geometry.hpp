// SPDX-License-Identifier: MIT
/// Evaluation of the surfaces and curves of a part, for all kinds.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/brep/geometry/plane_spline.hpp"
#include "kernels/brep/geometry/table_curves.hpp"
#include "kernels/part/part.hpp"
#include "kernels/spline/curve.hpp"
#include "kernels/spline/surface.hpp"

namespace hapticd::brep {

inline Eigen::Vector3d vec(const Vector& v) {
  return {v[0], v[1], v[2]};
}
inline Eigen::Vector2d vec(const Vector2& v) {
  return {v[0], v[1]};
}

/// [any] Returns the corners of a triangle of a mesh.
inline std::array<Eigen::Vector3d, 3> cornersOf(const Part& part, std::uint32_t triangle) noexcept {
  const auto& corner = part.triangles[triangle].corner;
  return {vec(part.points[corner[0]]), vec(part.points[corner[1]]), vec(part.points[corner[2]])};
}

/// A point of a curve in the parameter plane, and its derivative.
struct PlanePoint {
  Eigen::Vector2d c, c1;
};

/// [any] Copies a B-spline of a part into the form that the spline kernel takes. Only for records of kind kSpline.
spline::SurfaceData splineOf(const Part& part, const Surface& surface);
spline::CurveData splineOf(const Part& part, const Curve3& curve);

/// Evaluates all surfaces and curves of one part. Constant after construction, so all threads may share it.
class Geometry {
 public:
  /// [main] The part must have passed checkPart() and must outlive this object. @throws std::bad_alloc
  Geometry(const Part& part, spline::Form form);

  /// [any] Point and derivatives to second order. For an offset surface the first derivatives are exact, but the second
  /// derivatives are those of its basis surface.
  void surface(std::uint32_t index, double u, double v, spline::SurfacePoint& out) const noexcept;
  /// [any] Point and derivatives to second order.
  void curve(std::uint32_t index, double t, spline::CurvePoint& out) const noexcept;
  /// [any] Point and first derivative of a curve in a parameter plane.
  PlanePoint planeCurve(std::uint32_t index, double t) const noexcept;
  /// [any] Returns Su x Sv of a face's surface with length 1; it may point inward. If the tangents vanish there,
  /// returns the normal at a point nearer to the middle of the face, or 0 if the tangents vanish there too.
  Eigen::Vector3d normal(const Face& face, const Eigen::Vector2d& uv) const noexcept;

  /// [any] The index must be that of a surface of kind kSpline.
  const spline::Surface& splineSurface(std::uint32_t index) const noexcept {
    return spline_surfaces_[static_cast<std::size_t>(surface_slot_[index])];
  }
  /// [main] Returns the distinct knots of a curve, ascending; empty if the curve is not a spline.
  std::vector<double> curveKnots(std::uint32_t index) const;
  /// [main] Returns the distinct knots of a curve in a parameter plane; empty if the curve is not a spline.
  std::vector<double> planeKnots(std::uint32_t index) const;
  const Part& part() const noexcept { return part_; }
  std::size_t bytes() const noexcept;

 private:
  void offset(const Surface& s, double u, double v, spline::SurfacePoint& out) const noexcept;

  const Part& part_;
  std::vector<spline::Surface> spline_surfaces_;
  TableCurves table_curves_;
  std::vector<spline::Curve> spline_curves_;  ///< those that have no table
  std::vector<PlaneSpline> plane_splines_;
  std::vector<std::int32_t> surface_slot_, plane_slot_;
  /// For each curve that is a spline: its index in table_curves_, or ~(its index in spline_curves_).
  std::vector<std::int32_t> curve_slot_;
};

}  // namespace hapticd::brep
