#include "kernels/trace/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr int kFine = 8, kCoarse = 4;  // cells a side of the grid that stands for a patch
constexpr double kInside = 0.75;       // winding numbers: a probe on a surface sees 0.5
constexpr double kOutside = 0.25;
constexpr std::size_t kMostWork = 20'000'000;  // solid angles: about a second

struct Triangle {
  Vector3d a, b, c;
};

/// A shell, coarsely.
struct Sketch {
  std::vector<Triangle> triangles;
  std::vector<Vector3d> points;
  Eigen::AlignedBox3d box;
  double area = 0;

  void add(const Patch& patch, int cells) {
    std::array<Vector3d, (kFine + 1) * (kFine + 1)> grid;
    spline::SurfacePoint E;
    const auto at = [&](int i, int j) -> Vector3d& { return grid[static_cast<std::size_t>(i * (cells + 1) + j)]; };
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= cells; ++j) {
        const Array2d uv = patch.lo + (patch.hi - patch.lo) * Array2d(i, j) / cells;
        patch.surface.evaluate1(uv[0], uv[1], E);
        at(i, j) = E.S;
        box.extend(E.S);
        if (i % 2 == 0 && j % 2 == 0) points.push_back(E.S);
      }
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        addTriangle(at(i, j), at(i + 1, j), at(i + 1, j + 1), patch.sign);
        addTriangle(at(i, j), at(i + 1, j + 1), at(i, j + 1), patch.sign);
      }
  }

  void addTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, double sign) {
    area += 0.5 * (b - a).cross(c - a).norm();
    triangles.push_back(sign > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  }

  void add(const Sketch& other) {
    triangles.insert(triangles.end(), other.triangles.begin(), other.triangles.end());
    points.insert(points.end(), other.points.begin(), other.points.end());
    box.extend(other.box);
  }
};

/// Solid angle of a triangle over 4 pi, positive if its outward side is away from p (Van Oosterom & Strackee 1983).
double winding(const Triangle& t, const Vector3d& p) {
  const Vector3d a = t.a - p, b = t.b - p, c = t.c - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double up = a.dot(b.cross(c)), down = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return up == 0 ? 0 : std::atan2(up, down) / (2 * std::numbers::pi);
}

/// Whether a point of `other` is well inside `solid` while another is well outside.
bool runsInto(const Sketch& other, const Sketch& solid) {
  bool in = false, out = false;
  for (std::size_t i = 0; i < other.points.size() && !(in && out); ++i) {
    const Vector3d& p = other.points[i];
    double number = 0;
    if (solid.box.contains(p))
      for (const Triangle& triangle : solid.triangles) number += winding(triangle, p);
    in = in || number > kInside;
    out = out || number < kOutside;
  }
  return in && out;
}

}  // namespace

std::vector<int> groupShells(const Model& model) {
  std::vector<int> part(static_cast<std::size_t>(model.shellCount()), 0);
  const auto patches = static_cast<std::size_t>(model.patchCount());
  const auto work = [patches](int cells) {  // all points against all triangles
    const auto n = static_cast<std::size_t>(cells);
    return patches * patches * 2 * n * n * (n / 2 + 1) * (n / 2 + 1);
  };
  if (part.size() < 2 || work(kCoarse) > kMostWork) return part;
  const int cells = work(kFine) > kMostWork ? kCoarse : kFine;
  std::vector<Sketch> shells(part.size());
  for (int i = 0; i < model.patchCount(); ++i)
    shells[static_cast<std::size_t>(model.patch(i).shell)].add(model.patch(i), cells);
  std::vector<std::size_t> order(part.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&shells](std::size_t a, std::size_t b) { return shells[a].area > shells[b].area; });
  std::vector<Sketch> parts;
  for (std::size_t shell : order) {
    std::size_t to = 0;
    while (to < parts.size() && (runsInto(shells[shell], parts[to]) || runsInto(parts[to], shells[shell]))) ++to;
    if (to >= Model::kMaxParts) to = 0;
    if (to == parts.size()) parts.emplace_back();
    parts[to].add(shells[shell]);
    part[shell] = static_cast<int>(to);
  }
  return part;
}

std::vector<char> findGaps(const Model& model) {
  constexpr int kSamples = 8;
  constexpr double kSmall = 0.1;  // of the area
  std::vector<Vector3d> sum(static_cast<std::size_t>(model.partCount()), Vector3d::Zero());
  std::vector<double> area(sum.size(), 0);
  std::vector<char> gaps(sum.size(), 0);
  spline::SurfacePoint E;
  for (int i = 0; i < model.patchCount(); ++i) {
    const Patch& patch = model.patch(i);
    const auto part = static_cast<std::size_t>(model.part(patch.shell));
    if (!model.closed(patch.shell)) gaps[part] = 1;
    const double share = (patch.hi - patch.lo).prod() / (kSamples * kSamples);
    for (int k = 0; k < kSamples * kSamples; ++k) {
      const Array2d middle(k / kSamples + 0.5, k % kSamples + 0.5);
      const Array2d uv = patch.lo + (patch.hi - patch.lo) * middle / kSamples;
      patch.surface.evaluate1(uv[0], uv[1], E);
      const Vector3d piece = share * patch.sign * E.Su.cross(E.Sv);
      sum[part] += piece;
      area[part] += piece.norm();
    }
  }
  for (std::size_t part = 0; part < sum.size(); ++part)
    if (!(sum[part].norm() < kSmall * area[part])) gaps[part] = 0;
  return gaps;
}

}  // namespace hapticd::trace
