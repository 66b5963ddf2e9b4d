// SPDX-License-Identifier: MIT
#include "kernels/brep/search/tight_bounds.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "kernels/brep/search/search.hpp"

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

/// Looks at all placements, or at one alone.
class Looks {
 public:
  Looks(const Model& model, std::optional<std::uint32_t> place, const AlignedBox3d& box)
      : search_(model), place_(place), box_(box) {}

  const AlignedBox3d& box() const { return box_; }

  /// Returns the point that lies farthest out, as seen from above `below`. Where no look proves it, as over a pole, the
  /// farthest of all that were found counts: it is a point of the part at least.
  Vector3d from(const Vector3d& below, const Vector3d& direction) {
    const double size = box_.diagonal().norm();
    const Vector3d aside = kAside * size * Vector3d(direction.y(), direction.z(), direction.x());
    Vector3d farthest = Vector3d::Constant(std::numeric_limits<double>::infinity());
    for (const double afar : kAfar)
      for (const Vector3d& above : {below, Vector3d(below + aside)}) {
        const Nearest found = nearestTo(above + afar * size * direction);
        if (!found.found()) continue;
        const Placement& at = search_.model().placements()[found.place];
        const Vector3d point = at.rotation * found.hit.point + at.position;
        if (found.proved) return point;
        if (!farthest.allFinite() || point.dot(direction) > farthest.dot(direction)) farthest = point;
      }
    return farthest;
  }

 private:
  Nearest nearestTo(const Vector3d& p) {
    return place_ ? search_.nearestOf(*place_, kNone, p, Hit{}, kPatient) : search_.nearest(p, kPatient);
  }

  Search search_;
  std::optional<std::uint32_t> place_;
  AlignedBox3d box_;  ///< encloses what is looked at
};

/// Returns how far the part reaches in a direction of unit length [m]; not finite if nothing is found. Each look is
/// from above the point that was found before, so what is found can only be farther out.
double reachIn(Looks& looks, const Vector3d& direction) {
  const double slack = 1e-9 * looks.box().diagonal().norm();
  Vector3d below = looks.box().center();
  double reach = -std::numeric_limits<double>::infinity();
  for (int look = 0; look < kMostLooks; ++look) {
    below = looks.from(below, direction);
    if (!below.allFinite()) return std::numeric_limits<double>::infinity();
    const double before = reach;
    reach = std::max(reach, below.dot(direction));
    if (!(reach > before + slack)) break;
  }
  return reach;
}

AlignedBox3d boundsOf(Looks looks) {
  AlignedBox3d box = looks.box();
  if (!(box.diagonal().norm() > 0)) return box;
  for (int axis = 0; axis < 3; ++axis) {
    const double high = reachIn(looks, Vector3d::Unit(axis)), low = -reachIn(looks, -Vector3d::Unit(axis));
    if (!(low <= high)) continue;
    box.min()[axis] = std::max(box.min()[axis], low);
    box.max()[axis] = std::min(box.max()[axis], high);
  }
  return box;
}

}  // namespace

AlignedBox3d tightBounds(const Model& model) {
  return boundsOf(Looks(model, std::nullopt, model.bounds()));
}

AlignedBox3d tightBounds(const Model& model, std::uint32_t place) {
  const Placement& at = model.placements()[place];
  const AlignedBox3d& own = model.body(at.body).tree.bounds();
  AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner)
    box.extend(at.rotation * own.corner(static_cast<AlignedBox3d::CornerType>(corner)) + at.position);
  return boundsOf(Looks(model, place, box));
}

}  // namespace hapticd::brep
