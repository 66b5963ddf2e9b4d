// SPDX-License-Identifier: MIT
/// A push button with a detent and a cap of any NURBS surfaces (Thompson et al. 1999, Eq. 10 and 11).
#pragma once
#include <array>
#include <optional>

#include "kernels/dynamics/button.hpp"
#include "traced_shape/moving.hpp"
#include "traced_shape/traced_shape.hpp"

namespace hapticd {

class PushButton final : public TracedShape {
 public:
  static constexpr ShapeInfo kInfo = {"org.hapticd.shape.push_button",
                                      "push_button",
                                      "1.1",
                                      "MIT",
                                      "A massless button: the surface's spring in series with a detent curve.",
                                      HSP_C_MOVES};
  static constexpr auto fields() {
    using F = Fields<PushButton>;
    return join(tracingFields<PushButton>(),
                std::array{F::vector3("axis", &PushButton::axis_, "", -1e6, 1e6, "[0, -1, 0]",
                                      "direction in which the button is pushed in, in the model frame"),
                           F::real("stiffness", &PushButton::stiffness_, "N/m", 1, 1e5, 2000,
                                   "k1: stiffness of the surface's spring", HSP_P_SAFETY),
                           F::array("detent", &PushButton::detent_, "m, N", 2, 2, 128, 0, 1e3,
                                    "[[0, 0], [0.003, 4], [0.004, 2], [0.005, 3]]",
                                    "points [travel, force] of the button's own resistance; it begins at [0, 0], a row "
                                    "that may be left out; the button clicks where the force falls"),
                           F::real("end_stiffness", &PushButton::end_stiffness_, "N/m", 1, 1e6, 8000,
                                   "slope of the resistance beyond the last point of detent")},
                laterFields<PushButton>());
  }

  void activate(const hsp_activation& activation, hsp_report& report);
  void reset() noexcept HSP_RT;
  hsp_status step(const hsp_step& step) noexcept HSP_RT;
  const void* extension(const char* name);

 private:
  /// One probe, which may press.
  struct Finger {
    dynamics::ButtonPress press;  ///< at its last good sample
    double blind_for = 0;         ///< [s] time for which it has had no sample
    double share = 1;             ///< of its stiffness that moves the button
  };
  void listPresses(const hsp_step& step) noexcept HSP_RT;
  dynamics::ButtonPress pressOf(const Touch& touch) const noexcept HSP_RT;
  MovingFrame frame(double dt) noexcept HSP_RT;

  std::array<double, 3> axis_{};
  double stiffness_ = 2000, end_stiffness_ = 8000;
  std::vector<double> detent_;

  std::optional<dynamics::DetentCurve> curve_;
  dynamics::ButtonState button_;
  std::vector<dynamics::ButtonPress> presses_;  // of this step; it has room for all probes
  Eigen::Vector3d inward_{0, -1, 0};
  Eigen::Vector3d rest_{0, 0, 0};        // position of the model frame with the button at rest, in the world
  Eigen::Quaterniond turn_{1, 0, 0, 0};  // orientation of the model, in the world
  double last_x2_ = 0, stored_ = 0;
  std::vector<Finger> fingers_;  // by probe
  std::optional<MovedProbes> probes_;
  hsp_ext_energy energy_extension_{};
};

}  // namespace hapticd
