// SPDX-License-Identifier: MIT
/// A rigid model that moves by the forces on it: its parameters, its body, and the contacts that push it.
#pragma once
#include <array>
#include <vector>

#include "hapticd/shape.hpp"
#include "kernels/brep/model.hpp"
#include "kernels/dynamics/mass_properties.hpp"
#include "kernels/dynamics/rigid_body.hpp"
#include "kernels/trace/model.hpp"
#include "traced_shape/presses.hpp"

namespace hapticd {

/// What `motion: dynamic` takes from the scene. A shape that derives from it joins motionFields() into its table.
struct MotionParameters {
  template <class T>
  static constexpr auto motionFields() {
    using F = Fields<T>;
    return std::array{
        F::real("mass", &MotionParameters::mass_, "kg", 1e-6, 1e6, 1, "motion dynamic: of the body"),
        F::array("center", &MotionParameters::center_, "m", 3, 0, 3, -1e3, 1e3, "[]",
                 "of mass, model frame; []: of the volume that the surfaces bound"),
        F::array("inertia", &MotionParameters::inertia_, "kg m^2", 3, 0, 9, -1e12, 1e12, "[]",
                 "about center along the model's axes: three moments, or the tensor in three rows; []: of a solid of "
                 "constant density"),
        F::boolean("gravity", &MotionParameters::gravity_, true, "motion dynamic: the body has weight"),
        F::real("drag", &MotionParameters::drag_, "N s/m", 0, 1e6, 0, "against the velocity of center"),
        F::real("angular_drag", &MotionParameters::angular_drag_, "N m s/rad", 0, 1e6, 0, "against turning"),
        F::choice("joint", &MotionParameters::joint_, kJointNames, 0,
                  "to the world. free; hinge: turns about axis through pivot; slider: moves along axis, does not turn"),
        F::vector3("pivot", &MotionParameters::pivot_, "m", -1e3, 1e3, "[0, 0, 0]", "of the hinge, model frame"),
        F::vector3("axis", &MotionParameters::axis_, "", -1e6, 1e6, "[0, 1, 0]", "of hinge or slider, model frame"),
        F::real("tether", &MotionParameters::tether_, "N/m", 0, 1e6, 0,
                "spring that draws center to where it started; 0: none"),
        F::vector3("velocity", &MotionParameters::velocity_, "m/s", -1e3, 1e3, "[0, 0, 0]",
                   "of center at the start, world frame"),
        F::vector3("spin", &MotionParameters::spin_, "rad/s", -1e4, 1e4, "[0, 0, 0]",
                   "angular velocity at the start, model frame")};
  }
  static constexpr const char* kJointNames[] = {"free", "hinge", "slider"};

  double mass_ = 1, drag_ = 0, angular_drag_ = 0, tether_ = 0;
  bool gravity_ = true;
  int joint_ = 0;
  std::vector<double> center_, inertia_;
  std::array<double, 3> pivot_{}, axis_{0, 1, 0}, velocity_{}, spin_{};
};

/// [main] Centre and inertia of 1 kg that fills a model: the volume that its surfaces bound, or the box around it when
/// they bound none; `bounded` tells which.
dynamics::MassProperties massProperties(const trace::Model& model, bool& bounded);
/// [main] The same of a part, from triangles within a ten-thousandth of its size.
dynamics::MassProperties massProperties(const brep::Model& part, bool& bounded);

/// The moving frame of one model.
class DynamicBody {
 public:
  /// [main] @param shape of 1 kg, for what the parameters leave open
  /// @throws std::invalid_argument: no body is like that.
  DynamicBody(const MotionParameters& parameters, const dynamics::MassProperties& shape,
              const hsp_activation& activation);

  /// [rt] Moves the body through the step, pushed by the contacts that remember() was told of since the last one.
  /// Writes the new pose and gives the same step with its probes seen from there.
  hsp_step move(const hsp_step& step) noexcept HSP_RT;

  /// [rt] What probe number `index` does to the body, in the frame of the model; all that is not listed is left alone.
  void remember(uint32_t index, const dynamics::Pressing& in_model) noexcept HSP_RT {
    presses_.remember(index, in_model, now_);
  }

  void release() noexcept HSP_RT { presses_.release(); }  ///< [rt] forgets the contacts

  double energy() const noexcept HSP_RT { return body_.energy(); }  ///< [rt] [J]
  const dynamics::RigidBody& body() const noexcept { return body_; }

 private:
  MovingFrame frame() const noexcept HSP_RT;

  dynamics::RigidBody body_;
  MovedProbes probes_;
  Presses presses_;
  MovingFrame now_;
};

}  // namespace hapticd
