/// How a body gives way: displacements of the control points of its skeleton spline and of their radii, each a mass on
/// a spring and a damper about its place in the body at rest (Corso et al. 2002, sections 3.2 and 3.3).
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/medial/influence.hpp"
#include "kernels/medial/oscillator.hpp"
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

/// A contact that holds the contour where the probe is.
struct Press {
  double u = 0, v = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< outward, unit
  double depth = 0;                                   ///< [m] below the contour at rest, > 0
  double speed = 0;                                   ///< [m/s] at which the probe goes deeper
};

struct DeformationOptions {
  double split = 0.5;                  ///< share of the depth that the skeleton moves; the radius shrinks by the rest
  std::array<int, 2> influence{4, 4};  ///< control points that a contact moves, p' x q'
  bool dynamics = true;                ///< false: control points return at once
};

class Deformation {
 public:
  /// [main] `material` one a control point, or one for all. Memory is taken here, for every control point awake.
  /// @throws std::invalid_argument for a negative or non-finite number.
  Deformation(const Skeleton& skeleton, std::vector<Oscillator> material, const DeformationOptions& options);

  /// [rt] Lets every control point that is awake swing for dt [s]: the exact solution, whatever dt.
  void advance(double dt) noexcept;
  /// [rt] Moves control points so that the contour is at no contact outside the probe, several contacts at once.
  /// Without dynamics the displacements are those of these contacts alone.
  void press(std::span<const Press> contacts) noexcept;
  /// [rt] Back to rest.
  void reset() noexcept;

  /// Displacement of the skeleton (x, y, z) and change of the radius at one point [m].
  /// [rt]
  Eigen::Vector4d at(double u, double v) const noexcept;
  /// [rt] Kinetic and elastic energy of the control points [J].
  double energy() const noexcept;
  std::size_t awake() const noexcept { return awake_.size(); }  ///< [rt] control points in motion
  std::size_t controlPoints() const noexcept { return nodes_.size(); }
  /// [any] Displacement of control point i: skeleton and radius.
  const Eigen::Vector4d& displacement(std::size_t i) const noexcept { return nodes_[i].x; }
  double settleTime() const noexcept { return settle_; }  ///< [s] after which a free body is at rest, whatever it was
  std::size_t bytes() const noexcept;

 private:
  struct alignas(32) Node {
    Eigen::Vector4d x = Eigen::Vector4d::Zero(), v = Eigen::Vector4d::Zero();
  };
  struct Material {
    Oscillator oscillator;
    OscillatorStep step;
    double time_scale2 = 0;  ///< [s^2] a speed squared times this is an amplitude squared
  };
  /// The control points that a contact moves, and those that shape the surface there.
  struct Reach {
    std::array<Influence, 2> moved, all;
  };

  void prepare(double dt) noexcept;
  void wake(std::size_t node) noexcept;
  Reach reachOf(double u, double v) const noexcept;
  void yield(const Press& contact, const Reach& reach) noexcept;
  const Material& materialOf(std::size_t node) const noexcept { return materials_[which_.empty() ? 0 : which_[node]]; }

  const Skeleton* skeleton_;
  DeformationOptions options_;
  std::vector<Node> nodes_;
  std::vector<Material> materials_;  ///< the distinct ones
  std::vector<uint16_t> which_;      ///< material of each node; empty: all the first
  std::vector<uint32_t> awake_;      ///< indices, reserved for all
  std::vector<uint8_t> is_awake_;
  double prepared_dt_ = -1, settle_ = 0;
};

}  // namespace hapticd::medial
