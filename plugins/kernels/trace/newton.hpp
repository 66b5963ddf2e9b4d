// SPDX-License-Identifier: MIT
/// Local closest point on one patch: the safeguarded Newton iteration, and the paper's one-step method as reference.
#pragma once
#include <cstdint>
#include <limits>

#include "kernels/trace/patch.hpp"
#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

/// What a track keeps from tick to tick: the last evaluated point of the patch. The first step of the next tick starts
/// from it for free, so the evaluation of a tick happens where that step lands.
struct Iterate {
  enum class Known : std::uint8_t {
    kParameters,  ///< uv
    kPoint,       ///< and E, the point there
    kAll          ///< and the state, which belongs to E
  };
  Eigen::Array2d uv{0, 0};
  spline::SurfacePoint E{};
  Known known = Known::kParameters;
  QuickState state{};
};

/// A foot on one patch. QuickKernels::foot fills it as far as `height`.
struct LocalFoot {
  alignas(32) Eigen::Array2d uv{0, 0};
  alignas(32) Eigen::Vector3d S;
  alignas(32) Eigen::Vector3d normal;  ///< outward, unit
  alignas(32) double distance = 0;     ///< [m] |p - S|
  double residual = 0;                 ///< [m] estimated distance from S to the true foot
  double height = 0;                   ///< [m] of the probe over the tangent plane
  SideMask sides = 0;                  ///< sides that hold the foot and keep it from going on
  int evaluations = 0;
  bool converged = false;
  bool regular = false;  ///< the tangents span a plane; if not, normal and height mean nothing
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Rounding of coordinates, relative to their size, in the difference of two points.
inline constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();

/// [rt] Parts of newtonFoot that the common tick does without. The first makes ready for quick steps, the second counts
/// one that found no foot and says whether another makes sense, the third finds the foot from any point.
void startNewton(const Patch& patch, Iterate& at, LocalFoot& foot) noexcept;
bool mayStepAgain(const Patch& patch, QuickResult result, Iterate& at, LocalFoot& foot) noexcept;
void descend(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, double tolerance, int max_evaluations,
             LocalFoot& foot) noexcept;

/// [rt] Nearest point of the patch near `at`: Newton on |S(u,v) - p|^2 over the parameter rectangle. The step solves
/// the quadratic model exactly inside the rectangle, so a foot that meets a side slides along it and stops in corners;
/// a step that does not decrease the distance is shortened. Stops when the estimated error is below `tolerance` [m] or
/// after `max_evaluations`. `at` keeps the last evaluated point.
inline void newtonFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, double tolerance, int max_evaluations,
                       LocalFoot& foot) noexcept {
  constexpr int kQuickSteps = 3;
  foot.evaluations = 0;
  if (at.known != Iterate::Known::kAll) [[unlikely]]
    startNewton(patch, at, foot);
  const bool precise = p.lpNorm<1>() * kRounding <= tolerance;
  for (int i = 0; precise && i < kQuickSteps && foot.evaluations + 2 <= max_evaluations; ++i) {
    const QuickResult result =
        at.state.step(p.data(), tolerance * tolerance, at.uv.data(), at.E.S.data(), at.state, foot.uv.data());
    if (result == QuickResult::kFoot || result == QuickResult::kSameFoot) [[likely]] {
      foot.evaluations += result == QuickResult::kFoot;
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

/// [rt] Direct parametric tracing (Thompson et al. 1999, Eq. 1-3, with the exact rational derivative instead of the
/// refined polygon's): `steps` first-order steps (tangent-plane projection), each clamped to the rectangle; fewer if
/// `max_evaluations` do not suffice. The residual is the length of the last step.
void directFoot(const Patch& patch, const Eigen::Vector3d& p, Iterate& at, int steps, int max_evaluations,
                LocalFoot& foot) noexcept;

}  // namespace hapticd::trace
