// SPDX-License-Identifier: MIT
#include "kernels/spline/curve.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/spline/net.hpp"
#include "kernels/spline/surface.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {
namespace {

/// True if a span is so narrow, compared with the size of its parameters, that a parameter relative to the middle of
/// the span loses digits.
bool hasNarrowSpan(const Axis& axis) {
  constexpr double kNarrow = 1e-6;
  return std::any_of(axis.cells().begin(), axis.cells().end(), [](const Cell& cell) {
    return !(cell.end - cell.lo > kNarrow * std::max(std::abs(cell.lo), std::abs(cell.end)));
  });
}

}  // namespace

void validate(const CurveData& data) {
  const std::string what = "curve '" + (data.name.empty() ? std::string("unnamed") : data.name) + "'";
  validateKnots(data.knots, data.degree, data.points.size(), what + ": knots");
  validatePoints(data.points, data.weights, what);
}

Curve::Curve(const CurveData& data, Form form, Instructions instructions) : name_(data.name) {
  validate(data);
  axis_ = Axis(data.degree, data.knots);
  Net net = makeNet(data.points, data.weights);
  scale_ = net.scale;
  rational_ = net.rational();
  const KernelSet& set = kernels(instructions);
  if (form == Form::kTable && !hasNarrowSpan(axis_)) {
    const Axis across(0, {0, 1});
    if (auto table = makeTable(net, axis_, across)) {
      table_ = std::move(*table);
      const auto& pair = set.table[table_.shape][rational_];
      table_kernel_ = {pair[0], pair[1]};
      axis_.forgetKnots();
      return;
    }
  }
  net_ = std::move(net.points);
  const auto& pair = set.net[static_cast<std::size_t>(net.weights)];
  net_kernel_ = {pair[0], pair[1]};
}

TableCell Curve::cell(std::int32_t span) const noexcept {
  const Cell& at = axis_.cell(span);
  return {{at.lo, 0},       {at.end, 1},
          {at.origin, 0},   table_.cells.data() + span * table_.row_stride,
          table_kernel_[1], {table_.size_u, table_.size_v}};
}

void Curve::evaluate(int order, double u, std::int32_t& span, double* out) const noexcept {
  u = axis_.locate(u, span);
  const Cell& cell = axis_.cell(span);
  // the kernels evaluate surfaces; this one does not depend on v
  if (table_kernel_[0] != nullptr) {
    const double* first = table_.cells.data() + span * table_.row_stride;
    table_kernel_[static_cast<std::size_t>(order) - 1](first, table_.size_u, table_.size_v, u - cell.origin, 0, out);
    return;
  }
  const KnotWindow across{0, nullptr, nullptr};
  const NetWindow net{axis_.window(cell), across, net_.data() + (cell.knot - axis_.degree()), 1};
  net_kernel_[static_cast<std::size_t>(order) - 1](net, u, 0, out);
}

void Curve::evaluate1(double u, CurvePoint& out) const noexcept {
  SurfacePoint surface;
  evaluate(1, u, out.span, surface.S.data());
  out.C = scale_ * surface.S;
  out.C1 = scale_ * surface.Su;
}

void Curve::evaluate2(double u, CurvePoint& out) const noexcept {
  SurfacePoint surface;
  evaluate(2, u, out.span, surface.S.data());
  out.C = scale_ * surface.S;
  out.C1 = scale_ * surface.Su;
  out.C2 = scale_ * surface.Suu;
}

}  // namespace hapticd::spline
