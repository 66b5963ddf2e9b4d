#include "kernels/spline/surface.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::spline {
namespace {

/// Coordinates beyond these binary exponents are scaled, so that products of two derivatives neither overflow nor
/// vanish.
constexpr int kLargestExponent = 200;
constexpr int kSmallestExponent = -200;

/// A power of two near the largest coordinate if that one is extreme, otherwise 1.
double scaleOf(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0;
  for (const auto& point : points) largest = std::max(largest, point.cwiseAbs().maxCoeff());
  if (largest == 0) return 1;
  const int exponent = std::ilogb(largest);
  return exponent > kLargestExponent || exponent < kSmallestExponent ? std::ldexp(1.0, std::max(exponent, -1022)) : 1;
}

/// Exact: divides by a power of two.
double middleWeight(const std::vector<double>& weights) {
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  return std::ldexp(1.0, (std::ilogb(*least) + std::ilogb(*most)) / 2);
}

double moveInto(double t, double lo, double hi) {
  const double above = t > lo ? t : lo;  // not-a-number becomes lo
  return above < hi ? above : hi;
}

}  // namespace

Surface::Surface(const SurfaceData& data, Form) {
  validate(data);
  reversed_ = data.reversed;
  name_ = data.name;
  for (std::size_t a = 0; a < 2; ++a) {
    Axis& axis = axes_[a];
    axis.degree = data.degree[a];
    axis.knots = data.knots[a];
    const int last = data.count(static_cast<int>(a));
    for (int i = axis.degree; i < last; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (axis.knots[k] == axis.knots[k + 1]) continue;
      axis.breaks.push_back(axis.knots[k]);
      axis.first_knot.push_back(i);
    }
    axis.breaks.push_back(axis.knots[static_cast<std::size_t>(last)]);
  }
  buildNet(data);
}

void Surface::buildNet(const SurfaceData& data) {
  scale_ = scaleOf(data.points);
  const bool equal =
      std::all_of(data.weights.begin(), data.weights.end(), [&](double w) { return w == data.weights.front(); });
  rational_ = !equal;
  const double unit = rational_ ? middleWeight(data.weights) : 1;
  net_.resize(data.points.size());
  for (std::size_t i = 0; i < net_.size(); ++i) {
    const Eigen::Vector3d point = data.points[i] / scale_;
    net_[i] = {point.x(), point.y(), point.z(), rational_ ? data.weights[i] / unit : 0};
  }
}

std::int32_t Surface::Axis::find(double t, std::int32_t hint) const noexcept {
  const auto spans = static_cast<std::uint32_t>(first_knot.size());
  const auto h = static_cast<std::uint32_t>(hint);
  if (h < spans && breaks[h] <= t && t < breaks[h + 1]) [[likely]] {
    return hint;
  }
  const auto above = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, t);
  return static_cast<std::int32_t>(above - breaks.begin()) - 1;
}

template <int kOrder>
void Surface::evaluate(double u, double v, SurfacePoint& out) const noexcept {
  u = moveInto(u, axes_[0].breaks.front(), axes_[0].breaks.back());
  v = moveInto(v, axes_[1].breaks.front(), axes_[1].breaks.back());
  out.span = {axes_[0].find(u, out.span[0]), axes_[1].find(v, out.span[1])};
  const int knot_u = axes_[0].first_knot[static_cast<std::size_t>(out.span[0])];
  const int knot_v = axes_[1].first_knot[static_cast<std::size_t>(out.span[1])];
  const int count_v = static_cast<int>(axes_[1].knots.size()) - axes_[1].degree - 1;
  const NetWindow net{axes_[0].knots.data() + knot_u,
                      axes_[1].knots.data() + knot_v,
                      net_.data() + (knot_u - axes_[0].degree) * count_v + (knot_v - axes_[1].degree),
                      axes_[0].degree,
                      axes_[1].degree,
                      count_v};
  fastestKernels().net[rational_][kOrder - 1](net, u, v, out.S.data());
  if (scale_ == 1) [[likely]] {
    return;
  }
  for (Eigen::Vector3d* d : {&out.S, &out.Su, &out.Sv}) *d *= scale_;
  if (kOrder == 1) return;
  for (Eigen::Vector3d* d : {&out.Suu, &out.Suv, &out.Svv}) *d *= scale_;
}

void Surface::evaluate1(double u, double v, SurfacePoint& out) const noexcept {
  evaluate<1>(u, v, out);
}
void Surface::evaluate2(double u, double v, SurfacePoint& out) const noexcept {
  evaluate<2>(u, v, out);
}

std::size_t Surface::bytes() const noexcept {
  std::size_t sum = net_.capacity() * sizeof(Quad);
  for (const Axis& axis : axes_) {
    sum += (axis.knots.capacity() + axis.breaks.capacity()) * sizeof(double) +
           axis.first_knot.capacity() * sizeof(std::int32_t);
  }
  return sum;
}

}  // namespace hapticd::spline
