// SPDX-License-Identifier: MIT
/// A rigid model of NURBS surfaces or a part, with the feel of a material: wall, friction, viscosity, texture,
/// pop-through.
#pragma once
#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "kernels/contact/friction.hpp"
#include "kernels/contact/wall.hpp"
#include "motion.hpp"
#include "traced_shape/dynamic_body.hpp"
#include "traced_shape/traced_shape.hpp"

namespace hapticd {

class NurbsRigid final : public TracedShape, public MotionParameters {
 public:
  static constexpr ShapeInfo kInfo = {"org.hapticd.shape.nurbs_rigid",
                                      "nurbs_rigid",
                                      "1.1",
                                      "MIT",
                                      "A rigid model of NURBS surfaces or a part, traced on its exact surfaces.",
                                      HSP_C_MOVES};
  static constexpr auto fields() {
    using F = Fields<NurbsRigid>;
    return join(
        tracingFields<NurbsRigid>(),
        std::array{
            F::text("instance", &NurbsRigid::instance_name_, "",
                    "parts only: name of one instance or assembly, or its path assembly/sub/part; "
                    "left out: the whole part"),
            F::choice("motion", &NurbsRigid::motion_, kMotionNames, 0,
                      "static: does not move; kinematic: the host moves it along a path; "
                      "dynamic: it moves under the forces on it"),
            F::real("stiffness", &NurbsRigid::stiffness_, "N/m", 0, 1e5, 800,
                    "k of the contact law k x0 (x/x0)^n: the force is k x0 at depth x0", HSP_P_LIVE | HSP_P_SAFETY),
            F::real("damping", &NurbsRigid::damping_, "N s/m", 0, 1e3, 0,
                    "damping against the speed at which the probe goes deeper; it grows with depth", HSP_P_SAFETY),
            F::real("exponent", &NurbsRigid::exponent_, "", 0.25, 3, 1, "n of the contact law; 1: linear wall",
                    HSP_P_SAFETY),
            F::real("depth_scale", &NurbsRigid::depth_scale_, "m", 1e-6, 1, 1e-3,
                    "x0 of the contact law: the depth at which the force is k x0", HSP_P_SAFETY),
            F::real("friction_static", &NurbsRigid::friction_static_, "", 0, 10, 0,
                    "mu_s: a stuck probe begins to slide "
                    "when the force along the surface exceeds mu_s times the wall force"),
            F::real("friction_dynamic", &NurbsRigid::friction_dynamic_, "", 0, 10, 0,
                    "mu_d: the friction on a sliding probe is mu_d times the wall force; at most friction_static"),
            F::real("viscosity", &NurbsRigid::viscosity_, "N s/m", 0, 100, 0,
                    "viscous drag along the surface during a contact"),
            F::real("texture.amplitude", &NurbsRigid::texture_amplitude_, "m", 0, 1e-2, 0,
                    "height of bumps on the surface, in rows along u and v; not on meshes; 0: smooth",
                    HSP_P_LIVE | HSP_P_SAFETY),
            F::real("texture.wavelength", &NurbsRigid::texture_wavelength_, "m", 1e-5, 1, 2e-3,
                    "length of a bump along u and v; it is rounded so that a surface has a whole number of bumps",
                    HSP_P_LIVE | HSP_P_SAFETY),
            F::real("pop_through", &NurbsRigid::pop_through_, "N", 0, 1e3, 0,
                    "a shell (sides: both) gives way above this force; 0: never")},
        motionFields<NurbsRigid>(), laterFields<NurbsRigid>(),
        std::array{F::text("without", &NurbsRigid::left_out_, "",
                           "parts only: names or paths of instances or assemblies that are left out, such as those "
                           "that are models of their own; separated by commas")});
  }

  void activate(const hsp_activation& activation, hsp_report& report);
  void reset() noexcept HSP_RT;
  hsp_status step(const hsp_step& given) noexcept HSP_RT;
  const void* extension(const char* name);

 private:
  /// Greatest slope of bumps [m per m]. The stiffness of a wall with such bumps is (1 + 4) times that of the wall,
  /// which is half of what a host allows.
  static constexpr double kSteepest = 4;
  enum Motion { kStatic = 0, kKinematic = 1, kDynamic = 2 };
  static constexpr const char* kMotionNames[] = {"static", "kinematic", "dynamic"};

  void warnOfThinWalls(const hsp_activation& activation) const;
  void warnOfCrossedAxis() const;
  void setInMotion(const hsp_activation& activation, hsp_report& report);
  hsp_status press(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT;
  void remember(const hsp_probe& probe, const Touch& touch, uint32_t index, double depth,
                const Eigen::Vector3d& rub) noexcept HSP_RT;
  /// The parameter ranges of a surface and their lengths, for the bumps along u and v.
  struct Extent {
    Eigen::Array2d lo, range;  ///< start and size of the range of (u, v)
    Eigen::Array2d length;     ///< [m] mean length along u and along v
  };
  static std::vector<Extent> extentsOf(const trace::Model& model);
  static std::vector<Extent> extentsOf(const brep::Model& part);
  /// Returns the number of bumps along u and along v of a surface, at least one each.
  Eigen::Array2d wavesOf(const Extent& extent) const noexcept HSP_RT {
    return (extent.length / texture_wavelength_).round().max(1);
  }
  /// Returns the greatest slope of the bumps on a surface with the given amplitude. The length of a bump is assumed to
  /// be equal all over the surface.
  double slopeOf(const Extent& extent) const noexcept HSP_RT {
    return texture_amplitude_ * 2 * std::numbers::pi * (wavesOf(extent) / extent.length).maxCoeff();
  }
  double texture(const trace::Foot& foot) const noexcept HSP_RT;

  std::string instance_name_, left_out_;
  int motion_ = kStatic;
  double stiffness_ = 800, damping_ = 0, exponent_ = 1, depth_scale_ = 1e-3;
  double friction_static_ = 0, friction_dynamic_ = 0;
  double viscosity_ = 0, texture_amplitude_ = 0, texture_wavelength_ = 2e-3, pop_through_ = 0;
  std::vector<contact::Friction> friction_;  ///< one per probe; empty if there is no friction and no viscosity
  std::vector<Extent> extents_;              ///< by surface; empty for meshes, which have no bumps
  std::optional<DynamicBody> body_;          ///< only for motion: dynamic
  double stored_ = 0;                        ///< [J] energy stored in the wall and in the springs of friction
  hsp_ext_energy energy_extension_{};
};

}  // namespace hapticd
