// SPDX-License-Identifier: MIT
/// The warm step, a fast version of the tick that is most common: the last foot is near, the next foot is inside the
/// patch, and the surface between them is smooth. It uses plain arrays, so that the same source (warm_step.inl) can be
/// compiled for every instruction set. Other files use it through newton.hpp.
#pragma once
#include <cstdint>

#include "kernels/spline/kernel.hpp"

namespace hapticd::trace {

struct WarmStepState;
enum class WarmStepResult : std::uint8_t;

/// Evaluates S, Su, Sv, Suu, Suv, Svv at (u, v) into `E`, spline::kOutStride apart, and stores the cell there in
/// `state`. Returns false, and changes nothing, if (u, v) is not inside the patch.
using WarmStepEvaluate = bool (*)(WarmStepState& state, double u, double v, double* E) noexcept;

/// Makes one step of Newton's method from the last evaluated point toward the foot of p.
/// @param p [m] position of the probe
/// @param tolerance2 [m^2] square of the allowed error of the foot
/// @param uv, E, state in: the last evaluated point; out: the new one
/// @param foot becomes uv; S; the outward unit normal; then distance, residual and height of the probe over the tangent
/// plane [m]. Each of the four groups begins spline::kOutStride after the one before
using WarmStep = WarmStepResult (*)(const double* p, double tolerance2, double* uv, double* E, WarmStepState& state,
                                    double* foot) noexcept;

/// What a step from an evaluated point needs and what does not depend on the probe. It is kept from one tick to the
/// next.
struct alignas(32) WarmStepState {
  double tangents[3][4];  ///< x, y, z of Su, Sv, Suu, Suv
  double G[3];            ///< first fundamental form G11, G12, G22 [m^2]
  double shrink;          ///< 1 / |Su x Sv|
  double bend[3][2];      ///< second-order part of the gradient along u and v: coefficients of du^2, du dv, dv^2 [m^2]
  spline::TableCell cell;
  double calm2;               ///< [m^2] square of a length; a shorter step is not bent (corrected to second order)
  double sign;                ///< outward normal = sign * (Su x Sv), normalized
  WarmStepEvaluate evaluate;  ///< used outside the cell
  const void* patch;
  WarmStep step;
};

enum class WarmStepResult : std::uint8_t {
  kFoot,      ///< the foot was found, after one evaluation
  kSameFoot,  ///< the foot was found without an evaluation, because the probe has hardly moved
  /// No step was made: the point is not regular, or the step would leave the patch or is too long to be trusted.
  kNoStep,
  kNearer,  ///< the new point is nearer than before, but is not the foot yet
  kFarther  ///< the new point is farther; E and state no longer belong to uv
};

struct WarmStepKernels {
  /// Sets the members of `state` that depend on the evaluated point E.
  void (*forms)(const double* E, WarmStepState& state) noexcept;
  WarmStep step;
};

/// [any] Returns the kernels for an instruction set.
const WarmStepKernels& warmStepKernels(spline::Instructions instructions) noexcept;

}  // namespace hapticd::trace
