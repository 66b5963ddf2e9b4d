// SPDX-License-Identifier: MIT
/// Where the path of the probe meets a face, so that a contact begins there.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/brep/contact/tracer.hpp"

namespace hapticd::brep {
namespace {

using contact::Foot;
using contact::Sides;
using Eigen::Vector3d;

constexpr double kMet = 1e-8;         ///< [m] a face that is nearer than this has been reached
constexpr double kLeastShare = 0.25;  ///< clearWay() goes at least this share of the distance to an uncertain foot
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr double kFlat = 0.25;  ///< clearWay() goes no farther than this share of the radius of curvature

/// Returns a bound [1/m] of the curvature of a face of closed form toward one side (+1 is the front), as far about its
/// point S as clearWay() goes; infinity if none is known.
double curvatureToward(const FaceShape& face, const Vector3d& S, double side) noexcept {
  const bool inside = side * face.outward < 0;  // on the side of the axis or center
  if (face.nappe < 0) return kUnknown;
  switch (face.kind) {
    case SurfaceKind::kPlane:
      return 0;
    case SurfaceKind::kCylinder:
    case SurfaceKind::kSphere:
      return inside ? 1 / face.r0 : 0;
    case SurfaceKind::kCone:  // there, its radius is at least half of that at S
      return inside ? 2 / (S - face.o).cross(face.z).norm() : 0;
    case SurfaceKind::kTorus:
      if (!(face.r0 > face.r1)) return kUnknown;
      return 1 / (inside ? face.r1 : face.r0 - face.r1);
    default:
      return kUnknown;
  }
}

/// The same for any element.
double curvatureToward(const Model& model, const Hit& hit, double side) noexcept {
  const std::uint32_t index = hit.element.index();
  if (hit.element.kind() == ElementKind::kTriangle) return 0;
  if (hit.element.kind() == ElementKind::kFace) return curvatureToward(model.face(index), hit.point, side);
  if (hit.element.kind() != ElementKind::kLeaf) return kUnknown;
  const Leaf& leaf = model.leaf(index);
  const Surface& surface = model.part().surfaces[model.part().faces[leaf.face].surface];
  if (surface.kind == SurfaceKind::kOffset) return kUnknown;  // its leaves know the curvature of the basis surface
  return static_cast<double>((side > 0 ? leaf.curvature_front : leaf.curvature_back).value());
}

/// Returns how far [m] the probe can go along `way` (unit) from `at`, where `found` was found, and meet no face. That
/// is no farther than to the second nearest element, since a farther one cannot be met before. The distance to the
/// nearest one changes by the slope of the way, and its second derivative along the way is at least -k / (1 - k d) for
/// a curvature k toward the probe at a distance d. All ends short of kMet, so that rounding does not decide on which
/// side of a face the probe is then.
double clearWay(const Model& model, const Nearest& found, const Foot& foot, const Vector3d& at,
                const Vector3d& way) noexcept {
  constexpr double kSafe = 4;  // the second derivative is bounded three times as far as needed
  const double height = foot.distance - 0.5 * kMet, side = foot.depth > 0 ? -1 : 1;
  if (!(height > 0)) return 0;
  if (!found.proved) return std::clamp(std::sqrt(found.open2) - 0.5 * kMet, kLeastShare * height, height);
  const double curvature = curvatureToward(model, found.hit, side);
  const double reach = std::min(found.others - 0.5 * kMet, kFlat / curvature - foot.distance);
  if (!(reach > height)) return height;
  const double slope = way.dot(at - foot.point) / foot.distance;
  const double bend = kSafe * curvature, root = std::sqrt(slope * slope + 2 * bend * height);
  const double fall = slope > 0 ? (slope + root) / bend : 2 * height / (root - slope);  // no number for 0 / 0
  return std::max(height, std::min(fall, reach));
}

}  // namespace

/// Finds the first face on the path of the probe by sphere tracing (Hart 1996): it goes along the path in steps that
/// are no longer than clearWay().
bool Tracer::enter(const Vector3d& from, const Vector3d& p, Sides sides, double& side) noexcept {
  constexpr int kMostSteps = 64;
  const double length = (p - from).norm();
  if (!(length > 0)) return false;
  const Vector3d way = (p - from) / length;
  double s = 0;
  for (int i = 0; i < kMostSteps; ++i) {
    const Vector3d at = from + s * way;
    const Nearest& found = search_.nearest(at, budget_);
    if (!found.found()) return false;
    const Held met = heldAt(found);
    const Foot foot = describe(model(), met.place, met.hit, met.face, at);
    const bool last = i + 1 == kMostSteps;
    if (foot.distance <= kMet || last) {
      const double from_side = i == 0 && foot.distance <= kMet ? side : (foot.depth > 0 ? -1.0 : 1.0);
      const bool felt = sides == Sides::kBoth || (sides == Sides::kFront) == (from_side > 0);
      if (felt && from_side * way.dot(surfaceNormal(model(), met.place, met.hit, foot)) < 0) {
        side = from_side;
        held_ = met;
        return true;
      }
    }
    s += std::max(clearWay(model(), found, foot, at, way), kMet);
    if (s >= length) return false;
  }
  return false;
}

}  // namespace hapticd::brep
