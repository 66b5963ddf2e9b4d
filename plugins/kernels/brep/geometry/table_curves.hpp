// SPDX-License-Identifier: MIT
/// The spline curves of a part's edges, in table form and close together. A part has many of them, and few have more
/// than two or three spans. So each one keeps only its tables, without knots or control points.
#pragma once
#include <cstdint>
#include <vector>

#include "kernels/spline/curve.hpp"

namespace hapticd::brep {

class TableCurves {
 public:
  static constexpr std::uint32_t kNotTabled = 0xffffffffu;

  /// [main] Copies a curve and returns its index, or kNotTabled if the curve has no table or is scaled.
  std::uint32_t add(const spline::Curve& curve);
  /// [any] Gives bit for bit the same result as spline::Curve::evaluate2().
  void evaluate2(std::uint32_t index, double t, spline::CurvePoint& out) const noexcept;
  /// [main] Returns the distinct knots of a curve's domain, ascending.
  std::vector<double> breaks(std::uint32_t index) const;
  /// [main] Frees spare memory.
  void shrink();
  std::size_t bytes() const noexcept { return curves_.size() * sizeof(Record) + numbers_.size() * sizeof(double); }

 private:
  struct Record {
    spline::TableKernel kernel;
    std::uint32_t first;  ///< index of its first cell in numbers_
    std::uint16_t cells;
    std::uint8_t size;    ///< coefficients of a cell
    std::uint8_t stride;  ///< numbers of a coefficient
  };
  /// Numbers before the table of a cell: the parameters of its two ends and the one about which it is expanded.
  static constexpr std::size_t kHead = 3;

  static std::size_t numbersOf(const Record& curve) noexcept {
    return kHead + (std::size_t{1} + curve.size) * curve.stride;
  }
  const double* cell(const Record& curve, std::uint32_t index) const noexcept {
    return numbers_.data() + curve.first + index * numbersOf(curve);
  }

  std::vector<Record> curves_;
  std::vector<double> numbers_;  ///< the cells; one more number follows the last one, see spline::TableKernel
};

}  // namespace hapticd::brep
