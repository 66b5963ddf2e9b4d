// SPDX-License-Identifier: MIT
#include "kernels/trace/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr int kFine = 8, kCoarse = 4;  // cells along each side of the grid by which a patch is approximated
constexpr double kInside = 0.75;       // a point with a greater winding number is well inside (on a surface it is 0.5)
constexpr double kOutside = 0.25;      // a point with a smaller winding number is well outside
constexpr std::size_t kMostWork = 20'000'000;  // most solid angles that are computed, in about a second
constexpr std::size_t kFinePatches = 64;       // if there are more patches, the coarse grid is used

struct Triangle {
  Vector3d a, b, c;
};

/// A coarse approximation of a shell by triangles.
struct Sketch {
  std::vector<Triangle> triangles;
  std::vector<Vector3d> points;
  Eigen::AlignedBox3d box;
  Vector3d turned{0, 0, 0};  ///< sum of the outward normals, weighted by area
  double area = 0;
  bool closed = false;

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
    const Vector3d normal = (sign > 0 ? 0.5 : -0.5) * (b - a).cross(c - a);
    area += normal.norm();
    turned += normal;
    triangles.push_back(sign > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  }

  Vector3d middle() const { return box.center(); }
};

/// Returns the solid angle of a triangle divided by 4 pi, positive if its outward side faces away from p (Van Oosterom
/// & Strackee 1983).
double winding(const Triangle& t, const Vector3d& p) {
  const Vector3d a = t.a - p, b = t.b - p, c = t.c - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double up = a.dot(b.cross(c)), down = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return up == 0 ? 0 : std::atan2(up, down) / (2 * std::numbers::pi);
}

/// The parts found so far, and the work spent on them.
class Grouping {
 public:
  Grouping(const std::vector<Sketch>& shells) : shells_(shells) {}

  /// Returns the part of a shell: the first part that the shell does not overlap.
  int place(std::size_t shell) {
    std::size_t to = 0;
    while (to < parts_.size() && runInto(shell, parts_[to])) ++to;
    if (to >= Model::kMaxParts) {
      complete_ = false;
      to = 0;
    }
    if (to == parts_.size()) parts_.emplace_back();
    parts_[to].push_back(shell);
    return static_cast<int>(to);
  }

  bool complete() const { return complete_; }

 private:
  using Part = std::vector<std::size_t>;  ///< indices of shells

  bool runInto(std::size_t shell, const Part& part) {
    if (intoOne(shell, part)) return true;
    for (std::size_t other : part)
      if (shells_[other].box.intersects(shells_[shell].box) && intoOne(other, {shell})) return true;
    return false;
  }

  /// True if one point of a shell is well inside a part and another point is well outside.
  bool intoOne(std::size_t shell, const Part& part) {
    bool in = false, out = false;
    for (std::size_t i = 0; i < shells_[shell].points.size() && !(in && out); ++i) {
      const double number = windingOf(part, shells_[shell].points[i]);
      in = in || number > kInside;
      out = out || number < kOutside;
    }
    return in && out;
  }

  double windingOf(const Part& part, const Vector3d& p) {
    double number = 0;
    for (std::size_t other : part) {
      const Sketch& solid = shells_[other];
      if (solid.closed && !solid.box.contains(p)) continue;
      const Vector3d r = solid.middle() - p;
      const double far = r.norm();
      if (far > kFar * solid.box.diagonal().norm()) {
        number += r.dot(solid.turned) / (4 * std::numbers::pi * far * far * far);  // a dipole (Barill et al. 2018)
        continue;
      }
      work_ += solid.triangles.size();
      if (work_ > kMostWork) {
        complete_ = false;
        return 0;
      }
      for (const Triangle& triangle : solid.triangles) number += winding(triangle, p);
    }
    work_ += part.size() / kDipoles;
    return number;
  }

  static constexpr double kFar = 2;  // in diagonals of the shell's box; a farther shell is treated as a dipole
  static constexpr std::size_t kDipoles = 16;  // the number of dipoles or boxes that take as long as one solid angle
  const std::vector<Sketch>& shells_;
  std::vector<Part> parts_;
  std::size_t work_ = 0;
  bool complete_ = true;
};

}  // namespace

std::vector<int> groupShells(const Model& model, bool& complete) {
  std::vector<int> part(static_cast<std::size_t>(model.shellCount()), 0);
  complete = true;
  if (part.size() < 2) return part;
  const int cells = static_cast<std::size_t>(model.patchCount()) > kFinePatches ? kCoarse : kFine;
  std::vector<Sketch> shells(part.size());
  for (int i = 0; i < model.patchCount(); ++i)
    shells[static_cast<std::size_t>(model.patch(i).shell)].add(model.patch(i), cells);
  for (int i = 0; i < model.shellCount(); ++i) shells[static_cast<std::size_t>(i)].closed = model.closed(i);
  std::vector<std::size_t> order(part.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&shells](std::size_t a, std::size_t b) { return shells[a].area > shells[b].area; });
  Grouping grouping(shells);
  for (std::size_t shell : order) part[shell] = grouping.place(shell);
  complete = grouping.complete();
  return part;
}

}  // namespace hapticd::trace
