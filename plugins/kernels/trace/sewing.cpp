// SPDX-License-Identifier: MIT
#include "kernels/trace/sewing.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "kernels/trace/side_curve.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr double kSewShare = 1e-5;  // default tolerance, relative to the model's diagonal
constexpr int kMaxWarnings = 100;

Array2d cornerUv(const Patch& patch, int corner) {
  return {corner % 2 == 0 ? patch.lo[0] : patch.hi[0], corner / 2 == 0 ? patch.lo[1] : patch.hi[1]};
}

/// Gives points that are closer than a tolerance the same index. A hash grid keeps the time linear in the number of
/// points.
class PointMerger {
 public:
  explicit PointMerger(double tolerance) : tolerance_(tolerance) {}
  int indexOf(const Vector3d& p) {
    const std::array<long, 3> cell = cellOf(p);
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        for (long dz = -1; dz <= 1; ++dz) {
          const auto found = cells_.find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (found == cells_.end()) continue;
          for (int index : found->second)
            if ((points_[static_cast<std::size_t>(index)] - p).norm() <= tolerance_) return index;
        }
    cells_[cell].push_back(static_cast<int>(points_.size()));
    points_.push_back(p);
    return static_cast<int>(points_.size()) - 1;
  }
  int count() const { return static_cast<int>(points_.size()); }

 private:
  std::array<long, 3> cellOf(const Vector3d& p) {
    // cells are counted from this point, so that large coordinates do not overflow a cell number
    if (points_.empty()) origin_ = p;
    const Vector3d q = (p - origin_) / (2 * tolerance_);
    return {std::lround(q.x()), std::lround(q.y()), std::lround(q.z())};
  }
  double tolerance_;
  Vector3d origin_{0, 0, 0};
  std::map<std::array<long, 3>, std::vector<int>> cells_;
  std::vector<Vector3d> points_;
};

}  // namespace

Sewing::Sewing(Model& model, const ModelOptions& options) : model_(model), options_(options) {
  const double diagonal = model.bounds_.diagonal().norm();
  tolerance_ = options.sew_tolerance > 0 ? options.sew_tolerance : kSewShare * diagonal;
  // The tolerance must not be smaller than the rounding of the coordinates.
  tolerance_ = std::max({tolerance_, 1e-14 * model.bounds_.max().cwiseAbs().maxCoeff(), 1e-100});
}

void Sewing::run() {
  findVertices();
  findPoles();
  collectCurves();
  joinStated();
  joinByGeometry();
  reportTJunctions();
  reportDisagreement();
  findShells();
  findVertexNormals();
}

void Sewing::findVertices() {
  PointMerger merger(tolerance_);
  spline::SurfacePoint E;
  for (Patch& patch : model_.patches_)
    for (int corner = 0; corner < kCorners; ++corner) {
      const Array2d uv = cornerUv(patch, corner);
      patch.surface.evaluate1(uv[0], uv[1], E);
      patch.corners[static_cast<std::size_t>(corner)] = merger.indexOf(E.S);
    }
  model_.vertex_normal_.assign(static_cast<std::size_t>(merger.count()), Vector3d::Zero());
}

void Sewing::findPoles() {
  constexpr int kPoints = 9;
  std::map<int, int> fan_at;  // index of a fan for each vertex
  for (int index = 0; index < model_.patchCount(); ++index) {
    Patch& patch = model_.patches_[static_cast<std::size_t>(index)];
    for (int side = 0; side < kSides; ++side) {
      double extent = 0;
      const Vector3d apex = pointOnSide(patch, side, 0);
      for (int i = 1; i < kPoints; ++i)
        extent = std::max(extent, (pointOnSide(patch, side, i / (kPoints - 1.0)) - apex).norm());
      if (extent > tolerance_) continue;
      patch.side(side).kind = SideKind::kPole;
      const int pole = static_cast<int>(model_.poles_.size());
      patch.side(side).pole = pole;
      model_.poles_.push_back(fanOf(patch, side));
      PoleFan& fan = model_.poles_.back();
      fan.patch = index;
      fan.side = side;
      const int vertex = patch.corners[static_cast<std::size_t>(Patch::endsOf(side)[0])];
      PoleFan& first = model_.poles_[static_cast<std::size_t>(fan_at.emplace(vertex, pole).first->second)];
      fan.next = first.next >= 0 ? first.next : pole;
      first.next = pole;
    }
  }
}

void Sewing::collectCurves() {
  for (int index = 0; index < model_.patchCount(); ++index) {
    const Patch& patch = model_.patch(index);
    for (int side = 0; side < kSides; ++side) {
      if (patch.side(side).kind == SideKind::kPole) continue;
      SideCurve curve{index, side, {}};
      for (int i = 0; i < kSamples; ++i)
        curve.points[static_cast<std::size_t>(i)] = pointOnSide(patch, side, i / (kSamples - 1.0));
      curves_.push_back(curve);
    }
  }
}

void Sewing::joinStated() {
  const auto find = [this](const EdgeEnd& end) -> SideCurve* {
    if (end.surface < 0 || end.surface >= model_.surfaceCount())
      throw std::invalid_argument("edges: there is no surface " + std::to_string(end.surface) + ", expected 0 to " +
                                  std::to_string(model_.surfaceCount() - 1));
    const int first = model_.firstPatch(end.surface);
    // the surface has creases, so its outer sides are joined by geometry
    if (model_.lastPatch(end.surface) != first + 1) return nullptr;
    for (SideCurve& curve : curves_)
      if (curve.patch == first && curve.side == end.side) return &curve;
    return nullptr;
  };
  for (const EdgeLink& link : options_.edges) {
    SideCurve *a = find(link.a), *b = find(link.b);
    if (a != nullptr && b != nullptr && !a->used && !b->used) join(*a, *b, link.flipped);
  }
}

void Sewing::joinByGeometry() {
  std::map<std::array<int, 2>, std::vector<SideCurve*>> by_ends;
  for (SideCurve& curve : curves_) {
    const auto ends = Patch::endsOf(curve.side);
    const auto& corners = model_.patch(curve.patch).corners;
    int a = corners[static_cast<std::size_t>(ends[0])], b = corners[static_cast<std::size_t>(ends[1])];
    if (a > b) std::swap(a, b);
    by_ends[{a, b}].push_back(&curve);
  }
  for (auto& [ends, group] : by_ends) {
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (std::size_t j = i + 1; j < group.size() && !group[i]->used; ++j) {
        if (group[j]->used) continue;
        const bool flipped = runsBack(*group[i], *group[j]);
        if (runsAlong(*group[i], *group[j], flipped)) join(*group[i], *group[j], flipped);
      }
    }
    for (const SideCurve* curve : group)
      for (const SideCurve* other : group)
        if (!curve->used && other->used && (runsAlong(*curve, *other, false) || runsAlong(*curve, *other, true)))
          model_.warnings_.push_back(describe(curve->patch, curve->side) + " lies on an edge that already joins " +
                                     describe(other->patch, other->side) +
                                     " and another surface; this side is left open");
  }
}

/// True if the parameters of an edge run in opposite directions on its two surfaces. The samples of both sides are
/// compared in both directions, and the direction with the smaller distances is right. The nearest points cannot decide
/// this, because along a straight side they are found from any start.
bool Sewing::runsBack(const SideCurve& a, const SideCurve& b) {
  double along = 0, back = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    along += (a.points[i] - b.points[i]).norm();
    back += (a.points[i] - b.points[kSamples - 1 - i]).norm();
  }
  return back < along;
}

bool Sewing::runsAlong(const SideCurve& a, const SideCurve& b, bool flipped) const {
  const Patch& other = model_.patch(b.patch);
  for (int i = 0; i < kSamples; ++i) {
    const double fraction = i / (kSamples - 1.0);
    const Vector3d& p = a.points[static_cast<std::size_t>(i)];
    // The edge may have different parameterisations on its two surfaces, so compare with the nearest point.
    const double there = nearestFraction(other, b.side, p, flipped ? 1 - fraction : fraction);
    if (!((pointOnSide(other, b.side, there) - p).norm() <= tolerance_)) return false;
  }
  return true;
}

void Sewing::join(SideCurve& a, SideCurve& b, bool flipped) {
  const auto link = [this, flipped](const SideCurve& from, const SideCurve& to) {
    Side& side = model_.patches_[static_cast<std::size_t>(from.patch)].side(from.side);
    side.kind = SideKind::kJoined;
    side.patch = to.patch;
    side.side = to.side;
    side.flipped = flipped;
  };
  link(a, b);
  link(b, a);
  a.used = b.used = true;
}

void Sewing::reportTJunctions() {
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<const SideCurve*> open;
  for (const SideCurve& curve : curves_) {
    if (curve.used) continue;
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : curve.points) box.extend(p);
    const double slack = tolerance_ + 0.5 * box.diagonal().norm();  // a side may bulge between its samples
    boxes.emplace_back(box.min().array() - slack, box.max().array() + slack);
    open.push_back(&curve);
  }
  for (std::size_t i = 0; i < open.size(); ++i)
    for (std::size_t j = 0; j < open.size() && model_.warnings_.size() < kMaxWarnings; ++j) {
      if (open[i]->patch == open[j]->patch || !boxes[j].contains(open[i]->points[kSamples / 2])) continue;
      const Patch& other = model_.patch(open[j]->patch);
      const Vector3d& middle = open[i]->points[kSamples / 2];
      const double there = nearestFraction(other, open[j]->side, middle, 0.5);
      if ((pointOnSide(other, open[j]->side, there) - middle).norm() <= tolerance_)
        model_.warnings_.push_back("T-junction: " + describe(open[i]->patch, open[i]->side) + " covers a part of " +
                                   describe(open[j]->patch, open[j]->side) +
                                   "; both sides are left open; to join them, split the longer one there");
    }
}

/// Warns of neighbours whose outward normals are on opposite sides. Seen from outside, a surface lies to the left of
/// its boundary. So the boundaries of two surfaces with consistent normals run along their common edge in opposite
/// directions.
void Sewing::reportDisagreement() {
  // 1 if the boundary runs along the parameter of the side, -1 if it runs against it
  constexpr std::array<int, kSides> kCounterClockwise{-1, 1, 1, -1};
  for (int i = 0; i < model_.patchCount(); ++i)
    for (int s = 0; s < kSides && model_.warnings_.size() < kMaxWarnings; ++s) {
      const Patch& patch = model_.patch(i);
      const Side& side = patch.side(s);
      if (side.kind != SideKind::kJoined || std::pair(side.patch, side.side) < std::pair(i, s)) continue;
      const Patch& other = model_.patch(side.patch);
      const double one = patch.sign * kCounterClockwise[static_cast<std::size_t>(s)];
      const double two = other.sign * kCounterClockwise[static_cast<std::size_t>(side.side)] * (side.flipped ? -1 : 1);
      if (one * two > 0)
        model_.warnings_.push_back(describe(i, s) + " joins " + describe(side.patch, side.side) +
                                   ", but the outward normals of the two are on opposite sides; expected "
                                   "`outward: reversed` on one of them");
    }
}

void Sewing::findShells() {
  std::vector<int> root(static_cast<std::size_t>(model_.patchCount()));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](int i) {
    while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)];
    return i;
  };
  for (int i = 0; i < model_.patchCount(); ++i)
    for (const Side& side : model_.patch(i).sides)
      if (side.kind == SideKind::kJoined) {
        const int a = find(i), b = find(side.patch);
        root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
  std::map<int, int> number;
  for (int i = 0; i < model_.patchCount(); ++i) {
    Patch& patch = model_.patches_[static_cast<std::size_t>(i)];
    const auto [at, added] = number.emplace(find(i), static_cast<int>(number.size()));
    if (added) model_.shell_closed_.push_back(1);
    patch.shell = at->second;
    for (const Side& side : patch.sides)
      if (side.kind == SideKind::kFree) model_.shell_closed_[static_cast<std::size_t>(patch.shell)] = 0;
  }
}

void Sewing::findVertexNormals() {
  const auto normalOf = [this](const Patch& patch, int corner) -> Vector3d& {
    return model_.vertex_normal_[static_cast<std::size_t>(patch.corners[static_cast<std::size_t>(corner)])];
  };
  for (const Patch& patch : model_.patches_) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const auto kindOf = [&patch](int side) { return patch.side(side).kind; };
      if (kindOf(corner % 2) != SideKind::kPole && kindOf(2 + corner / 2) != SideKind::kPole)
        normalOf(patch, corner) += cornerAngle(patch, corner) * patch.normalAt(cornerUv(patch, corner));
    }
    for (int side = 0; side < kSides; ++side)
      if (const int pole = patch.side(side).pole; pole >= 0)
        normalOf(patch, Patch::endsOf(side)[0]) += fanNormal(patch, side, model_.pole(pole));
  }
  for (Vector3d& normal : model_.vertex_normal_) {
    const double length = normal.norm();
    if (length > 0) normal /= length;
  }
}

std::string Sewing::describe(int patch, int side) const {
  static constexpr std::array<const char*, kSides> kNames = {"u = lo", "u = hi", "v = lo", "v = hi"};
  return model_.names_[static_cast<std::size_t>(model_.patch(patch).source)] + " side " +
         kNames[static_cast<std::size_t>(side)];
}

}  // namespace hapticd::trace
