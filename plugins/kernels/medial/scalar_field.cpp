// SPDX-License-Identifier: MIT
#include "kernels/medial/scalar_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hapticd::medial {
namespace {

/// Returns the slope of a monotone cubic at a sample: the weighted harmonic mean of the slopes on both sides, or 0 at
/// an extremum.
double innerSlope(double h0, double h1, double d0, double d1) {
  if (!(d0 * d1 > 0)) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

/// Returns the weights of (left value, left slope, right value, right slope) in a cubic: row 0 for the value, the other
/// rows for its derivatives.
template <int kOrder>
std::array<std::array<double, 4>, kOrder + 1> hermite(double t, double h) noexcept {
  const double s = 1 - t;
  std::array<std::array<double, 4>, kOrder + 1> rows;
  rows[0] = {s * s * (1 + 2 * t), h * s * s * t, t * t * (3 - 2 * t), -h * t * t * s};
  rows[1] = {-6 * s * t / h, s * s - 2 * s * t, 6 * s * t / h, t * t - 2 * s * t};
  if constexpr (kOrder > 1)
    rows[2] = {(12 * t - 6) / (h * h), (6 * t - 4) / h, (6 - 12 * t) / (h * h), (6 * t - 2) / h};
  return rows;
}

std::size_t interval(const std::vector<double>& knots, double t) noexcept {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, t);
  return static_cast<std::size_t>(above - knots.begin()) - 1;
}

}  // namespace

ScalarField::ScalarField(const std::array<std::vector<double>, 2>& parameters, const std::vector<double>& samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!(samples[i] >= 0) || !std::isfinite(samples[i]))
      throw std::invalid_argument("sample " + std::to_string(i) + " is " + std::to_string(samples[i]) +
                                  ", but it must be a finite number of at least 0");
  }
  if (samples.empty()) return;
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
  range_ = {*low, *high};
  if (*low == *high) return;
  parameters_ = parameters;
  nodes_.reserve(samples.size());
  for (const double f : samples) nodes_.push_back({f, 0, 0});
  limitSlopes();
}

void ScalarField::raise(double constant) {
  for (double& one : range_) one += constant;
  for (Node& node : nodes_) node.f += constant;
}

void ScalarField::limitSlopes() {
  const std::array<std::size_t, 2> count{parameters_[0].size(), parameters_[1].size()};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::vector<double>& t = parameters_[axis];
    const std::size_t stride = axis == 0 ? count[1] : 1, last = count[axis] - 1;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const std::size_t i = axis == 0 ? n / count[1] : n % count[1];
      const auto slope = [&](std::size_t a) {
        return (nodes_[n + stride * (a + 1) - stride * i].f - nodes_[n + stride * a - stride * i].f) /
               (t[a + 1] - t[a]);
      };
      double d = i == 0 ? slope(0) : slope(i - 1);
      if (i > 0 && i < last) d = innerSlope(t[i] - t[i - 1], t[i + 1] - t[i], slope(i - 1), slope(i));
      // The limit is half of the slope that keeps the Bernstein coefficients of a curve positive, so that both
      // directions together keep those of a patch positive.
      const double width = std::max(i > 0 ? t[i] - t[i - 1] : 0, i < last ? t[i + 1] - t[i] : 0);
      const double most = 1.5 * nodes_[n].f / width;
      (axis == 0 ? nodes_[n].fu : nodes_[n].fv) = static_cast<float>(std::clamp(d, -most, most));
    }
  }
}

template <int kOrder>
ScalarField::Value ScalarField::blend(double u, double v) const noexcept {
  const std::vector<double>&tu = parameters_[0], &tv = parameters_[1];
  const std::size_t i = interval(tu, u), j = interval(tv, v), stride = tv.size();
  const double hu = tu[i + 1] - tu[i], hv = tv[j + 1] - tv[j];
  const auto a = hermite<kOrder>((u - tu[i]) / hu, hu), b = hermite<kOrder>((v - tv[j]) / hv, hv);
  Value sum;
  for (std::size_t c = 0; c < 4; ++c) {
    const std::size_t x = 2 * (c / 2), y = 2 * (c % 2);
    const Node& n = nodes_[(i + x / 2) * stride + j + y / 2];
    const auto add = [&](double& to, std::size_t du, std::size_t dv) {
      to += n.f * a[du][x] * b[dv][y] + n.fu * a[du][x + 1] * b[dv][y] + n.fv * a[du][x] * b[dv][y + 1];
    };
    add(sum.f, 0, 0);
    add(sum.fu, 1, 0);
    add(sum.fv, 0, 1);
    if constexpr (kOrder > 1) {
      add(sum.fuu, 2, 0);
      add(sum.fuv, 1, 1);
      add(sum.fvv, 0, 2);
    }
  }
  sum.f = std::max(0.0, sum.f);  // only rounding can make it negative
  return sum;
}

template ScalarField::Value ScalarField::blend<1>(double, double) const noexcept;
template ScalarField::Value ScalarField::blend<2>(double, double) const noexcept;

std::size_t ScalarField::bytes() const noexcept {
  return nodes_.capacity() * sizeof(Node) + (parameters_[0].capacity() + parameters_[1].capacity()) * sizeof(double);
}

}  // namespace hapticd::medial
