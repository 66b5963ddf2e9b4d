// SPDX-License-Identifier: MIT
/// A pendulum of any NURBS surfaces that the user's hand pushes.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "traced_shape/dynamic_body.hpp"
#include "traced_shape/traced_shape.hpp"

namespace hapticd {

class Pendulum final : public TracedShape {
 public:
  static constexpr ShapeInfo kInfo = {
      "org.hapticd.shape.pendulum",
      "pendulum",
      "1.2",
      "MIT",
      "A model that swings about a fixed axis under gravity and the forces of the hand.",
      HSP_C_MOVES};
  static constexpr auto fields() {
    using F = Fields<Pendulum>;
    return join(
        tracingFields<Pendulum>(),
        std::array{
            F::real("stiffness", &Pendulum::stiffness_, "N/m", 0, 1e5, 800,
                    "k of the contact law k x0 (x/x0)^n: the force is k x0 at depth x0", HSP_P_LIVE | HSP_P_SAFETY),
            F::real("contact_damping", &Pendulum::contact_damping_, "N s/m", 0, 1e3, 0,
                    "lambda of the contact law: damping of the surface, at the depth x0", HSP_P_SAFETY),
            F::real("exponent", &Pendulum::exponent_, "", 0.25, 3, 1, "n of the contact law; 1: linear wall",
                    HSP_P_SAFETY),
            F::real("depth_scale", &Pendulum::depth_scale_, "m", 1e-6, 1, 1e-3,
                    "x0 of the contact law: the depth at which the force is k x0", HSP_P_SAFETY),
            F::vector3("pivot", &Pendulum::pivot_, "m", -1e3, 1e3, "[0, 0, 0]",
                       "a point of the axis, in the model frame"),
            F::vector3("axis", &Pendulum::axis_, "", -1e6, 1e6, "[0, 0, 1]",
                       "axis of the swing, in the model frame; angles are positive by the right-hand rule"),
            F::real("mass", &Pendulum::mass_, "kg", 1e-6, 1e6, 1, "mass of the moving body"),
            F::real("inertia", &Pendulum::inertia_, "kg m^2", 0, 1e9, 0,
                    "moment of inertia about the pivot; 0: that of a point mass at the distance `length`"),
            F::real("length", &Pendulum::length_, "m", 0, 1e3, 0.25,
                    "distance from the pivot to the centre of mass, "
                    "which at angle 0 lies straight below the pivot, along gravity"),
            F::real("damping", &Pendulum::damping_, "N m s/rad", 0, 1e6, 0, "damping of the swing"),
            F::real("angle", &Pendulum::angle_, "rad", -1e3, 1e3, 0, "angle at the start; 0: hanging straight down"),
            F::real("rate", &Pendulum::rate_, "rad/s", -1e3, 1e3, 0, "angular velocity at the start"),
            F::array("limits", &Pendulum::limits_, "rad", 2, 0, 2, -1e3, 1e3, "[]",
                     "[lowest, highest]: end stops of the swing, angles as `angle`; []: no stops")},
        laterFields<Pendulum>());
  }

  void activate(const hsp_activation& activation, hsp_report& report);
  void reset() noexcept HSP_RT;
  hsp_status step(const hsp_step& given) noexcept HSP_RT;
  const void* extension(const char* name);

 private:
  dynamics::RigidBodyLaw hingeLaw(double inertia, const Eigen::Vector3d& down) const;
  hsp_status press(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT;

  double stiffness_ = 800, contact_damping_ = 0, exponent_ = 1, depth_scale_ = 1e-3;
  std::array<double, 3> pivot_{}, axis_{};
  double mass_ = 1, inertia_ = 0, length_ = 0.25, damping_ = 0, angle_ = 0, rate_ = 0;
  std::vector<double> limits_;

  std::optional<DynamicBody> body_;
  double lifted_ = 0;  ///< [J] potential energy at the start above that at angle 0, from which body_ does not count
  double stored_ = 0;  ///< [J] energy stored in the surface
  hsp_ext_energy energy_extension_{};
};

}  // namespace hapticd
