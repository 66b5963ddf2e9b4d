// SPDX-License-Identifier: MIT
/// The skeleton of a body: a spline surface (or curve) through the centres of its spheres, and a field of their radii.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "kernels/medial/scalar_field.hpp"
#include "kernels/spline/surface.hpp"

namespace hapticd::medial {

/// Samples of a medial axis on a grid. The index of a point is i * count[1] + j. One row or one column makes a curve.
struct SkeletonGrid {
  std::array<int, 2> count{0, 0};
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> radius;           ///< [m] one per point, not negative
  /// [m] added to the radii everywhere: a point then feels what a ball of this radius feels on the body itself
  double ball = 0;
};

/// A foot on the skeleton: the sphere that is nearest to a given point, or the sphere in which the point lies deepest.
struct SkeletonFoot {
  double u = 0, v = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m] centre of the sphere, a point of the skeleton
  double radius = 0;                                  ///< [m] radius of the sphere
  double depth = 0;                                   ///< [m] radius minus the distance to the centre; > 0 inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< outward unit direction
  /// unit vector along Su x Sv; zero if the skeleton has no tangent plane there
  Eigen::Vector3d across = Eigen::Vector3d::Zero();
  /// change of the radius per metre of skeleton; 0 if the search ignored the radius
  double slope = 0;
  double residual = 0;  ///< [m] length of the remaining Newton step
  int evaluations = 0;
  uint32_t element = 0;  ///< for a medial mesh: the cone or slab on which the foot lies
  bool rim = false;      ///< the foot lies on the boundary of the skeleton
  bool converged = false;
};

/// Which sphere counts as nearest to a point Q. S is a point of the skeleton, and r is the radius there.
enum class Envelope {
  kExact,  ///< the sphere with the least |Q - S| - r: the body is the union of the spheres
  /// the test of Corso et al. 2002: the sphere at the S with the least |Q - S|. Where radii vary, the body is too small
  /// by the factor 1/sqrt(1 - r'^2)
  kFoot
};

/// Accuracy of a search that starts from a known foot.
struct NewtonOptions {
  Envelope envelope = Envelope::kExact;
  /// [m] the search ends at a Newton step shorter than this; the remaining error is of the order of its square
  double tolerance = 1e-8;
  int max_evaluations = 20;
};

/// The control points that a deformation moves, with knots and degrees. A curve has one row, of degree 0.
struct ControlGrid {
  std::array<int, 2> count{0, 0}, degree{0, 0};
  /// greville: the parameter at which each control point acts most (its Greville abscissa)
  std::array<std::vector<double>, 2> knots, greville;
  std::vector<Eigen::Vector3d> points;  ///< [m]
};

/// The point of a skeleton at which the radius changes fastest.
struct Steepness {
  double slope = 0;     ///< change of the radius per metre of skeleton; from 1 on, spheres lie inside their neighbours
  double u = 0, v = 0;  ///< parameters of that place
};

class Skeleton {
 public:
  /// [main] Interpolates the grid with a degree of at most `degree` along each direction.
  /// @throws std::invalid_argument for fewer than two points, unequal counts, coinciding neighbours, bad numbers.
  explicit Skeleton(const SkeletonGrid& grid, int degree = 3, spline::Form form = spline::Form::kTable);

  /// [any] Returns the foot of p by a safeguarded Newton iteration that starts at (u, v), such as the foot of the last
  /// tick.
  SkeletonFoot nearest(const Eigen::Vector3d& p, double u, double v, const NewtonOptions& options) const noexcept;
  /// [any] Returns the foot of p if no start is known: Newton iterations from the best samples of the whole skeleton.
  SkeletonFoot search(const Eigen::Vector3d& p, const NewtonOptions& options) const noexcept;
  /// [any] Returns the foot of p by the binary search of Corso et al. 2002. The search is nested, so that it also works
  /// on skew skeletons: in each of the `halvings` steps along u it makes as many steps along v. It assumes that there
  /// is one minimum along each line.
  SkeletonFoot bisect(const Eigen::Vector3d& p, Envelope envelope, int halvings) const noexcept;
  /// [any] Returns a lower bound of the distance from p to the body [m]; 0 inside the bounding box.
  double leastDistance(const Eigen::Vector3d& p) const noexcept { return bounds_.exteriorDistance(p); }

  const spline::Surface& surface() const noexcept { return *surface_; }
  const ScalarField& radius() const noexcept { return radius_; }
  /// [any] Returns true if the grid has only one row of points.
  bool curve() const noexcept { return curve_; }
  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }  ///< box of all spheres
  /// [main] Returns the greatest slope of the radius, found at samples between all points of the grid. From a slope of
  /// 1 on, some spheres lie inside others, and the data are not the medial axis of any body. The body is then still the
  /// union of all spheres.
  Steepness steepest() const;
  bool nested() const noexcept { return nested_; }  ///< [any] true if the slope of the radius is 1 or more somewhere
  const std::array<std::vector<double>, 2>& parameters() const noexcept { return parameters_; }
  double spacing() const noexcept { return spacing_; }  ///< [m] greatest distance of neighbouring points
  const ControlGrid& control() const noexcept { return control_; }
  /// [main] Frees the memory that only set-up needs: the positions and parameters of the control points.
  void trim() {
    control_.points = {};
    control_.greville = {};
  }
  std::size_t bytes() const noexcept;  ///< [any] memory that this skeleton has allocated

 private:
  void build(const SkeletonGrid& grid, int degree, spline::Form form);
  void buildCurve(const SkeletonGrid& grid, int degree, spline::Form form);
  void measure();

  std::unique_ptr<spline::Surface> surface_;
  ScalarField radius_;
  std::array<std::vector<double>, 2> parameters_;  ///< parameters of the grid's rows and columns
  ControlGrid control_;
  Eigen::AlignedBox3d bounds_;
  double spacing_ = 0;
  bool curve_ = false, nested_ = false;
};

}  // namespace hapticd::medial
