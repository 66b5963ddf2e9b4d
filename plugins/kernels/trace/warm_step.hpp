// SPDX-License-Identifier: MIT
/// The warm step: a fast version of the most common tick. In such a tick the last foot point is near, the next one is
/// inside the patch, and the surface between them is smooth. The code uses plain arrays, so that the same source
/// (warm_step.inl) can be compiled for every instruction set. Other files use it through newton.hpp.
#pragma once
#include <cstdint>

#include "kernels/spline/kernel.hpp"

namespace hapticd::trace {

struct WarmStepState;
enum class WarmStepResult : std::uint8_t;

/// Evaluates S, Su, Sv, Suu, Suv, Svv at (u, v) into `E`, where each vector begins spline::kOutStride numbers after the
/// one before. Stores the cell that contains (u, v) in `state`. Returns false, and changes nothing, if (u, v) is not
/// inside the patch.
using WarmStepEvaluate = bool (*)(WarmStepState& state, double u, double v, double* E) noexcept;

/// Makes one step of Newton's method from the last evaluated point toward the foot point of p.
/// @param p [m] position of the probe
/// @param tolerance2 [m^2] square of the allowed error of the foot point
/// @param uv, E, state in: the last evaluated point; out: the new one
/// @param foot out: four groups of numbers, each of which begins spline::kOutStride numbers after the one before: uv;
/// S; the outward unit normal; distance, residual and height of the probe over the tangent plane [m]
using WarmStep = WarmStepResult (*)(const double* p, double tolerance2, double* uv, double* E, WarmStepState& state,
                                    double* foot) noexcept;

/// Values of an evaluated point that the next step uses and that do not depend on the probe. They are kept from one
/// tick to the next.
struct alignas(32) WarmStepState {
  double tangents[3][4];  ///< x, y, z of Su, Sv, Suu, Suv
  double G[3];            ///< first fundamental form G11, G12, G22 [m^2]
  double shrink;          ///< 1 / |Su x Sv|
  double bend[3][2];      ///< second-order part of the gradient along u and v: coefficients of du^2, du dv, dv^2 [m^2]
  spline::TableCell cell;
  double calm2;               ///< [m^2] squared length of a step; shorter steps are not corrected to second order
  double sign;                ///< outward normal = sign * (Su x Sv), normalized
  WarmStepEvaluate evaluate;  ///< evaluates points outside `cell`
  const void* patch;
  WarmStep step;
};

enum class WarmStepResult : std::uint8_t {
  kFoot,      ///< the foot point was found, after one evaluation
  kSameFoot,  ///< the foot point was found without an evaluation, because the probe has hardly moved
  /// No step was made: the point is not regular, or the step would leave the patch or is too long to be trusted.
  kNoStep,
  kNearer,  ///< the new point is nearer than the last one, but is not the foot point yet
  kFarther  ///< the new point is farther away than the last one; E and state no longer belong to uv
};

struct WarmStepKernels {
  /// Sets the members of `state` that depend on the evaluated point E.
  void (*forms)(const double* E, WarmStepState& state) noexcept;
  WarmStep step;
};

/// [any] Returns the kernels for an instruction set.
const WarmStepKernels& warmStepKernels(spline::Instructions instructions) noexcept;

}  // namespace hapticd::trace
