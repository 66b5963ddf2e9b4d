// SPDX-License-Identifier: MIT
/// Primitives of a medial mesh: the hulls of one, two and three spheres, with their distance in closed form.
///
/// All are unions of the spheres whose centre and radius run linearly over a point, a segment or a triangle. The signed
/// distance of such a union is the least |Q - c| - r over its spheres: exact outside and inside, because those hulls
/// are convex.
#pragma once
#include <Eigen/Core>
#include <array>

namespace hapticd::medial {

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0;                                 ///< [m], not negative
};

/// Where a point stands relative to a hull.
struct HullFoot {
  double distance = 0;                                ///< [m] signed: negative inside
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< centre of the sphere that has the foot
  double radius = 0;                                  ///< of that sphere
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< outward unit normal at the foot, also for a point on the axis
  Eigen::Array2d parameter = Eigen::Array2d::Zero();  ///< cone: (t, 0); slab: barycentric weights of spheres 1 and 2

  /// The nearest point of the hull's surface.
  Eigen::Vector3d point() const noexcept { return center + radius * normal; }
};

/// [any] The nearest point of a sphere; a point at its centre gets the normal `fallback`.
HullFoot footOnSphere(const Sphere& sphere, const Eigen::Vector3d& p,
                      const Eigen::Vector3d& fallback = Eigen::Vector3d::UnitX()) noexcept;

/// The hull of two spheres, a cone with round ends. If one sphere holds the other, the hull is that sphere.
class Cone {
 public:
  Cone() = default;
  /// [main] @throws std::invalid_argument for a number that is not finite or a negative radius.
  Cone(const Sphere& a, const Sphere& b);

  /// [any] The foot of p.
  HullFoot foot(const Eigen::Vector3d& p) const noexcept;
  /// [any] Parameter 0..1 of the point of the axis nearest to p, the paper's foot (Corso et al. 2002, section 3.1).
  double axisFoot(const Eigen::Vector3d& p) const noexcept;
  /// [any] Depth by the paper's test: radius at axisFoot() less the distance to it. Exact for equal radii only.
  double axisDepth(const Eigen::Vector3d& p) const noexcept;

 private:
  Sphere a_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitX(), side_ = Eigen::Vector3d::UnitY();
  double length_ = 0;
  double slope_ = 0;  ///< dr/dz along the axis
  double tangent_ =
      0;  ///< slope / sqrt(1 - slope^2): how far the foot's sphere moves along the axis for each metre off it
  double cosine_ = 1;  ///< sqrt(1 - slope^2)
  int whole_ = -1;     ///< the end (0 or 1) whose sphere holds the other; -1: none
};

/// The hull of three spheres, a triangular slab with round rims.
class Slab {
 public:
  Slab() = default;
  /// [main] @throws std::invalid_argument for a number that is not finite or a negative radius.
  explicit Slab(const std::array<Sphere, 3>& spheres);

  /// [any] The foot of p.
  HullFoot foot(const Eigen::Vector3d& p) const noexcept;
  /// [any] Unit normal of the triangle of centres; zero where it has no plane.
  Eigen::Vector3d across() const noexcept { return plane_ ? normal_ : Eigen::Vector3d(Eigen::Vector3d::Zero()); }

 private:
  void measure(const std::array<Sphere, 3>& spheres);
  HullFoot footOnEdge(std::size_t edge, const Eigen::Vector3d& p) const noexcept;

  Sphere origin_;
  std::array<Cone, 3> edges_;  ///< edge i runs from sphere i to sphere i + 1
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d dual1_ = Eigen::Vector3d::Zero(), dual2_ = Eigen::Vector3d::Zero();  ///< dual_i . (x - c0) = weight i
  Eigen::Vector3d edge1_ = Eigen::Vector3d::Zero(), edge2_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gradient_ = Eigen::Vector3d::Zero();  ///< of the radius, in the plane of the centres
  double cosine_ = 1, tangent_scale_ = 1;
  bool plane_ = false;  ///< false: no sphere touches only the hull's flat sides (thin triangle, nested spheres)
};

}  // namespace hapticd::medial
