// SPDX-License-Identifier: MIT
#include "kernels/brep/geometry/table_curves.hpp"

#include <algorithm>
#include <limits>

#include "kernels/spline/surface.hpp"

namespace hapticd::brep {

std::uint32_t TableCurves::add(const spline::Curve& curve) {
  const std::size_t cells = curve.breaks().size() - 1;
  if (curve.form() != spline::Form::kTable || curve.scaled() || cells > std::numeric_limits<std::uint16_t>::max() ||
      numbers_.size() > std::numeric_limits<std::uint32_t>::max())
    return kNotTabled;
  if (!numbers_.empty()) numbers_.pop_back();  // the number behind the last cell
  const spline::TableCell first = curve.cell(0);
  const Record made{first.kernel, static_cast<std::uint32_t>(numbers_.size()), static_cast<std::uint16_t>(cells),
                    static_cast<std::uint8_t>(first.size[0]),
                    static_cast<std::uint8_t>(spline::tableStride(curve.rational()))};
  for (std::size_t i = 0; i < cells; ++i) {
    const spline::TableCell cell = curve.cell(static_cast<std::int32_t>(i));
    const double end = i + 1 < cells ? cell.end[0] : curve.domain()[1];  // the last cell goes on beyond the domain
    numbers_.insert(numbers_.end(), {cell.lo[0], end, cell.origin[0]});
    numbers_.insert(numbers_.end(), cell.coefficients, cell.coefficients + (numbersOf(made) - kHead));
  }
  numbers_.push_back(0);
  curves_.push_back(made);
  return static_cast<std::uint32_t>(curves_.size() - 1);
}

void TableCurves::evaluate2(std::uint32_t index, double t, spline::CurvePoint& out) const noexcept {
  const Record& curve = curves_[index];
  const std::uint32_t last = curve.cells - 1u;
  const double low = *cell(curve, 0), high = cell(curve, last)[1];
  if (!(t > low)) t = low;
  t = std::min(t, high);
  auto span = static_cast<std::uint32_t>(out.span);
  if (span > last || !(cell(curve, span)[0] <= t && t < cell(curve, span)[1])) {
    std::uint32_t from = 0, to = last;  // the cell with the greatest low end that is not above t
    while (from < to) {
      const std::uint32_t middle = (from + to + 1) / 2;
      if (*cell(curve, middle) <= t)
        from = middle;
      else
        to = middle - 1;
    }
    span = from;
  }
  out.span = static_cast<std::int32_t>(span);
  const double* at = cell(curve, span);
  spline::SurfacePoint point;  // the kernels evaluate surfaces; this one does not depend on v
  curve.kernel(at + kHead, curve.size, 1, t - at[2], 0, point.S.data());
  out.C = point.S;
  out.C1 = point.Su;
  out.C2 = point.Suu;
}

std::vector<double> TableCurves::breaks(std::uint32_t index) const {
  const Record& curve = curves_[index];
  std::vector<double> found;
  for (std::uint32_t i = 0; i < curve.cells; ++i) found.push_back(*cell(curve, i));
  found.push_back(cell(curve, curve.cells - 1u)[1]);
  return found;
}

void TableCurves::shrink() {
  curves_.shrink_to_fit();
  numbers_.shrink_to_fit();
}

}  // namespace hapticd::brep
