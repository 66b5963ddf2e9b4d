// SPDX-License-Identifier: MIT
/// A soft body from a grid of skeleton points: where its surface is, how hard it pushes back, how it gives way.
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

/// What a model file says about a body; index = i * count[1] + j.
struct BodyData {
  SkeletonGrid grid;
  std::vector<double> stiffness;  ///< [N/m] one a point
  std::vector<double> damping;    ///< [N s/m] one per point; empty: none
  std::vector<double> mass;       ///< [kg] one per point; empty: none, so that control points creep
  double shear_reach = 0;         ///< [m] along the skeleton; makes the dent of a felt body wider than its points alone
};

/// How a surface with its own dynamics is felt.
struct FeltOptions {
  bool on = false;
  double contact_ratio = 3;                          ///< contact spring over the stiffness of a fast press
  double relaxation_share = 0, relaxation_time = 0;  ///< see Tissue
  double tick = 1e-3;                                ///< [s] length of most steps
};

struct BodyOptions {
  int degree = 3;
  spline::Form form = spline::Form::kTable;
  double shear_offset = 0.05;   ///< distance of the four neighbours, as a share of the parameter range; 0: no shear
  double shear_distance = 0;    ///< [m] their distance along the skeleton, in place of shear_offset; see press()
  double damping_scale = 5e-3;  ///< [m] depth at which damping of the contact is whole; it grows from 0 at the surface
  DeformationOptions deformation;
  FeltOptions felt;
};

/// The force of a pressed body.
struct BodyForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] on the probe
  double normal = 0;                                ///< [N] its outward part
  double stiffness = 0;                             ///< [N/m] of the normal spring here
  double energy = 0;                                ///< [J] in the springs
};

/// Whether the force grows with depth at every place that was examined.
struct MonotonicityReport {
  double slope = 1;  ///< least slope of the force over the stiffness of the normal spring, both at the same place
  double ratio = 1, limit = 1;  ///< there: rest length over least length of the worst spring; what it may be
  double u = 0, v = 0;          ///< there
  bool holds() const noexcept { return slope > 0; }
};

class Body {
 public:
  /// [main] @throws std::invalid_argument that says what is wrong with the data.
  Body(const BodyData& data, const BodyOptions& options);
  Body(const Body&) = delete;  // the deformation uses the skeleton beside it
  Body& operator=(const Body&) = delete;

  const Skeleton& skeleton() const noexcept { return skeleton_; }
  Deformation& deformation() noexcept { return *deformation_; }
  const Deformation& deformation() const noexcept { return *deformation_; }
  const ScalarField& stiffness() const noexcept { return stiffness_; }

  /// [rt] The force on a probe at `p` whose foot is `foot`, with outward unit direction `normal` and depth `depth`
  /// along it: normal spring, four springs along the surface, damping against `closing_speed`. It never pulls inward
  /// along the normal. With `shear_distance` the four springs together are as stiff as the normal spring and only turn
  /// the force: its part along the normal is stiffness * depth, as the file says.
  BodyForce press(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, double depth,
                  double closing_speed) const noexcept;
  /// [rt] The place of the contour at which a probe at `p` is, with its foot, as a felt surface needs it.
  /// @param direct 1: `normal` is the direction from the foot to the probe; 0: it is not; between, in part
  void placeOf(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, Envelope envelope,
               double direct, FeltPlace& place) const noexcept;
  FeltSurface* feltSurface() noexcept { return felt_ ? &*felt_ : nullptr; }  ///< [any] nullptr: it is only seen
  /// [main] Checks the force law all over the skeleton, on both sides.
  MonotonicityReport checkMonotonicity() const;
  /// [any] No force grows faster with depth [N/m]: it has the normal spring and four others in line with it.
  double greatestStiffness() const noexcept {
    return (options_.shear_offset > 0 && !turns() ? 5 : 1) * stiffness_.greatest();
  }
  std::size_t bytes() const noexcept;

 private:
  struct Neighbours {
    std::array<ShearSpring, 4> springs;
    std::size_t count = 0;
  };
  /// [any] The springs along the surface only turn the force; otherwise they add to the normal spring, as in the paper.
  bool turns() const noexcept { return options_.shear_distance > 0; }
  /// Parameters to a neighbour along u (0) and v (1); 0: none.
  std::array<double, 2> offsetsAt(const SkeletonFoot& foot) const noexcept;
  Neighbours neighboursOf(const SkeletonFoot& foot, const Eigen::Vector3d& normal) const noexcept;
  /// Lowers `report` if the springs along `normal` lose more slope here than before.
  void judgeMonotonicity(const SkeletonFoot& at, const Eigen::Vector3d& normal, MonotonicityReport& report) const;
  std::vector<Oscillator> materialOf(const BodyData& data) const;
  std::vector<Tissue> tissueOf(const std::vector<Oscillator>& material) const;

  BodyOptions options_;
  Skeleton skeleton_;
  ScalarField stiffness_, damping_;
  std::optional<Deformation> deformation_;
  std::optional<FeltSurface> felt_;
};

}  // namespace hapticd::medial
