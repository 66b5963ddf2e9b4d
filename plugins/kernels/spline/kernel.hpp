// SPDX-License-Identifier: MIT
/// The interface of the innermost loops of evaluation. It uses plain arrays, so that the same source can be compiled
/// for every instruction set.
#pragma once
#include <cstdint>

namespace hapticd::spline {

/// A control point (x, y, z, weight); it fills one SIMD register.
struct alignas(32) Quad {
  double x = 0, y = 0, z = 0, w = 0;
};

/// Knots that act on one span of one axis.
struct KnotWindow {
  int degree;
  const double* knots;        ///< pointer to the knot at the low end of the span
  const double* reciprocals;  ///< 1 / (knots[r + 1] - knots[r + 1 - j]), for j = 1 to degree and r = 0 to j - 1
};

/// Control points and knots that act on one span of a surface. A curve is a surface of degree 0 along v.
struct NetWindow {
  KnotWindow u, v;
  const Quad* points;  ///< the first control point that acts on the span
  int stride;          ///< number of Quads from one u row to the next
};

/// Kernels write the vectors S, Su, Sv, and kernels of second order also Suu, Suv, Svv. Each vector takes four doubles,
/// of which the fourth has no meaning. So one store writes a whole vector, and the processor's store buffer can serve
/// the next read of any of its components.
inline constexpr int kOutStride = 4;
using NetKernel = void (*)(const NetWindow& net, double u, double v, double* out) noexcept;
/// Returns how many numbers a power-basis coefficient has: x, y, z, and the weight if the surface is rational.
constexpr int tableStride(bool rational) {
  return rational ? 4 : 3;
}
/// Evaluates one cell of a table. The kernel also reads the number behind the cell. That number must exist, but does
/// not change the result.
/// @param s, t parameters, relative to the parameters about which the cell is expanded
/// @param cell the local origin, then size_u x size_v coefficients of s^i t^j, i-major, each of tableStride() numbers
using TableKernel = void (*)(const double* cell, int size_u, int size_v, double s, double t, double* out) noexcept;

/// One cell of a table, with all values that its evaluation needs. Callers that stay in a cell for many evaluations
/// keep it, so that they need not look it up again.
struct TableCell {
  double lo[2], end[2];  ///< parameters strictly between `lo` and `end` lie in the cell
  double origin[2];      ///< parameters about which the coefficients are expanded
  const double* coefficients;
  TableKernel kernel;  ///< computes up to second order; null if there is no table
  int size[2];
};

/// Sizes of cells (degree + 1 along u and along v) that have unrolled kernels. A smaller cell is padded with zeros to
/// the first of these sizes into which it fits. The sizes of 1 along v are those of curves.
inline constexpr int kTableShapes = 12;
inline constexpr int kTableSizes[kTableShapes][2] = {{4, 1}, {6, 1}, {2, 2}, {2, 3}, {3, 2}, {3, 3},
                                                     {4, 2}, {2, 4}, {4, 4}, {6, 2}, {2, 6}, {6, 6}};

/// The kind of evaluation that the weights of a net need.
enum class Weights : std::uint8_t {
  kNone,   ///< the net is polynomial
  kMild,   ///< the net is rational
  kSevere  ///< the net is rational, and one weight of a span may be larger than all others together
};

struct KernelSet {
  NetKernel net[3][2];  ///< [Weights][second order]
  /// Indices: [index in kTableSizes, or kTableShapes for other sizes][rational][second order].
  TableKernel table[kTableShapes + 1][2][2];
};

/// Which instruction set an object uses.
enum class Instructions : std::uint8_t {
  kFastest,  ///< the fastest that this processor has
  kPortable  ///< no special instructions
};

/// [any] Returns the kernels for an instruction set.
const KernelSet& kernels(Instructions instructions) noexcept;

}  // namespace hapticd::spline
