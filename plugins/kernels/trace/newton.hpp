// SPDX-License-Identifier: MIT
/// The closest point on one patch near a given point: the safeguarded Newton iteration, and direct parametric tracing
/// (Thompson et al. 1999) as reference.
#pragma once
#include <cstdint>
#include <limits>

#include "kernels/trace/patch.hpp"
#include "kernels/trace/warm_step.hpp"

namespace hapticd::trace {

/// The point of a patch that was evaluated last. A track keeps it from tick to tick. A tick makes its first Newton step
/// from this point without a new evaluation, and then evaluates the surface at the end of the step.
struct Iterate {
  enum class Known : std::uint8_t {
    kParameters,  ///< only uv is known
    kPoint,       ///< uv and E, the point there, are known
    kAll          ///< uv, E and the `state` of E are known
  };
  Eigen::Array2d uv{0, 0};
  spline::SurfacePoint E{};
  Known known = Known::kParameters;
  WarmStepState state{};
};

/// A foot point on one patch. WarmStepState::step writes the members from `uv` to `height`, in this order.
struct LocalFoot {
  alignas(32) Eigen::Array2d uv{0, 0};
  alignas(32) Eigen::Vector3d S;
  alignas(32) Eigen::Vector3d normal;  ///< outward, unit
  alignas(32) double distance = 0;     ///< [m] |p - S|
  double residual = 0;                 ///< [m] estimated distance from S to the true foot
  double height = 0;                   ///< [m] height of the probe over the tangent plane
  SideMask sides = 0;  ///< sides that stop the foot point: beyond them the distance would become smaller
  int evaluations = 0;
  bool converged = false;
  /// true if the tangents at the foot point span a plane; if false, normal and height have no meaning
  bool regular = false;
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Rounding error of the difference of two points, relative to the size of the coordinates.
inline constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();

/// [rt] The parts of newtonFoot() that most ticks do not need. startNewton() evaluates `at`, so that warm steps can
/// begin there. mayStepAgain() counts the evaluations of a warm step that did not find the foot point, and returns true
/// if another warm step may help. descend() finds the foot point from any start.
void startNewton(const Patch& patch, Iterate& at, LocalFoot& foot) noexcept;
bool mayStepAgain(const Patch& patch, WarmStepResult result, Iterate& at, LocalFoot& foot) noexcept;
void descend(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, double tolerance, int max_evaluations,
             LocalFoot& foot) noexcept;

/// [rt] Finds the point of the patch near `at` that is nearest to p, by Newton's method on |S(u,v) - p|^2 over the
/// parameter rectangle. Each step solves the quadratic model exactly inside the rectangle. So a foot point that meets a
/// side slides along this side and stops in corners. A step that does not decrease the distance is shortened. The
/// search stops when the estimated error is below `tolerance` [m] or after `max_evaluations`. `at` becomes the point
/// that was evaluated last.
inline void newtonFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, double tolerance, int max_evaluations,
                       LocalFoot& foot) noexcept {
  constexpr int kWarmSteps = 3;
  foot.evaluations = 0;
  if (at.known != Iterate::Known::kAll) [[unlikely]]
    startNewton(patch, at, foot);
  const bool precise = p.lpNorm<1>() * kRounding <= tolerance;
  for (int i = 0; precise && i < kWarmSteps && foot.evaluations + 2 <= max_evaluations; ++i) {
    const WarmStepResult result =
        at.state.step(p.data(), tolerance * tolerance, at.uv.data(), at.E.S.data(), at.state, foot.uv.data());
    if (result == WarmStepResult::kFoot || result == WarmStepResult::kSameFoot) [[likely]] {
      foot.evaluations += result == WarmStepResult::kFoot;
      foot.sides = 0;
      foot.converged = foot.regular = true;
      return;
    }
    if (!mayStepAgain(patch, result, at, foot)) break;
  }
  descend(patch, p, at, tolerance, max_evaluations, foot);
}
inline LocalFoot newtonFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, double tolerance,
                            int max_evaluations) noexcept {
  LocalFoot foot;
  newtonFoot(patch, p, at, tolerance, max_evaluations, foot);
  return foot;
}

/// [rt] Finds a foot by direct parametric tracing (Thompson et al. 1999, Eq. 1-3, with the exact rational derivative
/// instead of that of the refined polygon). It makes `steps` first-order steps (projection onto the tangent plane),
/// each clamped to the rectangle, or fewer if `max_evaluations` is reached. The residual is the length of the last
/// step.
void directFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, int steps, int max_evaluations,
                LocalFoot& foot) noexcept;

}  // namespace hapticd::trace
