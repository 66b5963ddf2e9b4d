// SPDX-License-Identifier: MIT
#include "kernels/medial/contour.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/medial/bounds.hpp"
#include "kernels/spline/basis.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// least segments between two points of the grid, because a dent is as wide as the distance of these points
constexpr int kLeastSegments = 2;
constexpr int kMostSegments = 64;
constexpr int kLeastArc = 2;  ///< least segments from the top to the bottom round the rim

Vector3d unit(const Vector3d& v, const Vector3d& fallback) {
  const double length = v.norm();
  return length > 0 ? Vector3d(v / length) : fallback;
}

/// Returns a point on the path from `a` over `middle` to `b` on the unit sphere, for t from 0 to 1.
Vector3d bend(const Vector3d& a, const Vector3d& middle, const Vector3d& b, double t) {
  const Vector3d& from = t < .5 ? a : middle;
  const Vector3d& to = t < .5 ? middle : b;
  const double s = t < .5 ? 2 * t : 2 * t - 1;
  const double angle = std::acos(std::clamp(from.dot(to), -1.0, 1.0));
  if (angle < 1e-6) return from;
  return (std::sin((1 - s) * angle) * from + std::sin(s * angle) * to).normalized();
}

/// The rim of a grid of places, counter-clockwise seen from the top.
struct Rim {
  struct Step {
    uint32_t i, j;
    bool corner;
  };
  std::vector<Step> steps;

  Rim(uint32_t rows, uint32_t columns) {
    for (uint32_t i = 0; i + 1 < rows; ++i) steps.push_back({i, 0, i == 0});
    for (uint32_t j = 0; j + 1 < columns; ++j) steps.push_back({rows - 1, j, j == 0});
    for (uint32_t i = rows - 1; i > 0; --i) steps.push_back({i, columns - 1, i == rows - 1});
    for (uint32_t j = columns - 1; j > 0; --j) steps.push_back({0, j, j == columns - 1});
  }
};

/// Returns the direction that points out of the surface at a place on side 0 to 3 of the rim.
Vector3d outwardOf(const Vector3d& tangent_u, const Vector3d& tangent_v, const Vector3d& across, std::size_t side) {
  const Vector3d along = side % 2 == 0 ? tangent_u : tangent_v;
  return unit((side < 2 ? along : Vector3d(-along)).cross(across), across.unitOrthogonal());
}

}  // namespace

Contour::Contour(const Skeleton& skeleton, double chord_error) : columns_(skeleton.control().count[1]) {
  greatest_radius_ = skeleton.radius().greatest();
  chooseLines(skeleton, chord_error);
  if (skeleton.curve()) {
    buildTube(skeleton, chord_error);
  } else {
    buildSheet(skeleton, chord_error);
  }
  at_ = {};
  lines_ = {};
}

/// Returns the number of segments for one interval of the grid. The sagitta is sampled on both sides; it falls with the
/// square of the number of segments.
int Contour::segments(const Skeleton& skeleton, std::size_t axis, std::size_t interval, double chord_error) const {
  const std::vector<double>&along = skeleton.parameters()[axis], &over = skeleton.parameters()[1 - axis];
  double sagitta = 0;
  for (const double w : over) {
    for (const double side : {-1.0, 1.0}) {
      std::array<Vector3d, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        const double t = along[interval] + 0.5 * static_cast<double>(k) * (along[interval + 1] - along[interval]);
        const double u = axis == 0 ? t : w, v = axis == 0 ? w : t;
        spline::SurfacePoint s;
        skeleton.surface().evaluate1(u, v, s);
        const Vector3d across = skeleton.curve() ? s.Sv.unitOrthogonal() : s.Su.cross(s.Sv);
        p[k] = s.S + side * skeleton.radius().evaluate(u, v).f * unit(across, Vector3d::UnitZ());
      }
      sagitta = std::max(sagitta, (p[1] - 0.5 * (p[0] + p[2])).norm());
    }
  }
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(sagitta / chord_error))), kLeastSegments, kMostSegments);
}

void Contour::chooseLines(const Skeleton& skeleton, double chord_error) {
  const ControlGrid& grid = skeleton.control();
  for (std::size_t a = 0; a < 2; ++a) {
    const std::vector<double>& t = skeleton.parameters()[a];
    if (skeleton.curve() && a == 0) {
      at_[a] = {0};
    } else {
      for (std::size_t i = 0; i + 1 < t.size(); ++i) {
        const int n = segments(skeleton, a, i, chord_error);
        for (int k = 0; k < n; ++k) at_[a].push_back(t[i] + (t[i + 1] - t[i]) * k / n);
      }
      at_[a].push_back(t.back());
    }
    for (const double x : at_[a]) {
      std::array<double, spline::kMaxDegree + 1> basis{};
      const int span = spline::findSpan(grid.knots[a], grid.degree[a], x);
      spline::basisFunctions(grid.knots[a], grid.degree[a], span, x, basis);
      Influence line;
      line.count = grid.degree[a] + 1;
      line.first = span - grid.degree[a];
      std::copy_n(basis.begin(), line.count, line.basis.begin());
      lines_[a].push_back(line);
    }
  }
}

int Contour::arcSegments(double chord_error) const {
  const double ratio = std::clamp(chord_error / std::max(greatest_radius_, 1e-12), 1e-6, 1.0);
  return std::clamp(static_cast<int>(std::ceil(M_PI / (2 * std::acos(1 - ratio)))), kLeastArc, kMostSegments);
}

Contour::Place Contour::place(const Skeleton& skeleton, uint32_t i, uint32_t j) const {
  const double u = at_[0][i], v = at_[1][j];
  spline::SurfacePoint s;
  skeleton.surface().evaluate1(u, v, s);
  const ScalarField::Value r = skeleton.radius().evaluate(u, v);
  Place p;
  p.line = {i, j};
  p.center = s.S, p.tangent_u = s.Su, p.tangent_v = s.Sv, p.radius = r.f;
  const Vector3d cross = s.Su.cross(s.Sv);
  const double area2 = cross.squaredNorm();
  p.across = unit(cross, Vector3d::UnitZ());
  p.slope = Vector3d::Zero();
  if (area2 > 0) {
    p.slope = (r.fu * s.Sv.cross(cross) + r.fv * cross.cross(s.Su)) / area2;
  } else if (s.Sv.squaredNorm() > 0) {
    p.slope = r.fv / s.Sv.squaredNorm() * s.Sv;
  }
  const double steep = p.slope.norm();
  if (steep > kSteepestRadius) p.slope *= kSteepestRadius / steep;
  return p;
}

uint32_t Contour::addAt(const Place& place, const Vector3d& normal) {
  const Influence &a = lines_[0][place.line[0]], &b = lines_[1][place.line[1]];
  std::array<Share, (kMaxSkeletonDegree + 1) * (kMaxSkeletonDegree + 1)> shares;
  std::size_t count = 0;
  for (int r = 0; r < a.count; ++r)
    for (int c = 0; c < b.count; ++c)
      shares[count++] = {
          static_cast<uint32_t>((a.first + r) * columns_ + b.first + c),
          static_cast<float>(a.basis[static_cast<std::size_t>(r)] * b.basis[static_cast<std::size_t>(c)])};
  return add(place.center, normal, place.radius, {shares.data(), count});
}

/// Adds triangles between two rows of equal length. They face outward if the outside is on the left when you go along
/// `low` with `high` ahead.
void Contour::strip(const std::vector<uint32_t>& low, const std::vector<uint32_t>& high) {
  for (std::size_t k = 0; k + 1 < low.size(); ++k) {
    triangle(low[k], low[k + 1], high[k + 1]);
    triangle(low[k], high[k + 1], high[k]);
  }
}

void Contour::buildSheet(const Skeleton& skeleton, double chord_error) {
  const auto rows = static_cast<uint32_t>(at_[0].size()), columns = static_cast<uint32_t>(at_[1].size());
  std::array<std::vector<uint32_t>, 2> faces;
  for (const std::size_t face : {0u, 1u}) {
    const double side = face == 0 ? 1 : -1;
    for (uint32_t i = 0; i < rows; ++i) {
      for (uint32_t j = 0; j < columns; ++j) {
        const Place p = place(skeleton, i, j);
        faces[face].push_back(addAt(p, side * std::sqrt(1 - p.slope.squaredNorm()) * p.across - p.slope));
      }
    }
    const auto at = [&](uint32_t i, uint32_t j) { return faces[face][i * columns + j]; };
    for (uint32_t i = 0; i + 1 < rows; ++i) {
      for (uint32_t j = 0; j + 1 < columns; ++j) {
        const uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        face == 0 ? (triangle(a, b, c), triangle(a, c, d)) : (triangle(a, c, b), triangle(a, d, c));
      }
    }
  }
  closeRim(skeleton, faces, arcSegments(chord_error));
}

/// Closes the rim from the top face to the bottom face: half a tube along each side, and a piece of a sphere at each
/// corner.
void Contour::closeRim(const Skeleton& skeleton, const std::array<std::vector<uint32_t>, 2>& faces, int steps) {
  const auto rows = static_cast<uint32_t>(at_[0].size()), columns = static_cast<uint32_t>(at_[1].size());
  const Rim rim(rows, columns);
  std::vector<std::vector<uint32_t>> arcs;  // one for each place of the rim, several at a corner
  const auto addArc = [&](const Rim::Step& at, const Place& p, const Vector3d& outward) {
    const std::size_t face = at.i * columns + at.j;
    const Vector3d top = normal(faces[0][face]);
    const Vector3d bottom = normal(faces[1][face]);
    std::vector<uint32_t> arc{faces[0][face]};
    for (int k = 1; k < steps; ++k) arc.push_back(addAt(p, bend(top, outward, bottom, double(k) / steps)));
    arc.push_back(faces[1][face]);
    arcs.push_back(std::move(arc));
  };
  std::size_t side = 0;
  for (const Rim::Step& at : rim.steps) {
    const bool first = &at == &rim.steps.front();
    const Place p = place(skeleton, at.i, at.j);
    const std::size_t before = first ? 3 : side;
    if (at.corner && !first) ++side;
    const auto outward = [&](std::size_t of) { return outwardOf(p.tangent_u, p.tangent_v, p.across, of); };
    const Vector3d from = outward(before), to = outward(side);
    if (!at.corner) {
      addArc(at, p, to);
      continue;
    }
    const Vector3d middle = unit(from + to, to);
    for (int turn = 0; turn <= steps; ++turn) addArc(at, p, bend(from, middle, to, double(turn) / steps));
  }
  for (std::size_t k = 0; k < arcs.size(); ++k) strip(arcs[k], arcs[(k + 1) % arcs.size()]);
}

void Contour::buildTube(const Skeleton& skeleton, double chord_error) {
  const int steps = arcSegments(chord_error), around = 2 * steps;
  std::vector<std::vector<uint32_t>> rings;
  Vector3d side = Vector3d::Zero();
  // lean: component of the normal along the axis
  const auto addRing = [&](const Place& p, const Vector3d& axis, double lean) {
    const Vector3d other = axis.cross(side);
    if (std::fabs(lean) == 1) {  // a pole
      rings.emplace_back(static_cast<std::size_t>(around) + 1, addAt(p, lean * axis));
      return;
    }
    std::vector<uint32_t> ring;
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * M_PI * k / around;
      ring.push_back(
          addAt(p, std::sqrt(1 - lean * lean) * (std::cos(angle) * side + std::sin(angle) * other) + lean * axis));
    }
    ring.push_back(ring.front());
    rings.push_back(std::move(ring));
  };
  const auto count = static_cast<uint32_t>(at_[1].size());
  for (uint32_t j = 0; j < count; ++j) {
    const Place p = place(skeleton, 0, j);
    const Vector3d axis = unit(p.tangent_v, Vector3d::UnitX());
    side = unit(side - side.dot(axis) * axis, axis.unitOrthogonal());  // moved along the curve without twist
    const double lean = -p.slope.dot(axis);
    const auto cap = [&](double pole, int k) {  // from the pole (k = 0) to the ring (k = steps)
      const double start = pole * M_PI_2, end = std::asin(lean);
      return std::sin(start + (end - start) * k / steps);
    };
    for (int k = 0; j == 0 && k < steps; ++k) addRing(p, axis, cap(-1, k));
    addRing(p, axis, lean);
    for (int k = steps - 1; j + 1 == count && k >= 0; --k) addRing(p, axis, cap(1, k));
  }
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) strip(rings[k], rings[k + 1]);
}

}  // namespace hapticd::medial
