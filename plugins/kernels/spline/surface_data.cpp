// SPDX-License-Identifier: MIT
#include "kernels/spline/surface_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace hapticd::spline {
namespace {

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

[[noreturn]] void fail(const std::string& what, const std::string& why) {
  throw std::invalid_argument(what + ": " + why);
}

void checkEachKnot(const std::vector<double>& knots, const std::string& what) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const std::string where = what + "[" + std::to_string(i) + "]";
    if (!(std::abs(knots[i]) <= kWidestKnot)) {
      fail(where, number(knots[i]) + " is not a parameter; expected a finite number up to 1e100");
    }
    if (i == 0 || knots[i] == knots[i - 1]) continue;
    if (knots[i] < knots[i - 1]) {
      fail(where, number(knots[i]) + " is less than the knot before it (" + number(knots[i - 1]) +
                      "); expected knots that never decrease");
    }
    if (knots[i] - knots[i - 1] < kNarrowestSpan) {
      fail(where, "only " + number(knots[i] - knots[i - 1]) +
                      " after the knot before it; expected equal knots or a span of at least 1e-100");
    }
  }
}

/// Checks that no inner knot has a multiplicity above degree + 1. At that multiplicity the spline has a gap; at a
/// higher one some control points would have no effect.
void checkMultiplicity(const std::vector<double>& knots, int degree, const std::string& what) {
  const auto order = static_cast<std::size_t>(degree) + 1;
  for (std::size_t i = order; i + order + 1 < knots.size(); ++i) {
    if (knots[i] == knots[i + order] && knots[i] > knots[order - 1] && knots[i] < knots[knots.size() - order]) {
      fail(what + "[" + std::to_string(i) + "]", "the knot " + number(knots[i]) + " occurs more than " +
                                                     std::to_string(order) +
                                                     " times; expected at most degree + 1 inside the domain");
    }
  }
}

}  // namespace

void validateKnots(const std::vector<double>& knots, int degree, std::size_t count, const std::string& what) {
  if (degree < 1 || degree > kMaxDegree) {
    fail(what, "the degree is " + std::to_string(degree) + "; expected 1 to " + std::to_string(kMaxDegree));
  }
  const auto p = static_cast<std::size_t>(degree);
  if (count < p + 1) {
    fail(what, std::to_string(count) + " control points; degree " + std::to_string(degree) + " needs at least " +
                   std::to_string(p + 1));
  }
  if (knots.size() != count + p + 1) {
    fail(what, std::to_string(knots.size()) +
                   " knots; expected control points + degree + 1 = " + std::to_string(count + p + 1));
  }
  checkEachKnot(knots, what);
  if (!(knots[p] < knots[count])) {
    fail(what, "the domain from knot " + std::to_string(p) + " to knot " + std::to_string(count) + " is empty (both " +
                   number(knots[p]) + ")");
  }
  checkMultiplicity(knots, degree, what);
}

void validatePoints(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights,
                    const std::string& what) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      fail(what + ": points[" + std::to_string(i) + "]", "a coordinate is not a finite number");
    }
  }
  if (weights.empty()) return;
  if (weights.size() != points.size()) {
    fail(what + ": weights", std::to_string(weights.size()) + " weights for " + std::to_string(points.size()) +
                                 " points; expected one per point, or none for a polynomial");
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0) || !std::isfinite(weights[i])) {
      fail(what + ": weights[" + std::to_string(i) + "]",
           number(weights[i]) + " is not a weight; expected a positive finite number");
    }
  }
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  if (*most * (1 / kMaxWeightRatio) > *least) {
    fail(what + ": weights",
         "range from " + number(*least) + " to " + number(*most) + "; expected a ratio of at most 1e100");
  }
}

/// Returns a text such as "surface 'lid'".
static std::string nameOf(const SurfaceData& data) {
  return "surface '" + (data.name.empty() ? std::string("unnamed") : data.name) + "'";
}

void validateKnots(const SurfaceData& data, int axis) {
  const auto a = static_cast<std::size_t>(axis);
  const int degree = data.degree[a];
  const std::string knots = nameOf(data) + ": knots[" + (axis == 0 ? "u" : "v") + "]";
  const int count = degree >= 1 && degree <= kMaxDegree ? data.count(axis) : 0;
  validateKnots(data.knots[a], degree, static_cast<std::size_t>(std::max(count, 0)), knots);
}

void validate(const SurfaceData& data) {
  const std::string what = nameOf(data);
  for (const int axis : {0, 1}) validateKnots(data, axis);
  const auto count_u = static_cast<std::size_t>(data.count(0)), count_v = static_cast<std::size_t>(data.count(1));
  if (data.points.size() != count_u * count_v) {
    fail(what + ": points", std::to_string(data.points.size()) + " points; knots and degrees state " +
                                std::to_string(count_u) + " x " + std::to_string(count_v) + " = " +
                                std::to_string(count_u * count_v));
  }
  validatePoints(data.points, data.weights, what);
}

}  // namespace hapticd::spline
