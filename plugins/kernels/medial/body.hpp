// SPDX-License-Identifier: MIT
/// A soft body from a grid of skeleton points: where its surface is, how hard it pushes back, and how it gives way to a
/// probe.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "kernels/medial/deformation.hpp"
#include "kernels/medial/felt_surface.hpp"
#include "kernels/medial/foot_motion.hpp"
#include "kernels/medial/shear.hpp"
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

/// The contents of a model file about a body from a grid. The index of a point is i * count[1] + j.
struct BodyData {
  SkeletonGrid grid;
  std::vector<double> stiffness;  ///< [N/m] one per point
  std::vector<double> damping;    ///< [N s/m] one per point; empty if the body has no damping
  /// [kg] one per point; empty if the body has no mass: its control points then return to rest without swinging
  std::vector<double> mass;
  /// [m] length along the skeleton by which shear widens a dent of a felt body, see Deformation::nodesAt()
  double shear_reach = 0;
};

/// Options of a surface whose own dynamics is felt.
struct FeltOptions {
  bool on = false;
  double contact_ratio = 3;  ///< stiffness of the contact spring, divided by that of a fast press
  double relaxation_share = 0, relaxation_time = 0;  ///< see Tissue
  double tick = 1e-3;                                ///< [s] length of most steps
};

struct BodyOptions {
  int degree = 3;
  spline::Form form = spline::Form::kTable;
  /// parameter distance from a contact to the ends of its four shear springs, as a share of the parameter range; 0: no
  /// shear springs
  double shear_offset = 0.05;
  /// [m] distance along the skeleton to the ends of the shear springs; if above 0, it replaces shear_offset (see
  /// press())
  double shear_distance = 0;
  /// [m] depth at which the contact's damping reaches its full value; it is 0 at the surface
  double damping_scale = 5e-3;
  DeformationOptions deformation;
  FeltOptions felt;
};

/// The force of a pressed body.
struct BodyForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] force on the probe
  double normal = 0;                                ///< [N] outward part of `force`
  double stiffness = 0;                             ///< [N/m] stiffness of the normal spring at the contact
  double energy = 0;                                ///< [J] energy stored in the springs
};

/// Result of the check that the force grows with depth at every examined place. It describes the worst place.
struct MonotonicityReport {
  /// slope of the force over depth at that place, divided by the stiffness of the normal spring there
  double slope = 1;
  /// ratio: rest length divided by least length of the worst spring at that place; limit: greatest allowed value of
  /// `ratio`
  double ratio = 1, limit = 1;
  double u = 0, v = 0;  ///< parameters of that place
  bool holds() const noexcept { return slope > 0; }
};

class Body {
 public:
  /// [main] @throws std::invalid_argument that says what is wrong with the data.
  Body(const BodyData& data, const BodyOptions& options);
  Body(const Body&) = delete;  // deformation_ points to skeleton_
  Body& operator=(const Body&) = delete;

  const Skeleton& skeleton() const noexcept { return skeleton_; }
  // NOLINTBEGIN(bugprone-unchecked-optional-access): the constructor makes it
  Deformation& deformation() noexcept { return *deformation_; }
  const Deformation& deformation() const noexcept { return *deformation_; }
  // NOLINTEND(bugprone-unchecked-optional-access)
  const ScalarField& stiffness() const noexcept { return stiffness_; }

  /// [rt] Returns the force on a probe at `p` with the foot `foot`, at the depth `depth` [m] along the outward unit
  /// direction `normal`. The force comes from a normal spring, from four springs along the surface, and from damping
  /// against `closing_speed` [m/s]. It never pulls inward along the normal. With `shear_distance` the four springs only
  /// turn the force: together they are as stiff as the normal spring, and the part of the force along the normal is
  /// stiffness * depth, with the stiffness of the file.
  BodyForce press(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, double depth,
                  double closing_speed) const noexcept;
  /// [rt] Describes to a felt surface the place where a probe at `p` touches the contour.
  /// @param direct 1 if `normal` points from the foot to the probe, 0 if it does not; values between blend the two
  /// cases
  void placeOf(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, Envelope envelope,
               double direct, FeltPlace& place) const noexcept;
  /// [any] Returns the felt surface; nullptr if the deformation is only drawn and not felt.
  FeltSurface* feltSurface() noexcept { return felt_ ? &*felt_ : nullptr; }
  /// [main] Checks at samples all over the skeleton, on both sides, that the force grows with depth.
  MonotonicityReport checkMonotonicity() const;
  /// [any] Returns an upper bound of the slope of the force over depth [N/m]: the stiffness of the normal spring, plus
  /// that of the four springs along the surface unless they only turn the force.
  double greatestStiffness() const noexcept {
    return (options_.shear_offset > 0 && !turns() ? 5 : 1) * stiffness_.greatest();
  }
  std::size_t bytes() const noexcept;

 private:
  struct Neighbours {
    std::array<ShearSpring, 4> springs;
    std::size_t count = 0;
  };
  /// [any] True if the springs along the surface only turn the force. If false, they add to the normal spring, as in
  /// Corso et al. 2002.
  bool turns() const noexcept { return options_.shear_distance > 0; }
  /// Returns the differences of the parameter to a neighbour along u (index 0) and v (index 1); 0 if there is no
  /// neighbour.
  std::array<double, 2> offsetsAt(const SkeletonFoot& foot) const noexcept;
  Neighbours neighboursOf(const SkeletonFoot& foot, const Eigen::Vector3d& normal) const noexcept;
  /// Updates `report` if the springs reduce the slope of the force along `normal` at this place more than at the places
  /// that were examined before.
  void checkMonotonicityAt(const SkeletonFoot& at, const Eigen::Vector3d& normal, MonotonicityReport& report) const;
  std::vector<Oscillator> materialOf(const BodyData& data) const;
  std::vector<Tissue> tissueOf(const std::vector<Oscillator>& material) const;

  BodyOptions options_;
  Skeleton skeleton_;
  ScalarField stiffness_, damping_;
  std::optional<Deformation> deformation_;
  std::optional<FeltSurface> felt_;
};

}  // namespace hapticd::medial
