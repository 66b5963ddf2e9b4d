// SPDX-License-Identifier: MIT
#include "kernels/spline/curve.hpp"

#include "kernels/spline/net.hpp"
#include "kernels/spline/surface.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

void validate(const CurveData& data) {
  const std::string what = "curve '" + (data.name.empty() ? std::string("unnamed") : data.name) + "'";
  validateKnots(data.knots, data.degree, data.points.size(), what + ": knots");
  validatePoints(data.points, data.weights, what);
}

Curve::Curve(const CurveData& data, Instructions instructions) : name_(data.name) {
  validate(data);
  axis_ = Axis(data.degree, data.knots);
  Net net = makeNet(data.points, data.weights);
  net_ = std::move(net.points);
  scale_ = net.scale;
  rational_ = net.rational();
  const auto& pair = kernels(instructions).net[static_cast<std::size_t>(net.weights)];
  kernel_ = {pair[0], pair[1]};
}

void Curve::evaluate(int order, double u, std::int32_t& span, double* out) const noexcept {
  u = axis_.locate(u, span);
  const Cell& cell = axis_.cell(span);
  const KnotWindow across{0, nullptr, nullptr};  // the kernel evaluates surfaces; this one does not depend on v
  const NetWindow net{axis_.window(cell), across, net_.data() + (cell.knot - axis_.degree()), 1};
  kernel_[static_cast<std::size_t>(order) - 1](net, u, 0, out);
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
