// SPDX-License-Identifier: MIT
#include "corner_slips.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace hapticd {
namespace {

using Eigen::Vector3d;
using spline::SurfaceData;

constexpr double kSame = 1e-5;  ///< points that are nearer than this share of the model's size agree

/// One side of a surface: the indices of its control points, in the list of the surface.
struct Side {
  std::size_t surface = 0;
  std::vector<std::size_t> points;
  bool joined = false;  ///< true if another surface has the same side
};

/// A control point that disagrees, and the one of the neighbour that it should be.
struct Slip {
  std::size_t surface, point, other, meant;
};

class CornerSlips {
 public:
  CornerSlips(const ModelFile& file, Problems& odd) : file_(file), odd_(odd) {
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < file.surfaces.size(); ++i) {
      addSides(i);
      for (const Vector3d& point : file.surfaces[i].points) box.extend(point);
    }
    same_ = kSame * box.diagonal().norm();
  }

  std::set<std::pair<std::size_t, std::size_t>> tell() {
    for (Side& a : sides_)
      for (Side& b : sides_)
        if (a.surface < b.surface && (mismatches(a, b, false).empty() || mismatches(a, b, true).empty())) {
          a.joined = b.joined = true;
          joined_.insert({a.surface, b.surface});
        }
    for (const Side& a : sides_)
      for (const Side& b : sides_) {
        if (a.surface >= b.surface || a.joined || b.joined || joined_.contains({a.surface, b.surface})) continue;
        for (const bool turned : {false, true}) judge(a, b, turned);
      }
    return told_;
  }

 private:
  const Vector3d& at(std::size_t surface, std::size_t point) const { return file_.surfaces[surface].points[point]; }

  void addSides(std::size_t index) {
    const SurfaceData& surface = file_.surfaces[index];
    const auto rows = static_cast<std::size_t>(surface.count(0)), columns = static_cast<std::size_t>(surface.count(1));
    std::array<Side, 4> sides;
    for (std::size_t j = 0; j < columns; ++j) {
      sides[0].points.push_back(j);
      sides[1].points.push_back((rows - 1) * columns + j);
    }
    for (std::size_t i = 0; i < rows; ++i) {
      sides[2].points.push_back(i * columns);
      sides[3].points.push_back(i * columns + columns - 1);
    }
    for (Side& side : sides) {
      side.surface = index;
      if ((at(index, side.points.front()) - at(index, side.points.back())).norm() > 0) sides_.push_back(side);
    }
  }

  /// Returns the places along the sides where they disagree, at most two; three places if they have other numbers of
  /// points.
  std::vector<std::size_t> mismatches(const Side& a, const Side& b, bool turned) const {
    std::vector<std::size_t> found;
    const std::size_t count = a.points.size();
    if (count != b.points.size()) return {0, 0, 0};
    for (std::size_t i = 0; i < count && found.size() < 2; ++i)
      if ((at(a.surface, a.points[i]) - at(b.surface, b.points[turned ? count - 1 - i : i])).norm() > same_)
        found.push_back(i);
    return found;
  }

  void judge(const Side& a, const Side& b, bool turned) {
    const std::vector<std::size_t> found = mismatches(a, b, turned);
    if (found.size() != 1 || told_.contains({a.surface, b.surface})) return;
    const std::size_t of_a = a.points[found[0]], of_b = b.points[turned ? b.points.size() - 1 - found[0] : found[0]];
    const Slip first{a.surface, of_a, b.surface, of_b}, second{b.surface, of_b, a.surface, of_a};
    if (restores(second)) return tell(second);
    if (restores(first)) return tell(first);
    if (a.points.size() > 2 || isTenfold(a, first)) tell(farOff(first) > farOff(second) ? first : second);
  }

  /// Returns true if a bilinear surface becomes a parallelogram with the corner of its neighbour.
  bool restores(const Slip& slip) const {
    const SurfaceData& surface = file_.surfaces[slip.surface];
    const auto rows = static_cast<std::size_t>(surface.count(0)), columns = static_cast<std::size_t>(surface.count(1));
    Vector3d skew = Vector3d::Zero();
    for (const std::size_t row : {std::size_t{0}, rows - 1})
      for (const std::size_t column : {std::size_t{0}, columns - 1}) {
        const std::size_t corner = row * columns + column;
        const Vector3d& p = corner == slip.point ? at(slip.other, slip.meant) : surface.points[corner];
        skew += (row == 0) == (column == 0) ? p : Vector3d(-p);
      }
    return skew.norm() <= same_;
  }

  /// Returns true if two points differ in one coordinate alone, by a power of ten, and not along the side, where a side
  /// may end earlier on purpose.
  bool isTenfold(const Side& a, const Slip& slip) const {
    constexpr double kExact = 1e-6, kAlong = 0.99;
    const Vector3d &p = at(slip.surface, slip.point), &q = at(slip.other, slip.meant), gap = p - q;
    Eigen::Index axis = 0;
    const double most = gap.cwiseAbs().maxCoeff(&axis);
    if (gap.lpNorm<1>() - most > same_ || p[axis] == 0 || q[axis] == 0 || p[axis] / q[axis] < 0) return false;
    const double power = std::log10(p[axis] / q[axis]);
    if (std::abs(power - std::round(power)) > kExact || std::round(power) == 0) return false;
    const std::size_t common = a.points.front() == slip.point ? a.points.back() : a.points.front();
    const Vector3d side = q - at(slip.surface, common);
    return std::abs(gap.dot(side)) < kAlong * gap.norm() * side.norm();
  }

  /// [m] Returns how far a point is from the middle of its surface's other points.
  double farOff(const Slip& slip) const {
    Vector3d sum = Vector3d::Zero();
    const std::vector<Vector3d>& points = file_.surfaces[slip.surface].points;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (i != slip.point) sum += points[i];
    return (at(slip.surface, slip.point) - sum / static_cast<double>(points.size() - 1)).norm();
  }

  void tell(const Slip& slip) {
    told_.insert({std::min(slip.surface, slip.other), std::max(slip.surface, slip.other)});
    if (!points_.insert({slip.surface, slip.point}).second) return;  // two neighbours miss the same corner
    const Vector3d &p = at(slip.surface, slip.point), &q = at(slip.other, slip.meant);
    char text[800];
    std::snprintf(text, sizeof text,
                  "there is a gap between %.60s and %.60s: two of their sides agree but for this point, [%g, %g, %g], "
                  "which is [%g, %g, %g] in %.60s, %.3g mm away; is a coordinate mistyped?",
                  nameOf(slip.surface).c_str(), nameOf(slip.other).c_str(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                  nameOf(slip.other).c_str(), 1e3 * (p - q).norm());
    odd_.add({{"surfaces", 0}, {"", slip.surface}, {"points", 0}, {"", slip.point}}, text);
  }

  std::string nameOf(std::size_t surface) const {
    const std::string& name = file_.surfaces[surface].name;
    return name.empty() ? "surface " + std::to_string(surface) : "'" + name + "'";
  }

  const ModelFile& file_;
  Problems& odd_;
  std::vector<Side> sides_;
  double same_ = 0;
  std::set<std::pair<std::size_t, std::size_t>> joined_, told_, points_;
};

}  // namespace

std::set<std::pair<std::size_t, std::size_t>> warnOfCornerSlips(const ModelFile& file, Problems& odd) {
  constexpr std::size_t kMost = 250;  // surfaces; each is compared with each other
  if (file.surfaces.size() > kMost) return {};
  return CornerSlips(file, odd).tell();
}

}  // namespace hapticd
