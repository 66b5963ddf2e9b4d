// SPDX-License-Identifier: MIT
#include "kernels/spline/surface.hpp"

#include <algorithm>

#include "kernels/spline/net.hpp"

namespace hapticd::spline {

static_assert(offsetof(SurfacePoint, Svv) == 5 * kOutStride * sizeof(double), "kernels write six vectors from S on");
static_assert(offsetof(SurfacePoint, span) >= 6 * kOutStride * sizeof(double), "kernels write what pads the vectors");

Surface::Surface(const SurfaceData& data, Form form, Instructions instructions) {
  validate(data);
  axes_ = {Axis(data.degree[0], data.knots[0]), Axis(data.degree[1], data.knots[1])};
  Net net = makeNet(data.points, data.weights);
  scale_ = net.scale;
  rational_ = net.rational();
  reversed_ = data.reversed;
  name_ = data.name;
  const KernelSet& set = kernels(instructions);
  if (form == Form::kTable) {
    anchorAtCollapsedSides(net, axes_[0], axes_[1]);
    if (auto table = makeTable(net, axes_[0], axes_[1])) {
      table_ = std::move(*table);
      const auto& pair = set.table[table_.shape][rational_];
      table_kernel_ = {pair[0], pair[1]};
      for (Axis& axis : axes_) axis.forgetKnots();
      return;
    }
  }
  net_ = std::move(net.points);
  const auto& pair = set.net[static_cast<std::size_t>(net.weights)];
  net_kernel_ = {pair[0], pair[1]};
}

NetWindow Surface::netWindow(const Cell& cu, const Cell& cv) const noexcept {
  const int stride = axes_[1].count();
  const Quad* first = net_.data() + (cu.knot - axes_[0].degree()) * stride + (cv.knot - axes_[1].degree());
  return {axes_[0].window(cu), axes_[1].window(cv), first, stride};
}

TableCell Surface::cellOf(const SurfacePoint& at) const noexcept {
  TableCell cell{{}, {}, {}, nullptr, nullptr, {table_.size_u, table_.size_v}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Cell& along = axes_[axis].cell(at.span[axis]);
    cell.lo[axis] = along.lo;
    cell.end[axis] = std::min(along.end, axes_[axis].breaks().back());
    cell.origin[axis] = along.origin;
  }
  if (form() == Form::kNet || scale_ != 1) return cell;
  cell.coefficients = tableCell(at);
  cell.kernel = table_kernel_[1];
  return cell;
}

void Surface::rescale(int order, SurfacePoint& out) const noexcept {
  for (Eigen::Vector3d* d : {&out.S, &out.Su, &out.Sv}) *d *= scale_;
  if (order == 1) return;
  for (Eigen::Vector3d* d : {&out.Suu, &out.Suv, &out.Svv}) *d *= scale_;
}

std::size_t Surface::bytes() const noexcept {
  return net_.capacity() * sizeof(Quad) + table_.cells.capacity() * sizeof(double) + axes_[0].bytes() +
         axes_[1].bytes();
}

}  // namespace hapticd::spline
