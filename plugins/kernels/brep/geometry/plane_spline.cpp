// SPDX-License-Identifier: MIT
#include "kernels/brep/geometry/plane_spline.hpp"

#include <algorithm>
#include <array>

#include "kernels/spline/curve_data.hpp"
#include "kernels/spline/net.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::brep {
namespace {

constexpr std::size_t kMostPoints = spline::kMaxDegree + 1;  ///< control points that act on one span

/// The numbers of a curve inside the numbers of its part.
struct PlaneNumbers {
  const double *knots, *points, *weights;
  PlaneNumbers(const std::vector<double>& reals, const Curve2& curve)
      : knots(reals.data() + curve.data),
        points(knots + curve.count + curve.degree + 1),
        weights((curve.flags & kRational) != 0 ? points + 2 * std::size_t{curve.count} : nullptr) {}
};

spline::CurveData dataOf(const Part& part, const Curve2& curve) {
  const PlaneNumbers from(part.reals, curve);
  spline::CurveData data;
  data.degree = static_cast<int>(curve.degree);
  data.knots.assign(from.knots, from.points);
  for (std::size_t i = 0; i < curve.count; ++i) data.points.emplace_back(from.points[2 * i], from.points[2 * i + 1], 0);
  if (from.weights != nullptr) data.weights.assign(from.weights, from.weights + curve.count);
  return data;
}

/// Moves t into the domain and returns the index of the knot at the low end of the span that contains t.
std::size_t spanOf(const double* knots, const Curve2& curve, double& t) noexcept {
  const double low = knots[curve.degree], high = knots[curve.count];
  if (!(t > low)) t = low;
  if (t > high) t = high;
  auto span = static_cast<std::size_t>(std::upper_bound(knots + curve.degree + 1, knots + curve.count, t) - knots) - 1;
  // at the end of the domain, take the last span that is not empty
  while (span > curve.degree && knots[span] == knots[span + 1]) --span;
  return span;
}

}  // namespace

PlaneSpline::PlaneSpline(const Part& part, const Curve2& curve) {
  const spline::CurveData data = dataOf(part, curve);
  spline::validate(data);
  const spline::Net net = spline::makeNet(data.points, data.weights);
  kernel_ = spline::kernels(spline::Instructions::kFastest).net[static_cast<std::size_t>(net.weights)][0];
  scale_ = net.scale;
  if (net.rational()) weight_scale_ = net.points[0].w / data.weights[0];
}

PlaneSplinePoint PlaneSpline::at(const std::vector<double>& reals, const Curve2& curve, double t) const noexcept {
  const PlaneNumbers from(reals, curve);
  const std::size_t degree = curve.degree, span = spanOf(from.knots, curve, t), first = span - degree;
  std::array<spline::Quad, kMostPoints> points;
  for (std::size_t i = 0; i <= degree; ++i) {
    const double* point = from.points + 2 * (first + i);
    const double weight = weight_scale_ > 0 ? from.weights[first + i] * weight_scale_ : 0;
    points[i] = {point[0] / scale_, point[1] / scale_, 0, weight};
  }
  std::array<double, kMostPoints*(kMostPoints - 1) / 2> reciprocals;
  const double* local = from.knots + span;
  std::size_t count = 0;
  for (std::size_t j = 1; j <= degree; ++j)
    for (std::size_t r = 0; r < j; ++r) reciprocals[count++] = 1 / (local[r + 1] - *(local + r + 1 - j));
  const spline::KnotWindow along{static_cast<int>(degree), local, reciprocals.data()};
  const spline::KnotWindow across{0, nullptr, nullptr};  // the kernel evaluates surfaces; this one does not depend on v
  alignas(32) std::array<double, 3 * spline::kOutStride> out;
  kernel_({along, across, points.data(), 1}, t, 0, out.data());
  const double* c1 = out.data() + spline::kOutStride;
  return {{scale_ * out[0], scale_ * out[1]}, {scale_ * c1[0], scale_ * c1[1]}};
}

std::vector<double> breaksOf(const Part& part, const Curve2& curve) {
  const double* knots = PlaneNumbers(part.reals, curve).knots;
  std::vector<double> breaks(knots + curve.degree, knots + curve.count + 1);
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

}  // namespace hapticd::brep
