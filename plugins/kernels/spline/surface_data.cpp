// SPDX-License-Identifier: MIT
#include "kernels/spline/surface_data.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace hapticd::spline {
namespace {

std::string number(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

[[noreturn]] void raise(const std::string& where, const std::string& why) {
  throw std::invalid_argument(where + ": " + why);
}

/// Checks the order of knots. @return true if all is well
bool checkEachKnot(const std::vector<double>& knots, const std::string& what, const Tell& tell) {
  bool good = true;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    std::string why;
    if (!(std::abs(knots[i]) <= kWidestKnot))
      why = number(knots[i]) + " is not a parameter; expected a finite number up to 1e100";
    else if (i > 0 && knots[i] < knots[i - 1])
      why = number(knots[i]) + " is less than the knot before it (" + number(knots[i - 1]) +
            "); expected knots that never decrease";
    else if (i > 0 && knots[i] != knots[i - 1] && knots[i] - knots[i - 1] < kNarrowestSpan)
      why = "only " + number(knots[i] - knots[i - 1]) +
            " after the knot before it; expected equal knots or a span of at least 1e-100";
    if (!why.empty()) tell(what + "[" + std::to_string(i) + "]", why);
    good = good && why.empty();
  }
  return good;
}

/// Checks that no inner knot has a multiplicity above degree + 1. At that multiplicity the spline has a gap; at a
/// higher one some control points would have no effect.
void checkMultiplicity(const std::vector<double>& knots, int degree, const std::string& what, const Tell& tell) {
  const auto order = static_cast<std::size_t>(degree) + 1;
  for (std::size_t i = order; i + order + 1 < knots.size(); ++i)
    if (knots[i] == knots[i + order] && knots[i] > knots[order - 1] && knots[i] < knots[knots.size() - order])
      return tell(what + "[" + std::to_string(i) + "]", "the knot " + number(knots[i]) + " occurs more than " +
                                                            std::to_string(order) +
                                                            " times; expected at most degree + 1 inside the domain");
}

/// Checks whether the degree and the number of knots fit the number of points. @return true if all is well
bool checkCounts(const std::vector<double>& knots, int degree, std::size_t count, const std::string& what,
                 const Tell& tell) {
  std::string why;
  const auto p = static_cast<std::size_t>(std::max(degree, 0));
  if (degree < 1 || degree > kMaxDegree)
    why = "the degree is " + std::to_string(degree) + "; expected 1 to " + std::to_string(kMaxDegree);
  else if (count < p + 1)
    why = std::to_string(count) + " control points; degree " + std::to_string(degree) + " needs at least " +
          std::to_string(p + 1);
  else if (knots.size() != count + p + 1)
    why = std::to_string(knots.size()) +
          " knots; expected control points + degree + 1 = " + std::to_string(count + p + 1);
  if (!why.empty()) tell(what, why);
  return why.empty();
}

void checkKnots(const std::vector<double>& knots, int degree, std::size_t count, const std::string& what,
                const Tell& tell) {
  const bool counted = checkCounts(knots, degree, count, what, tell);
  if (!checkEachKnot(knots, what, tell) || !counted) return;
  const auto p = static_cast<std::size_t>(degree);
  if (!(knots[p] < knots[count]))
    return tell(what, "the domain from knot " + std::to_string(p) + " to knot " + std::to_string(count) +
                          " is empty (both " + number(knots[p]) + ")");
  checkMultiplicity(knots, degree, what, tell);
}

void checkPoints(const std::vector<Eigen::Vector3d>& points, const std::string& what, const Tell& tell) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      tell(what + ": points[" + std::to_string(i) + "]", "a coordinate is not a finite number");
}

void checkWeights(const std::vector<double>& weights, const std::string& what, const Tell& tell) {
  if (weights.empty()) return;
  bool good = true;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] > 0 && std::isfinite(weights[i])) continue;
    tell(what + ": weights[" + std::to_string(i) + "]",
         number(weights[i]) + " is not a weight; expected a positive finite number");
    good = false;
  }
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  if (good && *most * (1 / kMaxWeightRatio) > *least)
    tell(what + ": weights",
         "range from " + number(*least) + " to " + number(*most) + "; expected a ratio of at most 1e100");
}

void checkWeightCount(std::size_t weights, std::size_t points, const std::string& what, const Tell& tell) {
  if (weights != 0 && weights != points)
    tell(what + ": weights", std::to_string(weights) + " weights for " + std::to_string(points) +
                                 " points; expected one per point, or none for a polynomial");
}

/// Returns a text such as "surface 'lid'".
std::string nameOf(const SurfaceData& data) {
  return "surface '" + (data.name.empty() ? std::string("unnamed") : data.name) + "'";
}

}  // namespace

void validateKnots(const std::vector<double>& knots, int degree, std::size_t count, const std::string& what) {
  checkKnots(knots, degree, count, what, raise);
}

void validatePoints(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights,
                    const std::string& what) {
  checkPoints(points, what, raise);
  checkWeightCount(weights.size(), points.size(), what, raise);
  checkWeights(weights, what, raise);
}

bool hasNoArea(const SurfaceData& surface) {
  constexpr double kFlat = 1e-9;    // ratio of width and length
  constexpr double kPoint = 1e-70;  // [m] squares of areas of this size vanish, and with them the normals
  const Eigen::Vector3d first = surface.points.front();
  Eigen::Vector3d far = Eigen::Vector3d::Zero();
  double size = 0;  // [m] lengths are divided by it, because squares of large ones overflow
  for (const Eigen::Vector3d& point : surface.points)
    if (const double way = (point - first).cwiseAbs().maxCoeff(); way > size) {
      size = way;
      far = point - first;
    }
  if (!(size > kPoint)) return true;
  far /= size;
  return std::all_of(surface.points.begin(), surface.points.end(), [&](const Eigen::Vector3d& point) {
    return ((point - first) / size).cross(far).norm() <= kFlat * far.squaredNorm();
  });
}

void validate(const SurfaceData& data) {
  checkParts(data, {}, raise);
}

void checkParts(const SurfaceData& data, const SoundParts& read, const Tell& tell) {
  const std::string what = nameOf(data);
  bool good = read.degree && read.points;
  const Tell note = [&](const std::string& where, const std::string& why) {
    good = false;
    tell(where, why);
  };
  for (const std::size_t axis : {0u, 1u}) {
    const std::string knots = what + ": knots[" + (axis == 0 ? "u" : "v") + "]";
    good = good && read.knots[axis];
    if (!read.knots[axis]) continue;
    if (!read.degree) {
      checkEachKnot(data.knots[axis], knots, note);
      continue;
    }
    const int degree = data.degree[axis];
    const int count = degree >= 1 && degree <= kMaxDegree ? data.count(static_cast<int>(axis)) : 0;
    checkKnots(data.knots[axis], degree, static_cast<std::size_t>(std::max(count, 0)), knots, note);
  }
  std::size_t points = data.points.size();  // as many as there should be
  if (good) {
    const auto count_u = static_cast<std::size_t>(data.count(0)), count_v = static_cast<std::size_t>(data.count(1));
    points = count_u * count_v;
    if (data.points.size() != points)
      note(what + ": points", std::to_string(data.points.size()) + " points; knots and degrees state " +
                                  std::to_string(count_u) + " x " + std::to_string(count_v) + " = " +
                                  std::to_string(points));
  }
  if (read.points) checkPoints(data.points, what, note);
  if (!read.weights) return;
  if (read.points) checkWeightCount(data.weights.size(), points, what, note);
  checkWeights(data.weights, what, note);
}

}  // namespace hapticd::spline
