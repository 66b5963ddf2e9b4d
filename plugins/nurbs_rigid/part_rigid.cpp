// SPDX-License-Identifier: MIT
/// Properties of a part for a rigid model: the lengths of its faces for bumps, thin walls, the axes of round faces, and
/// the centre and inertia.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "nurbs_rigid.hpp"
#include "traced_shape/part_mesh.hpp"
#include "traced_shape/thin_walls.hpp"

namespace hapticd {

std::vector<NurbsRigid::Extent> NurbsRigid::extentsOf(const brep::Model& part) {
  constexpr int kSamples = 8;
  std::vector<Extent> extents;
  spline::SurfacePoint E;
  for (const brep::Body& body : part.part().bodies)
    if (body.triangle_count > 0) return extents;
  // Features of instances that are left out keep a length of 1, which is not used.
  extents.assign(part.featureCount(), {Eigen::Array2d(0, 0), Eigen::Array2d(1, 1), Eigen::Array2d(1, 1)});
  for (const brep::Placement& place : part.placements()) {
    const brep::Body& body = part.part().bodies[place.body];
    for (std::uint32_t f = 0; f < body.face_count; ++f) {
      const brep::Face& face = part.part().faces[body.first_face + f];
      Extent extent;
      extent.lo = brep::vec(face.lo).array();
      extent.range = brep::vec(face.hi).array() - extent.lo;
      extent.length.setZero();
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const Eigen::Array2d share(k / kSamples + 0.5, k % kSamples + 0.5);
        const Eigen::Array2d uv = extent.lo + extent.range * share / kSamples;
        part.geometry().surface(face.surface, uv[0], uv[1], E);
        extent.length += extent.range * Eigen::Array2d(E.Su.norm(), E.Sv.norm()) / (kSamples * kSamples);
      }
      extents[place.first_feature + f] = extent;
    }
  }
  return extents;
}

namespace {

/// Returns the part of a message about a thin wall that says what it is.
std::string thinWallText(const ThinWall& wall, double force, double depth, double ball) {
  char text[256], radius[64] = "";
  if (ball > 0) std::snprintf(radius, sizeof radius, ", more than that and the %.3g mm of tip_radius", 1e3 * ball);
  std::snprintf(text, sizeof text,
                ": a wall is %.3g mm thick, but a press of %.3g N goes %.3g mm deep at this stiffness%s, so the tip "
                "comes out behind",
                1e3 * wall.thickness, force, 1e3 * depth, radius);
  return text;
}

/// Returns a number of two digits that is clearly greater.
double roundedUp(double number) {
  constexpr double kMargin = 1.02;
  const double digit = std::pow(10, std::floor(std::log10(kMargin * number)) - 1);
  return digit * std::ceil(kMargin * number / digit);
}

}  // namespace

/// Warns of walls that a firm press goes through. The hand still feels the wall, because the contact is held. But the
/// tip is drawn on the other side, where it may be in front of another face. A ball is pressed by its radius before its
/// centre, the tip, is at the wall. Walls so thin that no arm renders a sufficient stiffness are only noted for
/// `hapticd explain`: most parts have such a place, and nobody can fix it.
void NurbsRigid::warnOfThinWalls(const hsp_activation& activation) const {
  // [N] firm press of an exploring finger tip [assumption]; the arm's limit is for short moments
  constexpr double kFirmPress = 2;
  constexpr double kStiffest = 5000;  // [N/m] the greatest stiffness that is advised [assumption: arms for the desk]
  const double force = std::min(forceToClaimFor(activation, kFirmPress), kFirmPress);
  if (!(stiffness_ > 0)) return;
  const double depth = contact::wallDepthAt({stiffness_, damping_, exponent_, depth_scale_}, force);
  const double tip = depth - tip_radius_;  // how deep the tip itself is in the part
  const double least = contact::wallDepthAt({kStiffest, damping_, exponent_, depth_scale_}, force) - tip_radius_;
  if (!(tip > 0)) return;
  const auto tell = [&](int level, const ThinWall& wall, const std::string& advice) {
    writeLog(level, part()->featureName(wall.feature) + thinWallText(wall, force, depth, tip_radius_) + "; " + advice);
  };
  const std::optional<ThinWall> wall = thinnestWall(*part(), tip);
  if (!wall) return;
  if (contact_hysteresis_ < wall->thickness)
    return tell(HSP_LOG_WARNING, *wall,
                "the contact is lost there, because contact_hysteresis is smaller: leave it out");
  if (wall->thickness < least)
    tell(HSP_LOG_DEBUG, *wall,
         "few arms render a stiffness that is enough, but the contact is held, so the hand feels it");
  if (const auto other = wall->thickness < least ? thinnestWall(*part(), tip, least) : wall)
    tell(HSP_LOG_WARNING, *other,
         "the contact is held all the same, and stiffness: " +
             std::to_string(static_cast<int>(
                 roundedUp(stiffness_ * std::pow(depth / (other->thickness + tip_radius_), exponent_)))) +
             " keeps the tip inside, if the arm is stable with it");
}

/// Warns of a hinge whose axis crosses the axis of a round face at the pivot: whoever takes the pivot from a round face
/// means to turn about it. Another round face there that lies along the axis says that this was meant.
void NurbsRigid::warnOfCrossedAxis() const {
  constexpr double kAtPivot = 1e-5, kAlong = 1e-3;  // [m], [rad]
  const Eigen::Vector3d pivot(pivot_.data()), axis = Eigen::Vector3d(axis_.data()).normalized();
  std::string crossed;
  for (const brep::Placement& place : part()->placements()) {
    const brep::Body& body = part()->part().bodies[place.body];
    for (std::uint32_t f = 0; f < body.face_count; ++f) {
      const brep::Surface& surface = part()->part().surfaces[part()->part().faces[body.first_face + f].surface];
      if (surface.kind != brep::SurfaceKind::kCylinder && surface.kind != brep::SurfaceKind::kCone) continue;
      const Eigen::Vector3d along = (place.rotation * brep::vec(surface.z)).normalized();
      const Eigen::Vector3d way = pivot - (place.rotation * brep::vec(surface.o) + place.position);
      if ((way - way.dot(along) * along).norm() > kAtPivot) continue;
      if (along.cross(axis).norm() < kAlong) return;
      if (!crossed.empty()) continue;
      char text[120];
      std::snprintf(text, sizeof text, "; to turn about this face, give axis: [%.6g, %.6g, %.6g]", along.x() + 0.0,
                    along.y() + 0.0, along.z() + 0.0);
      crossed =
          "axis: crosses at the pivot the axis of the round " + part()->featureName(place.first_feature + f) + text;
    }
  }
  if (!crossed.empty()) writeLog(HSP_LOG_WARNING, crossed);
}

dynamics::MassProperties massProperties(const brep::Model& part, bool& bounded) {
  constexpr double kChord = 1e-4;  // share of the part's size; curved faces then have their volume to a thousandth
  const Eigen::AlignedBox3d& box = part.bounds();
  const Mesh mesh = tessellate(part, kChord * box.diagonal().norm());
  dynamics::SolidIntegral integral(box.center());
  const auto at = [&mesh](std::size_t i) {
    const std::size_t v = 3 * mesh.indices[i];
    return Eigen::Vector3d(mesh.xyz[v], mesh.xyz[v + 1], mesh.xyz[v + 2]);
  };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Eigen::Vector3d a = at(i), b = at(i + 1), c = at(i + 2), area = 0.5 * (b - a).cross(c - a);
    // Mid-edge rule: exact for the quadratic integrands, and accurate enough for the cubic ones.
    for (const Eigen::Vector3d& middle :
         {Eigen::Vector3d(0.5 * (a + b)), Eigen::Vector3d(0.5 * (b + c)), Eigen::Vector3d(0.5 * (c + a))})
      integral.add(middle, area / 3);
  }
  bounded = !part.open();
  return integral.propertiesIn(box, bounded);
}

}  // namespace hapticd
