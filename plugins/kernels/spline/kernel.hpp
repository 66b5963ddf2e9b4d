// SPDX-License-Identifier: MIT
/// The innermost loops of evaluation, in plain arrays, so that one source serves every instruction set.
#pragma once
#include <cstdint>

namespace hapticd::spline {

/// A control point (x, y, z, weight) or a power-basis coefficient, one SIMD register wide.
struct alignas(32) Quad {
  double x = 0, y = 0, z = 0, w = 0;
};

/// Knots that act on one span of one axis.
struct KnotWindow {
  int degree;
  const double* knots;        ///< points at the low end of the span
  const double* reciprocals;  ///< 1 / (knots[r + 1] - knots[r + 1 - j]), for j = 1..degree and r = 0..j-1
};

/// Control points and knots that act on one span of a surface. A curve is a surface of degree 0 along v.
struct NetWindow {
  KnotWindow u, v;
  const Quad* points;  ///< the first control point that acts on the span
  int stride;          ///< from one u row to the next
};

/// Kernels write S, Su, Sv, those of second order Suu, Suv, Svv after them: four doubles each, the fourth of no
/// meaning, so that a vector is one store, and whatever part of it is read next comes straight from the store buffer.
inline constexpr int kOutStride = 4;
using NetKernel = void (*)(const NetWindow& net, double u, double v, double* out) noexcept;
/// `cell`: the local origin, then size_u x size_v coefficients of s^i t^j, i-major.
using TableKernel = void (*)(const Quad* cell, int size_u, int size_v, double s, double t, double* out) noexcept;

/// Parameters of one polynomial, and what evaluates it, for those who stay there for long.
struct TableCell {
  double lo[2], end[2];  ///< parameters strictly between lie in it
  double origin[2];      ///< where the coefficients are expanded
  const Quad* coefficients;
  TableKernel kernel;  ///< of second order; null if there is no table
  int size[2];
};

/// Cells of these sizes (degree + 1) have unrolled kernels; smaller degrees are padded to them with zeros.
inline constexpr int kTableShapes = 8;
inline constexpr int kTableSizes[kTableShapes][2] = {{2, 2}, {2, 3}, {3, 2}, {3, 3}, {4, 2}, {2, 4}, {4, 4}, {6, 6}};

/// What the weights of a net ask for.
enum class Weights : std::uint8_t {
  kNone,   ///< polynomial
  kMild,   ///< rational
  kSevere  ///< rational, and one weight of a span may outweigh all others together
};

struct KernelSet {
  NetKernel net[3][2];                        ///< [Weights][second order]
  TableKernel table[kTableShapes + 1][2][2];  ///< [shape, last one for all others][rational][second order]
};

/// Which of the kernels an object uses.
enum class Instructions : std::uint8_t {
  kFastest,  ///< the best that this processor runs
  kPortable  ///< plain code
};

/// [any] The kernels asked for.
const KernelSet& kernels(Instructions instructions) noexcept;

}  // namespace hapticd::spline
