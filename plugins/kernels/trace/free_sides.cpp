// SPDX-License-Identifier: MIT
#include "kernels/trace/free_sides.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

/// Returns how many rows of control points the end of a surface depends on: one if the knots are clamped there.
int rowsAtEnd(const spline::SurfaceData& data, int axis, bool first) {
  const std::vector<double>& knots = data.knots[static_cast<std::size_t>(axis)];
  const double end = data.domain(axis)[first ? 0 : 1];
  const auto equal = std::count(knots.begin(), knots.end(), end);
  const int degree = data.degree[static_cast<std::size_t>(axis)];
  return std::max(1, degree + 1 - static_cast<int>(equal));
}

/// Returns the control points of `rows` rows at the end of a surface, row by row.
std::vector<std::vector<Vector3d>> rowsOfSide(const spline::SurfaceData& data, int side) {
  const int axis = Patch::axisOf(side), rows = rowsAtEnd(data, axis, side % 2 == 0);
  std::vector<std::vector<Vector3d>> points(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < data.count(1 - axis); ++k) {
      const int across = side % 2 == 0 ? row : data.count(axis) - 1 - row;
      const int i = axis == 0 ? across : k, j = axis == 0 ? k : across;
      points[static_cast<std::size_t>(row)].push_back(data.points[static_cast<std::size_t>(i * data.count(1) + j)]);
    }
  return points;
}

}  // namespace

double SidePiece::squaredDistanceToAxis(const Vector3d& p) const noexcept {
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - start).dot(along) / length2, 0.0, 1.0) : 0;
  return (p - start - t * along).squaredNorm();
}

/// A span of a spline lies in the convex hull of the degree + 1 control points that it depends on, and a hull about a
/// segment is as wide as its farthest point.
SidePieces piecesOfSides(const spline::SurfaceData& data) {
  SidePieces pieces;
  for (int side = 0; side < kSides; ++side) {
    const auto rows = rowsOfSide(data, side);
    const auto degree = static_cast<std::size_t>(data.degree[static_cast<std::size_t>(1 - Patch::axisOf(side))]);
    for (std::size_t first = 0; first + degree < rows[0].size(); ++first) {
      SidePiece piece;
      piece.start = rows[0][first];
      piece.along = rows[0][first + degree] - piece.start;
      double radius2 = 0;
      for (const auto& row : rows)
        for (std::size_t k = first; k <= first + degree; ++k)
          radius2 = std::max(radius2, piece.squaredDistanceToAxis(row[k]));
      piece.radius = std::sqrt(radius2);
      pieces[static_cast<std::size_t>(side)].push_back(piece);
    }
  }
  return pieces;
}

void FreeSides::add(const SidePiece& piece, std::size_t shell) {
  if (groups_.size() == first_group_[shell] || groups_.back().count == kGroup)
    groups_.push_back({Eigen::AlignedBox3d(), pieces_.size(), 0});
  Group& group = groups_.back();
  const Vector3d around = Vector3d::Constant(piece.radius), end = piece.start + piece.along;
  group.box.extend(Eigen::AlignedBox3d(piece.start.cwiseMin(end) - around, piece.start.cwiseMax(end) + around));
  ++group.count;
  pieces_.push_back(piece);
}

void FreeSides::keep(const std::vector<Patch>& patches, int shells, const std::vector<SidePieces>& pieces) {
  std::vector<std::vector<std::size_t>> of_shell(static_cast<std::size_t>(shells));
  for (std::size_t i = 0; i < patches.size(); ++i) of_shell[static_cast<std::size_t>(patches[i].shell)].push_back(i);
  for (std::size_t shell = 0; shell < of_shell.size(); ++shell) {
    first_group_.push_back(groups_.size());
    for (const std::size_t i : of_shell[shell])
      for (std::size_t side = 0; side < kSides; ++side)
        if (patches[i].sides[side].kind == SideKind::kFree)
          for (const SidePiece& piece : pieces[i][side]) add(piece, shell);
  }
  first_group_.push_back(groups_.size());
  pieces_.shrink_to_fit();
  groups_.shrink_to_fit();
}

bool FreeSides::areBeyond(int shell, const Vector3d& p, double reach) const noexcept {
  const auto at = static_cast<std::size_t>(shell);
  if (first_group_[at + 1] - first_group_[at] > kMostGroups) return false;
  for (std::size_t g = first_group_[at]; g < first_group_[at + 1]; ++g) {
    const Group& group = groups_[g];
    if (group.box.squaredExteriorDistance(p) > reach * reach) continue;
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      const double within = reach + pieces_[i].radius;
      if (!(pieces_[i].squaredDistanceToAxis(p) > within * within)) return false;
    }
  }
  return true;
}

std::size_t FreeSides::bytes() const noexcept {
  return pieces_.capacity() * sizeof(SidePiece) + groups_.capacity() * sizeof(Group) +
         first_group_.capacity() * sizeof(std::size_t);
}

}  // namespace hapticd::trace
