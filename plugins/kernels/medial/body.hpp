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
  /// [m] distance along the skeleton over which the slope of the stiffness is taken, to either side; 0: at the contact
  /// alone. If above 0, there are no shear springs
  double shear_distance = 0;
  Envelope envelope = Envelope::kExact;  ///< how feet are found, so that it is known how they move
  /// [m] depth at which the contact's damping reaches its full value; it is 0 at the surface
  double damping_scale = 5e-3;
  DeformationOptions deformation;
  FeltOptions felt;
};

/// The force of a pressed body.
struct BodyForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();    ///< [N] force on the probe
  Eigen::Vector3d elastic = Eigen::Vector3d::Zero();  ///< [N] the part of `force` that comes from springs
  double normal = 0;                                  ///< [N] outward part of `force`
  double stiffness = 0;                               ///< [N/m] stiffness of the normal spring at the contact
  double energy = 0;                                  ///< [J] energy of a straight press to this depth

  /// [rt] Returns this force with a share of the springs' part, 0 to 1. It does not pull inward.
  BodyForce weakened(double share, const Eigen::Vector3d& outward) const noexcept;
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
  /// direction `normal`. Along the normal it comes from a normal spring, from four springs along the surface, and from
  /// damping against `closing_speed` [m/s]; it never pulls inward. Along the surface it is the slope of the stiffness
  /// (see forceAlong()), and no greater than outward: the springs have no part there, because their ends move along
  /// with the contact, and a force on the probe alone would drive it round.
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
  /// that of the four springs along the surface.
  double greatestStiffness() const noexcept { return (springs() ? 5 : 1) * stiffness_.greatest(); }
  std::size_t bytes() const noexcept;

 private:
  struct Neighbours {
    std::array<ShearSpring, 4> springs;
    std::size_t count = 0;
  };
  /// [any] True if springs along the surface add to the normal spring, as in Corso et al. 2002.
  bool springs() const noexcept { return options_.shear_offset > 0 && !(options_.shear_distance > 0); }
  /// Returns the gradient of the stiffness over the position of a probe [N/m^2].
  Eigen::Vector3d slopeOfStiffness(const Eigen::Vector3d& p, const SkeletonFoot& foot,
                                   const Eigen::Vector3d& normal) const noexcept;
  /// Returns the derivatives of the stiffness along u and v [N/m], over `shear_distance`.
  std::array<double, 2> slopesAlong(const SkeletonFoot& foot, const FootMotion& motion) const noexcept;
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
