/// The skeleton of a body: a spline surface through the centres of its spheres, with radius and material beside it.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "kernels/spline/surface.hpp"

namespace hapticd::medial {

/// Samples of a medial axis on a grid; index = i * count[1] + j.
struct SkeletonGrid {
  std::array<int, 2> count{0, 0};
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> radius;           ///< [m] one a point, not negative
};

/// A scalar over the parameter rectangle that keeps the shape of its samples: C1, never negative where they are not,
/// and between two samples of a grid line never beyond them (Fritsch & Carlson 1980). A cubic spline through radii 0,
/// 0.05, 1 falls to -0.27.
class ScalarField {
 public:
  ScalarField() = default;
  /// [main] Samples at every pair of parameters. @throws std::invalid_argument for a negative or non-finite sample.
  ScalarField(const std::array<std::vector<double>, 2>& parameters, const std::vector<double>& samples);

  /// Value and first derivatives.
  struct Value {
    double f = 0, fu = 0, fv = 0;
  };
  /// [any]
  Value evaluate(double u, double v) const noexcept;

 private:
  void limitSlopes();

  std::array<std::vector<double>, 2> parameters_;
  std::vector<Value> nodes_;
};

/// A foot on the skeleton: the sphere that comes nearest to a point, or that the point is deepest in.
struct SkeletonFoot {
  double u = 0, v = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m] on the skeleton
  double radius = 0;                                  ///< [m]
  double depth = 0;                                   ///< [m] radius less the distance to the centre; > 0 inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< outward unit direction
  int evaluations = 0;
  bool converged = false;
};

/// What the nearest sphere means.
enum class Envelope {
  kExact,  ///< the union of the spheres: least |Q - S| - r
  kFoot    ///< the paper's test: least |Q - S|, then its radius. Too small by 1/sqrt(1 - r'^2) where radii vary
};

class Skeleton {
 public:
  /// [main] Interpolates the grid with degree at most `degree` each way.
  /// @throws std::invalid_argument for fewer than 2 x 2 points, unequal counts, coinciding neighbours, bad numbers.
  explicit Skeleton(const SkeletonGrid& grid, int degree = 3);

  /// [any] The foot of p from a warm start (u, v): safeguarded Newton, at most `max_evaluations` evaluations.
  SkeletonFoot nearest(const Eigen::Vector3d& p, double u, double v, Envelope envelope,
                       int max_evaluations) const noexcept;
  /// [sim] The foot of p with no start known: Newton from the best samples of the whole skeleton.
  SkeletonFoot search(const Eigen::Vector3d& p, Envelope envelope) const noexcept;

  const spline::Surface& surface() const noexcept { return *surface_; }
  const ScalarField& radius() const noexcept { return radius_; }

 private:
  struct Sample {
    Eigen::Vector3d center;
    double radius, u, v;
  };
  void sample();

  std::unique_ptr<spline::Surface> surface_;
  ScalarField radius_;
  std::array<std::vector<double>, 2> parameters_;
  std::vector<Sample> samples_;
};

}  // namespace hapticd::medial
