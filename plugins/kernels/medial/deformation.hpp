// SPDX-License-Identifier: MIT
/// How a body from a grid of skeleton points gives way: its nodes are the control points of the skeleton spline.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "kernels/medial/felt_surface.hpp"
#include "kernels/medial/influence.hpp"
#include "kernels/medial/nodes.hpp"
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

/// A contact at which the probe holds the contour.
struct Press {
  double u = 0, v = 0;                                ///< parameters of the foot
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< outward unit normal at the foot
  double depth = 0;                                   ///< [m] depth of the probe below the contour at rest, > 0
  double speed = 0;                                   ///< [m/s] speed at which the probe goes deeper
  uint32_t element = 0;                               ///< for a mesh: the cone or slab on which the foot lies
};

class Deformation : public Nodes {
 public:
  /// [main] Allocates all memory. @param material one entry per control point, or one for all
  /// @throws std::invalid_argument for a negative or non-finite number.
  Deformation(const Skeleton& skeleton, const std::vector<Oscillator>& material, const DeformationOptions& options);

  /// [rt] Moves control points until the contour at every contact is not outside the probe. Without dynamics the
  /// displacements come from these contacts alone.
  void press(std::span<const Press> contacts) noexcept;
  /// [rt] Returns the displacement of the skeleton (x, y, z) and the change of the radius at one point [m].
  Eigen::Vector4d at(double u, double v) const noexcept;
  /// [rt] Writes to `place` the control points that shape the contour at (u, v), with weights and derivatives. With a
  /// shear reach L [m], the displacement of a point is a mean along u and along v: half the displacement of the point
  /// itself, and a quarter each of the displacements at the distance L before and after it. So a press also pulls down
  /// the surface beside it, and that surface resists. The only energy is that of the nodes.
  void nodesAt(double u, double v, FeltPlace& place) const noexcept;
  /// [main] Returns one compliance per control point, chosen so that the sum of weight^2 * compliance is nearly 1
  /// everywhere.
  std::vector<double> compliance() const;

 private:
  /// The control points that a contact moves (`moved`), and all that shape the surface there (`all`).
  struct Reach {
    struct List {
      std::array<NodeWeight, (kMaxSkeletonDegree + 1) * (kMaxSkeletonDegree + 1)> parts;
      std::size_t count = 0;
      std::span<const NodeWeight> span() const noexcept { return {parts.data(), count}; }
    };
    List moved, all;
  };

  Reach reachOf(double u, double v) const noexcept;

  const Skeleton* skeleton_;
  std::array<double, 2> reach_{0, 0};  ///< shear_reach as a difference of u and of v
  std::array<double, 2> rim_{0, 0};    ///< width of the rim as a difference of u and of v; see nearRim()
};

}  // namespace hapticd::medial
