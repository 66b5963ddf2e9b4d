// SPDX-License-Identifier: MIT
/// The common tick, written for speed: the last foot is near, the next one is inside the patch, and the surface between
/// them is smooth. Plain arrays, so that one source (quick.inl) serves every instruction set; newton.hpp is the
/// interface.
#pragma once
#include <cstdint>

#include "kernels/spline/kernel.hpp"

namespace hapticd::trace {

struct QuickState;
enum class QuickResult : std::uint8_t;

/// Evaluates S, Su, Sv, Suu, Suv, Svv at (u, v) into `E`, spline::kOutStride apart, and notes the cell there. False,
/// and nothing done: not inside the patch.
using QuickEvaluate = bool (*)(QuickState& state, double u, double v, double* E) noexcept;

/// @param p [m] the probe
/// @param tolerance2 [m^2] of the foot's error
/// @param uv, E, state the last evaluated point; in and out
/// @param foot uv; S; outward unit normal; distance, residual and height of the probe over the tangent plane [m]:
/// each spline::kOutStride after the last
using QuickStep = QuickResult (*)(const double* p, double tolerance2, double* uv, double* E, QuickState& state,
                                  double* foot) noexcept;

/// What a step from an evaluated point needs and no probe changes, kept from one tick to the next.
struct alignas(32) QuickState {
  double tangents[3][4];  ///< x, y, z of Su, Sv, Suu, Suv
  double G[3];            ///< first fundamental form G11, G12, G22 [m^2]
  double shrink;          ///< 1 / |Su x Sv|
  double bend[3][2];      ///< gradient of second order along u and v, for du^2, du dv, dv^2 [m^2]
  spline::TableCell cell;
  double calm2;            ///< [m^2] a step up to this length (squared) needs no bend
  double sign;             ///< of the outward normal, on Su x Sv
  QuickEvaluate evaluate;  ///< beyond the cell
  const void* patch;
  QuickStep step;
};

enum class QuickResult : std::uint8_t {
  kFoot,      ///< found, after one evaluation
  kSameFoot,  ///< found, without an evaluation: the probe has hardly moved
  kNoStep,    ///< not tried: the point is not regular, or the step leaves the patch or is too long to be trusted
  kNearer,    ///< evaluated, and nearer than before, but no foot yet
  kFarther    ///< evaluated, but farther: E and state no longer belong to uv
};

struct QuickKernels {
  /// Fills what the state says of E.
  void (*forms)(const double* E, QuickState& state) noexcept;
  QuickStep step;
};

/// [any] The kernels asked for.
const QuickKernels& quickKernels(spline::Instructions instructions) noexcept;

}  // namespace hapticd::trace
