/// The common tick, written for speed: the last foot is near, the next one is inside the patch, and the surface between
/// them is smooth. Plain arrays, so that one source (quick.inl) serves every instruction set; newton.hpp is the
/// interface.
#pragma once
#include <cstdint>

#include "kernels/spline/kernel.hpp"

namespace hapticd::trace {

/// What a step from an evaluated point needs and no probe changes, kept from one tick to the next.
struct alignas(32) QuickForms {
  double tangents[3][4];  ///< x, y, z of Su, Sv, Suu, Suv
  double G[3];            ///< first fundamental form G11, G12, G22 [m^2]
  double bend[3][2];      ///< gradient of second order along u and v, for du^2, du dv, dv^2 [m^2]
};

/// Evaluates S, Su, Sv, Suu, Suv, Svv of a patch at (u, v) into `point`, spline::kOutStride apart.
using QuickEvaluate = void (*)(const void* patch, double u, double v, double* point) noexcept;

struct QuickTask {
  const void* patch;
  QuickEvaluate evaluate;
  const double* p;        ///< [m] the probe
  const double *lo, *hi;  ///< bounds of u, v
  double tolerance2;      ///< [m^2] of the foot's error
};

/// The last evaluated point; in and out.
struct QuickPoint {
  double* uv;
  double* E;  ///< as `evaluate` writes it
  QuickForms* forms;
};

/// Out.
struct QuickFoot {
  double* uv;
  double* S;         ///< S, Su, Sv, spline::kOutStride apart
  double* distance;  ///< [m]; the residual [m] follows it
};

enum class QuickResult : std::uint8_t {
  kFoot,      ///< found, after one evaluation
  kSameFoot,  ///< found, without an evaluation: the probe has hardly moved
  kNoStep,    ///< not tried: the point is not regular, or the step leaves the patch or is too long to be trusted
  kNearer,    ///< evaluated, and nearer than before, but no foot yet
  kFarther    ///< evaluated, but farther: E and forms no longer belong to uv
};

struct QuickKernels {
  void (*forms)(const double* E, QuickForms& forms) noexcept;
  QuickResult (*foot)(const QuickTask& task, const QuickPoint& at, const QuickFoot& foot) noexcept;
};

/// [any] The kernels asked for.
const QuickKernels& quickKernels(spline::Instructions instructions) noexcept;

}  // namespace hapticd::trace
