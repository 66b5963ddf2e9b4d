// SPDX-License-Identifier: MIT
#include "kernels/brep/elements/recognised_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;
using spline::CurvePoint;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kOff = 5e-13;  ///< [m] greatest deviation of the points from the shape
/// Samples per knot span. The numerator of the squared distance from a point to a rational cubic is a polynomial of
/// degree 6. So if the distance is right at more than 6 points of a span, it is right in the whole span.
constexpr int kInSpan = 9;

struct Samples {
  std::vector<double> t;
  std::vector<Vector3d> points;
};

Samples samplesOf(const Geometry& geometry, const Edge& edge) {
  const double narrow = 1e-9 * (edge.t1 - edge.t0);
  std::vector<double> knots{edge.t0};
  for (const double knot : geometry.curveKnots(edge.curve))
    if (knot > edge.t0 + narrow && knot < edge.t1 - narrow) knots.push_back(knot);
  knots.push_back(edge.t1);
  Samples samples;
  CurvePoint C;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    for (int k = i == 0 ? 0 : 1; k <= kInSpan; ++k) {
      samples.t.push_back(k == kInSpan ? knots[i + 1] : knots[i] + (knots[i + 1] - knots[i]) * k / kInSpan);
      geometry.curve(edge.curve, samples.t.back(), C);
      samples.points.push_back(C.C);
    }
  return samples;
}

bool rises(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return !(a < b); }) == values.end();
}

bool findLine(const Samples& samples, RecognisedEdge& made) {
  EdgeShape& line = made.shape;
  line.o = samples.points.front();
  const Vector3d way = samples.points.back() - line.o;
  if (!(way.norm() > 1e3 * kOff)) return false;
  line.x = way.normalized();
  made.stops.clear();
  for (const Vector3d& point : samples.points) {
    made.stops.push_back((point - line.o).dot(line.x));
    if (!((point - line.o - made.stops.back() * line.x).norm() <= kOff)) return false;
  }
  return rises(made.stops);
}

bool findCircle(const Samples& samples, RecognisedEdge& made) {
  // largest ratio of the radius to the distance of the three points; above it, the centre is mostly rounding error
  constexpr double kWidest = 1e3;
  const auto at = [&](std::size_t thirds) { return samples.points[(samples.points.size() - 1) * thirds / 3]; };
  EdgeShape& circle = made.shape;
  const Vector3d a = at(0), u = at(1) - a, v = at(2) - a, n = u.cross(v);
  const double n2 = n.squaredNorm();
  if (!(n2 > 0)) return false;
  circle.o = a + (u.squaredNorm() * v.cross(n) + v.squaredNorm() * n.cross(u)) / (2 * n2);
  circle.size = (a - circle.o).norm();
  if (!(circle.size < kWidest * std::min(u.norm(), v.norm()))) return false;
  circle.x = (a - circle.o) / circle.size;
  circle.y = n.cross(circle.x).normalized();
  const Vector3d z = n.normalized();
  made.stops.clear();
  double last = 0;
  for (const Vector3d& point : samples.points) {
    const Vector3d w = point - circle.o;
    if (!(std::abs(w.dot(z)) <= kOff && std::abs(w.norm() - circle.size) <= kOff)) return false;
    const double angle = std::atan2(w.dot(circle.y), w.dot(circle.x));
    last = made.stops.empty() ? 0 : angle + kTurn * std::ceil((last - angle) / kTurn - 1e-12);
    made.stops.push_back(last);
  }
  const bool closed = (samples.points.back() - samples.points.front()).norm() <= 2 * kOff;
  if (closed) made.stops.back() = kTurn;
  return rises(made.stops) && made.stops.back() <= kTurn;
}

}  // namespace

std::optional<RecognisedEdge> recogniseEdge(const Geometry& geometry, const Edge& edge) {
  if (edge.curve == kNone || geometry.part().curves3[edge.curve].kind != CurveKind::kSpline) return std::nullopt;
  const Samples samples = samplesOf(geometry, edge);
  RecognisedEdge made;
  made.curve = edge.curve;
  made.parameters = samples.t;
  if (!findLine(samples, made)) {
    made.shape = {};
    made.is_circle = true;
    if (!findCircle(samples, made)) return std::nullopt;
  }
  made.shape.t0 = made.stops.front();
  made.shape.t1 = made.stops.back();
  return made;
}

double parameterAt(const Geometry& geometry, const RecognisedEdge& edge, double s, const Vector3d& point) noexcept {
  constexpr int kSteps = 4;
  if (s <= edge.stops.front()) return edge.parameters.front();
  if (s >= edge.stops.back()) return edge.parameters.back();
  const auto above = std::upper_bound(edge.stops.begin(), edge.stops.end(), s);
  const auto i = static_cast<std::size_t>(above - edge.stops.begin());
  const double low = edge.parameters[i - 1], high = edge.parameters[i];
  double t = low + (high - low) * (s - edge.stops[i - 1]) / (edge.stops[i] - edge.stops[i - 1]);
  CurvePoint C;
  for (int step = 0; step < kSteps; ++step) {
    geometry.curve(edge.curve, t, C);
    const double speed2 = C.C1.squaredNorm(), move = speed2 > 0 ? (point - C.C).dot(C.C1) / speed2 : 0;
    t = std::clamp(t + move, low, high);
    if (std::abs(move) <= 1e-12 * (high - low)) break;
  }
  return t;
}

}  // namespace hapticd::brep
