// SPDX-License-Identifier: MIT
#include "kernels/brep/tight_bounds.hpp"

#include <algorithm>
#include <limits>

#include "kernels/brep/tracer.hpp"

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// How far away a look at the part is from, in diagonals. The nearest point of a probe there lies farthest out, except
/// that points beside the probe's line count as lower, by at most half a diagonal divided by this number. Very far away
/// a search proves less, so a nearer look follows.
constexpr double kAfar[] = {1e4, 1e3, 1e2, 1e1};
constexpr double kAside = 1e-3;  ///< diagonals
constexpr int kMostLooks = 20;
constexpr SearchBudget kPatient{1 << 20, 1 << 18};  // no servo waits for this

/// Returns the point that lies farthest out, as seen from above `below`. Where no look proves it, as over a pole, the
/// farthest of all that were found counts: it is a point of the part at least.
Vector3d lookFrom(Tracer& tracer, const Vector3d& below, const Vector3d& direction) {
  const double size = tracer.model().bounds().diagonal().norm();
  const Vector3d aside = kAside * size * Vector3d(direction.y(), direction.z(), direction.x());
  Vector3d farthest = Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (const double afar : kAfar)
    for (const Vector3d& above : {below, Vector3d(below + aside)}) {
      const contact::Foot foot = tracer.nearest(above + afar * size * direction, kPatient);
      if (foot.status == contact::FootStatus::kNearest) return foot.point;
      if (!contact::found(foot)) continue;
      if (!farthest.allFinite() || foot.point.dot(direction) > farthest.dot(direction)) farthest = foot.point;
    }
  return farthest;
}

/// Returns how far the part reaches in a direction of unit length [m]; not finite if nothing is found. Each look is
/// from above the point that was found before, so what is found can only be farther out.
double reachIn(Tracer& tracer, const Vector3d& direction) {
  const double slack = 1e-9 * tracer.model().bounds().diagonal().norm();
  Vector3d below = tracer.model().bounds().center();
  double reach = -std::numeric_limits<double>::infinity();
  for (int look = 0; look < kMostLooks; ++look) {
    below = lookFrom(tracer, below, direction);
    if (!below.allFinite()) return std::numeric_limits<double>::infinity();
    const double before = reach;
    reach = std::max(reach, below.dot(direction));
    if (!(reach > before + slack)) break;
  }
  return reach;
}

}  // namespace

AlignedBox3d tightBounds(const Model& model) {
  AlignedBox3d box = model.bounds();
  if (!(box.diagonal().norm() > 0)) return box;
  Tracer tracer(model);
  for (int axis = 0; axis < 3; ++axis) {
    const double high = reachIn(tracer, Vector3d::Unit(axis)), low = -reachIn(tracer, -Vector3d::Unit(axis));
    if (!(low <= high)) continue;
    box.min()[axis] = std::max(box.min()[axis], low);
    box.max()[axis] = std::min(box.max()[axis], high);
  }
  return box;
}

}  // namespace hapticd::brep
