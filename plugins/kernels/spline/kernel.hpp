/// The innermost loops of evaluation, in plain arrays, so that one source serves every instruction set.
#pragma once
#include <cstdint>

namespace hapticd::spline {

/// A control point (x, y, z, weight) or a power-basis coefficient, one SIMD register wide.
struct alignas(32) Quad {
  double x = 0, y = 0, z = 0, w = 0;
};

/// The control points and knots that act on one span. The knot pointers point at the low end of the span.
struct NetWindow {
  const double *knots_u, *knots_v;
  const Quad* points;  ///< first control point that acts on the span
  int degree_u, degree_v;
  int stride;  ///< from one u row to the next
};

/// Writes S, Su, Sv (18 doubles with Suu, Suv, Svv for the second-order kernels), three doubles each.
using NetKernel = void (*)(const NetWindow& net, double u, double v, double* out) noexcept;

struct KernelSet {
  NetKernel net[2][2];  ///< [rational][second order]
};

/// [any] The kernels for plain hardware.
const KernelSet& portableKernels() noexcept;
/// [any] The fastest kernels that this processor runs.
const KernelSet& fastestKernels() noexcept;

}  // namespace hapticd::spline
