// SPDX-License-Identifier: MIT
#include "kernels/medial/primitives.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// Least sine of the smallest angle of a triangle for which its plane is meaningful. Thinner triangles are treated as
/// their three edges.
constexpr double kThinTriangle = 1e-9;

void requireSphere(const Sphere& sphere, const char* what) {
  if (!sphere.center.allFinite() || !std::isfinite(sphere.radius) || sphere.radius < 0)
    throw std::invalid_argument(std::string(what) + ": sphere with centre (" + std::to_string(sphere.center.x()) +
                                ", " + std::to_string(sphere.center.y()) + ", " + std::to_string(sphere.center.z()) +
                                ") and radius " + std::to_string(sphere.radius) +
                                "; all numbers must be finite, and the radius at least 0");
}

/// Returns some unit vector perpendicular to the unit vector n.
Vector3d perpendicular(const Vector3d& n) {
  Eigen::Index smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  return n.cross(Vector3d::Unit(smallest)).normalized();
}

}  // namespace

HullFoot footOnSphere(const Sphere& sphere, const Vector3d& p, const Vector3d& fallback) noexcept {
  const Vector3d d = p - sphere.center;
  const double length = d.norm();
  HullFoot foot;
  foot.distance = length - sphere.radius;
  foot.center = sphere.center;
  foot.radius = sphere.radius;
  foot.normal = length > 0 ? Vector3d(d / length) : fallback;
  return foot;
}

Cone::Cone(const Sphere& a, const Sphere& b) : a_(a) {
  requireSphere(a, "cone");
  requireSphere(b, "cone");
  const Vector3d d = b.center - a.center;
  length_ = d.stableNorm();
  if (length_ <= std::fabs(b.radius - a.radius)) {
    whole_ = b.radius > a.radius ? 1 : 0;
    if (length_ > 0) axis_ = d / length_;
    slope_ = length_ > 0 ? (b.radius - a.radius) / length_ : 0;
    if (whole_ == 1) a_ = b;
    return;
  }
  axis_ = d / length_;
  side_ = perpendicular(axis_);
  slope_ = (b.radius - a.radius) / length_;
  cosine_ = std::sqrt((1 - slope_) * (1 + slope_));
  tangent_ = slope_ / cosine_;
}

HullFoot Cone::foot(const Vector3d& p) const noexcept {
  if (whole_ >= 0) {
    HullFoot foot = footOnSphere(a_, p, axis_);
    foot.parameter[0] = whole_;
    return foot;
  }
  const Vector3d d = p - a_.center;
  const double along = d.dot(axis_);
  const Vector3d off = d - along * axis_;
  const double height = off.norm();
  const double z = along + tangent_ * height;  // the place where |p - c(z)| - r(z) is stationary
  HullFoot foot;
  if (z > 0 && z < length_) {
    foot.center = a_.center + z * axis_;
    foot.radius = a_.radius + slope_ * z;
    foot.distance = height * cosine_ - slope_ * along - a_.radius;
    foot.normal = cosine_ * (height > 0 ? Vector3d(off / height) : side_) - slope_ * axis_;
    foot.parameter[0] = z / length_;
    return foot;
  }
  const bool end = !(z <= 0);
  const Sphere cap{end ? Vector3d(a_.center + length_ * axis_) : a_.center, a_.radius + (end ? slope_ * length_ : 0)};
  foot = footOnSphere(cap, p, end ? axis_ : Vector3d(-axis_));
  foot.parameter[0] = end ? 1 : 0;
  return foot;
}

Slab::Slab(const std::array<Sphere, 3>& spheres) : origin_(spheres[0]) {
  for (std::size_t i = 0; i < 3; ++i) edges_[i] = Cone(spheres[i], spheres[(i + 1) % 3]);
  measure(spheres);
}

void Slab::measure(const std::array<Sphere, 3>& spheres) {
  edge1_ = spheres[1].center - spheres[0].center;
  edge2_ = spheres[2].center - spheres[0].center;
  const Vector3d cross = edge1_.cross(edge2_);
  const double area = cross.norm(), longest = std::fmax(edge1_.norm(), edge2_.norm());
  if (!(area > kThinTriangle * longest * longest)) return;
  normal_ = cross / area;
  dual1_ = edge2_.cross(normal_) / area;
  dual2_ = normal_.cross(edge1_) / area;
  gradient_ = (spheres[1].radius - spheres[0].radius) * dual1_ + (spheres[2].radius - spheres[0].radius) * dual2_;
  const double slope2 = gradient_.squaredNorm();
  if (!(slope2 < 1)) return;
  cosine_ = std::sqrt(1 - slope2);
  tangent_scale_ = 1 / cosine_;
  plane_ = true;
}

HullFoot Slab::footOnEdge(std::size_t edge, const Vector3d& p) const noexcept {
  HullFoot foot = edges_[edge].foot(p);
  const double t = foot.parameter[0];
  if (edge == 0) foot.parameter = {t, 0};
  if (edge == 1) foot.parameter = {1 - t, t};
  if (edge == 2) foot.parameter = {0, 1 - t};
  return foot;
}

HullFoot Slab::foot(const Vector3d& p) const noexcept {
  std::array<bool, 3> candidate{true, true, true};
  if (plane_) {
    const Vector3d d = p - origin_.center;
    const double height = d.dot(normal_);
    // the stationary point, apart from its height over the plane
    const Vector3d base = d + gradient_ * (std::fabs(height) * tangent_scale_);
    const double w1 = dual1_.dot(base), w2 = dual2_.dot(base);
    candidate = {w2 < 0, 1 - w1 - w2 < 0, w1 < 0};
    if (!candidate[0] && !candidate[1] && !candidate[2]) {
      HullFoot foot;
      const Vector3d in_plane = w1 * edge1_ + w2 * edge2_;
      foot.center = origin_.center + in_plane;
      foot.radius = origin_.radius + gradient_.dot(in_plane);
      foot.distance = std::fabs(height) * cosine_ - gradient_.dot(d) - origin_.radius;
      foot.normal = (height < 0 ? -cosine_ : cosine_) * normal_ - gradient_;
      foot.parameter = {w1, w2};
      return foot;
    }
  }
  // The distance is convex over the triangle. If the stationary point lies beyond some edges, the least value lies on
  // one of these edges. NaN is beyond no edge, and the first edge is used.
  HullFoot best;
  bool found = false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!candidate[i]) continue;
    const HullFoot foot = footOnEdge(i, p);
    if (!found || foot.distance < best.distance) best = foot;
    found = true;
  }
  return best;
}

}  // namespace hapticd::medial
