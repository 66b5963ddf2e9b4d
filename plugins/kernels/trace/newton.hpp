/// Local closest point on one patch: the safeguarded Newton iteration, and the paper's one-step method as reference.
#pragma once
#include "kernels/trace/patch.hpp"
#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

/// What a track keeps from tick to tick: the last evaluated point of the patch. The first step of the next tick starts
/// from it for free, so the evaluation of a tick happens where that step lands.
struct Iterate {
  Eigen::Array2d uv{0, 0};
  spline::SurfacePoint E{};
  bool valid = false;      ///< E belongs to uv
  bool has_forms = false;  ///< and forms to E
  QuickForms forms{};
};

/// A foot on one patch.
struct LocalFoot {
  Eigen::Array2d uv{0, 0};
  alignas(32) Eigen::Vector3d S;
  alignas(32) Eigen::Vector3d Su;
  alignas(32) Eigen::Vector3d Sv;
  alignas(32) double distance = 0;  ///< [m] |p - S|
  double residual = 0;              ///< [m] estimated distance from S to the true foot
  SideMask sides = 0;               ///< sides that hold the foot and keep it from going on
  int evaluations = 0;
  bool converged = false;
  bool regular = false;  ///< the tangents certainly span a plane
};

/// [rt] Nearest point of the patch near `at`: Newton on |S(u,v) - p|^2 over the parameter rectangle. The step solves
/// the quadratic model exactly inside the rectangle, so a foot that meets a side slides along it and stops in corners;
/// a step that does not decrease the distance is shortened. Stops when the estimated error is below `tolerance` [m] or
/// after `max_evaluations`. `at` keeps the last evaluated point.
void newtonFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, double tolerance, int max_evaluations,
                LocalFoot& foot) noexcept;
inline LocalFoot newtonFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, double tolerance,
                            int max_evaluations) noexcept {
  LocalFoot foot;
  newtonFoot(patch, p, at, tolerance, max_evaluations, foot);
  return foot;
}

/// [rt] Direct parametric tracing (Thompson et al. 1999, Eq. 1-3, with the exact rational derivative instead of the
/// refined polygon's): `steps` first-order steps (tangent-plane projection), each clamped to the rectangle; fewer if
/// `max_evaluations` do not suffice. The residual is the length of the last step.
void directFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, int steps, int max_evaluations,
                LocalFoot& foot) noexcept;

}  // namespace hapticd::trace
