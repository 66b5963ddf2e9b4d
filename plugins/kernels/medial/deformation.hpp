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

/// A contact that holds the contour where the probe is.
struct Press {
  double u = 0, v = 0;                                ///< of the foot
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< outward, unit
  double depth = 0;                                   ///< [m] below the contour at rest, > 0
  double speed = 0;                                   ///< [m/s] at which the probe goes deeper
  uint32_t element = 0;                               ///< for a mesh: the cone or slab that has the foot
};

class Deformation : public Nodes {
 public:
  /// [main] `material` has one per control point, or one for all.
  /// @throws std::invalid_argument for a negative or non-finite number.
  Deformation(const Skeleton& skeleton, const std::vector<Oscillator>& material, const DeformationOptions& options);

  /// [rt] Moves control points so that at no contact the contour is outside the probe, several contacts at once.
  /// Without dynamics the displacements are those of these contacts alone.
  void press(std::span<const Press> contacts) noexcept;
  /// [rt] Displacement of the skeleton (x, y, z) and change of the radius at one point [m].
  Eigen::Vector4d at(double u, double v) const noexcept;
  /// [rt] The control points that shape the contour at (u, v), with their derivatives. With a shear reach L the place
  /// sinks by half its own displacement and a quarter each of those L before and after it, along u and along v: a press
  /// takes the surface beside it down, and is pushed back by it. The energy stays that of the nodes.
  void nodesAt(double u, double v, FeltPlace& place) const noexcept;
  /// [main] One per control point, chosen so that the sum of weight^2 * compliance is nearly 1 everywhere.
  std::vector<double> compliance() const;

 private:
  /// The control points that a contact moves, and those that shape the surface there.
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
  std::array<double, 2> rim_{0, 0};    ///< likewise: within it a place nears the rim ever more slowly
};

}  // namespace hapticd::medial
