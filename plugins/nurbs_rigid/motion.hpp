// SPDX-License-Identifier: MIT
/// A rigid model that moves under the forces on it: its parameters, and the body that they describe.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "hapticd/shape.hpp"
#include "kernels/brep/model/model.hpp"
#include "kernels/dynamics/mass_properties.hpp"
#include "kernels/dynamics/rigid_body.hpp"
#include "kernels/trace/model.hpp"

namespace hapticd {

/// The parameters of `motion: dynamic` in a scene. A shape that derives from this struct joins motionFields() into its
/// table of parameters.
struct MotionParameters {
  template <class T>
  static constexpr auto motionFields() {
    using F = Fields<T>;
    return std::array{
        F::real("mass", &MotionParameters::mass_, "kg", 1e-6, 1e6, 1, "mass of the body, with motion: dynamic"),
        F::array("center", &MotionParameters::center_, "m", 3, 0, 3, -1e3, 1e3, "[]",
                 "centre of mass, in the model frame; []: that of the volume inside the surfaces"),
        F::array("inertia", &MotionParameters::inertia_, "kg m^2", 3, 0, 9, -1e12, 1e12, "[]",
                 "moments of inertia about `center`, along the axes of the model frame: three moments, or the tensor "
                 "in three rows; []: those of a solid of constant density"),
        F::boolean("gravity", &MotionParameters::gravity_, true, "true: the body has weight, with motion: dynamic"),
        F::real("drag", &MotionParameters::drag_, "N s/m", 0, 1e6, 0, "drag against the velocity of `center`"),
        F::real("angular_drag", &MotionParameters::angular_drag_, "N m s/rad", 0, 1e6, 0, "drag against the rotation"),
        F::choice("joint", &MotionParameters::joint_, kJointNames, 0,
                  "how the body is joined to the world. free: not at all; hinge: turns about axis through pivot; "
                  "slider: moves along axis and does not turn"),
        F::vector3("pivot", &MotionParameters::pivot_, "m", -1e3, 1e3, "[0, 0, 0]",
                   "a point on the axis of the hinge, in the model frame"),
        F::vector3("axis", &MotionParameters::axis_, "", -1e6, 1e6, "[0, 1, 0]",
                   "direction of the axis of hinge or slider, in the model frame"),
        F::real("tether", &MotionParameters::tether_, "N/m", 0, 1e6, 0,
                "spring that pulls `center` to its initial position, or of a slider to `rest`; 0: no spring"),
        F::vector3("velocity", &MotionParameters::velocity_, "m/s", -1e3, 1e3, "[0, 0, 0]",
                   "velocity of `center` at the start, in the world frame"),
        F::vector3("spin", &MotionParameters::spin_, "rad/s", -1e4, 1e4, "[0, 0, 0]",
                   "angular velocity at the start, in the model frame"),
        F::real("angular_tether", &MotionParameters::angular_tether_, "N m/rad", 0, 1e6, 0,
                "torsion spring that turns a hinge to `rest`; 0: no spring"),
        F::real("rest", &MotionParameters::rest_, "rad or m", -1e3, 1e3, 0,
                "where the spring of the joint is relaxed, from the initial pose: angle of a hinge with angular_tether "
                "[rad], by the right-hand rule about axis; travel of a slider with tether [m], along axis"),
        F::array("limits", &MotionParameters::limits_, "rad or m", 2, 0, 2, -1e3, 1e3, "[]",
                 "[lowest, highest]: end stops of the joint, from the initial pose, which is 0: angles of a hinge "
                 "[rad], travels of a slider [m]; []: no stops")};
  }
  static constexpr const char* kJointNames[] = {"free", "hinge", "slider"};

  double mass_ = 1, drag_ = 0, angular_drag_ = 0, tether_ = 0, angular_tether_ = 0, rest_ = 0;
  bool gravity_ = true;
  int joint_ = 0;
  std::vector<double> center_, inertia_, limits_;
  std::array<double, 3> pivot_{}, axis_{0, 1, 0}, velocity_{}, spin_{};
};

/// [main] Returns the centre of mass and the inertia of 1 kg that fills a model evenly. If the surfaces are closed, it
/// fills the volume inside them, and `bounded` becomes true. Otherwise it fills the box around the model.
dynamics::MassProperties massProperties(const trace::Model& model, bool& bounded);
/// [main] Does the same for a part. It integrates over triangles that are exact to a ten-thousandth of the part's size.
dynamics::MassProperties massProperties(const brep::Model& part, bool& bounded);

/// [main] Says in one line how the joint of a body moves: its inertia, end stops, and the swing on its spring.
std::string jointText(const MotionParameters& parameters, const dynamics::RigidBody& body);

/// [main] Returns the law of a body with these parameters.
/// @param shape properties for 1 kg, used where the parameters leave out the centre of mass or the inertia
/// @throws std::invalid_argument if no body can have these properties.
dynamics::RigidBodyLaw lawOf(const MotionParameters& parameters, const dynamics::MassProperties& shape);

}  // namespace hapticd
