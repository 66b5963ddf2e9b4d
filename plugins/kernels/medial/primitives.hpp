// SPDX-License-Identifier: MIT
/// Primitives of a medial mesh: the convex hulls of one, two and three spheres, with their distance in closed form.
///
/// Each hull is the union of spheres whose centre c and radius r change linearly over a point, a segment or a triangle.
/// The signed distance from a point Q to this union is the least |Q - c| - r of all its spheres. It is exact outside
/// and inside, because the hulls are convex.
#pragma once
#include <Eigen/Core>
#include <array>

namespace hapticd::medial {

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0;                                 ///< [m] radius, not negative
};

/// The foot of a point on a hull.
struct HullFoot {
  double distance = 0;                               ///< [m] signed: negative inside
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m] centre of the sphere on which the foot lies
  double radius = 0;                                 ///< [m] radius of this sphere
  /// outward unit normal at the foot; defined also for a point on the axis
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  Eigen::Array2d parameter = Eigen::Array2d::Zero();  ///< cone: (t, 0); slab: barycentric weights of spheres 1 and 2

  /// Returns the nearest point of the hull's surface [m].
  Eigen::Vector3d point() const noexcept { return center + radius * normal; }
};

/// [any] Returns the foot of p on a sphere. If p is the centre, the normal is `fallback`.
HullFoot footOnSphere(const Sphere& sphere, const Eigen::Vector3d& p,
                      const Eigen::Vector3d& fallback = Eigen::Vector3d::UnitX()) noexcept;

/// The hull of two spheres, a cone with round ends. If one sphere contains the other, the hull is the larger sphere.
class Cone {
 public:
  Cone() = default;
  /// [main] @throws std::invalid_argument for a number that is not finite or a negative radius.
  Cone(const Sphere& a, const Sphere& b);

  /// [any] Returns the foot of p.
  HullFoot foot(const Eigen::Vector3d& p) const noexcept;

 private:
  Sphere a_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitX(), side_ = Eigen::Vector3d::UnitY();
  double length_ = 0;
  double slope_ = 0;  ///< change of the radius per metre along the axis
  /// slope / sqrt(1 - slope^2): how far the sphere of the foot moves along the axis per metre of the probe's distance
  /// from the axis
  double tangent_ = 0;
  double cosine_ = 1;  ///< sqrt(1 - slope^2)
  int whole_ = -1;     ///< the end (0 or 1) whose sphere contains the other sphere; -1 if neither does
};

/// The convex hull of three spheres: a triangular slab with round rims.
class Slab {
 public:
  Slab() = default;
  /// [main] @throws std::invalid_argument for a number that is not finite or a negative radius.
  explicit Slab(const std::array<Sphere, 3>& spheres);

  /// [any] Returns the foot of p.
  HullFoot foot(const Eigen::Vector3d& p) const noexcept;
  /// [any] Returns the unit normal of the triangle of centres; zero if plane_ is false.
  Eigen::Vector3d across() const noexcept { return plane_ ? normal_ : Eigen::Vector3d(Eigen::Vector3d::Zero()); }

 private:
  void measure(const std::array<Sphere, 3>& spheres);
  HullFoot footOnEdge(std::size_t edge, const Eigen::Vector3d& p) const noexcept;

  Sphere origin_;
  std::array<Cone, 3> edges_;  ///< edge i runs from sphere i to sphere i + 1
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  /// dual_i . (x - c0) is the barycentric weight of sphere i
  Eigen::Vector3d dual1_ = Eigen::Vector3d::Zero(), dual2_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d edge1_ = Eigen::Vector3d::Zero(), edge2_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gradient_ = Eigen::Vector3d::Zero();  ///< gradient of the radius, in the plane of the centres
  double cosine_ = 1, tangent_scale_ = 1;
  bool plane_ = false;  ///< false if the hull has no flat sides (the triangle is thin, or spheres lie inside others)
};

}  // namespace hapticd::medial
