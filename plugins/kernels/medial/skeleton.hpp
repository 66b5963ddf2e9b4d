// SPDX-License-Identifier: MIT
/// The skeleton of a body: a spline surface (or curve) through the centres of its spheres, with their radii beside it.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "kernels/medial/scalar_field.hpp"
#include "kernels/spline/surface.hpp"

namespace hapticd::medial {

/// Samples of a medial axis on a grid; index = i * count[1] + j. One row or one column makes a curve.
struct SkeletonGrid {
  std::array<int, 2> count{0, 0};
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> radius;           ///< [m] one per point, not negative
};

/// A foot on the skeleton: the sphere nearest to a point, or in which the point is deepest.
struct SkeletonFoot {
  double u = 0, v = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m] on the skeleton
  double radius = 0;                                  ///< [m]
  double depth = 0;                                   ///< [m] radius less the distance to the centre; > 0 inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< outward unit direction
  Eigen::Vector3d across = Eigen::Vector3d::Zero();   ///< unit Su x Sv; zero if the skeleton has no plane
  double slope = 0;                                   ///< metres of radius per metre of skeleton, if the radius counts
  double residual = 0;                                ///< [m] length of the remaining Newton step
  int evaluations = 0;
  uint32_t element = 0;  ///< for a medial mesh: the cone or slab that has the foot
  bool rim = false;      ///< on the boundary of the skeleton
  bool converged = false;
};

/// What the nearest sphere means.
enum class Envelope {
  kExact,  ///< the union of the spheres: least |Q - S| - r
  kFoot    ///< the paper's test: least |Q - S|, then its radius. Too small by 1/sqrt(1 - r'^2) where radii vary
};

/// Accuracy knobs of a warm search.
struct NewtonOptions {
  Envelope envelope = Envelope::kExact;
  double tolerance = 1e-8;  ///< [m] a Newton step shorter than this ends the search; the error left is its square
  int max_evaluations = 20;
};

/// Knots and degrees of what deforms: the control grid. A curve has one row, of degree 0.
struct ControlGrid {
  std::array<int, 2> count{0, 0}, degree{0, 0};
  std::array<std::vector<double>, 2> knots, greville;  ///< greville: parameters that control points stand for
  std::vector<Eigen::Vector3d> points;                 ///< [m]
};

/// Where radii change most along a skeleton.
struct Steepness {
  double slope = 0;     ///< metres of radius per metre of skeleton; from 1 on, neighbours enclose spheres
  double u = 0, v = 0;  ///< there
};

class Skeleton {
 public:
  /// [main] Interpolates the grid with degree at most `degree` each way.
  /// @throws std::invalid_argument for fewer than two points, unequal counts, coinciding neighbours, bad numbers.
  explicit Skeleton(const SkeletonGrid& grid, int degree = 3, spline::Form form = spline::Form::kTable);

  /// [any] The foot of p from a warm start (u, v): safeguarded Newton.
  SkeletonFoot nearest(const Eigen::Vector3d& p, double u, double v, const NewtonOptions& options) const noexcept;
  /// [any] The foot of p with no start known: Newton from the best samples of the whole skeleton.
  SkeletonFoot search(const Eigen::Vector3d& p, const NewtonOptions& options) const noexcept;
  /// [any] The paper's binary search, nested so that it also works on skew skeletons: for each of `halvings` intervals
  /// of u, as many of v. One minimum along each line is assumed.
  SkeletonFoot bisect(const Eigen::Vector3d& p, Envelope envelope, int halvings) const noexcept;
  /// [any] No point of the body is nearer to p than this [m]; 0 inside the bounding box.
  double leastDistance(const Eigen::Vector3d& p) const noexcept { return bounds_.exteriorDistance(p); }

  const spline::Surface& surface() const noexcept { return *surface_; }
  const ScalarField& radius() const noexcept { return radius_; }
  bool curve() const noexcept { return curve_; }                          ///< one row of points
  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }  ///< of all spheres
  /// [main] Checks between all points of the grid. From a slope of 1 on, spheres are inside others, and the data are
  /// not the medial axis of any body. The body is then still the union of all spheres.
  Steepness steepest() const;
  bool nested() const noexcept { return nested_; }  ///< [any] some slope is 1 or more
  const std::array<std::vector<double>, 2>& parameters() const noexcept { return parameters_; }
  double spacing() const noexcept { return spacing_; }  ///< [m] greatest distance of neighbouring points
  const ControlGrid& control() const noexcept { return control_; }
  /// [main] Frees what only set-up needs: the places of the control points.
  void trim() {
    control_.points = {};
    control_.greville = {};
  }
  std::size_t bytes() const noexcept;  ///< [any] memory behind this skeleton

 private:
  void build(const SkeletonGrid& grid, int degree, spline::Form form);
  void buildCurve(const SkeletonGrid& grid, int degree, spline::Form form);
  void measure();

  std::unique_ptr<spline::Surface> surface_;
  ScalarField radius_;
  std::array<std::vector<double>, 2> parameters_;  ///< counts of the grid's points
  ControlGrid control_;
  Eigen::AlignedBox3d bounds_;
  double spacing_ = 0;
  bool curve_ = false, nested_ = false;
};

}  // namespace hapticd::medial
