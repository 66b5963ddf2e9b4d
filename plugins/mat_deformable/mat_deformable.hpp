// SPDX-License-Identifier: MIT
/// A soft body from its medial axis: a grid of skeleton points (Corso et al. 2002) or a medial mesh of cones and slabs.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "display.hpp"
#include "hapticd/shape.hpp"
#include "kernels/medial/volume.hpp"
#include "medial_file.hpp"
#include "soft_body.hpp"

namespace hapticd {

class MatDeformable final : public Shape {
 public:
  static constexpr ShapeInfo kInfo = {
      "org.hapticd.shape.mat_deformable",
      "mat_deformable",
      "1.0",
      "MIT",
      "A soft body made of spheres along a skeleton: it gives way to the hand, swings, and comes to rest.",
      HSP_C_DEFORMS};

 private:
  static constexpr auto skeletonFields() {  // how the foot is found
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{
        F::path("geometry", &T::geometry_,
                "model file with the key medial (format hapticd-model/1 or /2, YAML or JSON), or a medial mesh (.ma)",
                HSP_P_REQUIRED),
        F::choice("search", &T::search_, kSearchNames, 0,
                  "newton: safeguarded Newton iteration from the last foot point; binary: nested bisection, after "
                  "Corso et al. 2002",
                  HSP_P_ACCURACY),
        F::integer("depth", &T::depth_, "", 4, 30, 10, "number of halvings of each parameter with search: binary",
                   HSP_P_ACCURACY),
        F::real("tolerance", &T::tolerance_, "m", 1e-12, 1e-3, 1e-8,
                "with search: newton, the search ends at a step shorter than this", HSP_P_ACCURACY | HSP_P_LIVE),
        F::choice("envelope", &T::envelope_, kEnvelopeNames, 0,
                  "exact: the union of the spheres; foot: the test of Corso et al. 2002, too small where radii vary",
                  HSP_P_ACCURACY),
        F::integer("degree", &T::degree_, "", 1, medial::kMaxSkeletonDegree, 3,
                   "highest degree of the skeleton spline"),
        F::choice(
            "evaluation", &T::evaluation_, kEvaluationNames, 0,
            "fast: stores a table for each knot span; small: computes from the control points and needs less memory",
            HSP_P_ACCURACY)};
  }
  static constexpr auto dynamicsFields() {  // how the body yields and swings
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{
        F::real("split", &T::split_, "", 0, 1, 0.5,
                "g: share of the depth by which the skeleton moves. "
                "0.5: the opposite side of the body stays; 1: it moves along"),
        F::array("influence", &T::influence_, "", 2, 2, 2, 1, medial::kMaxSkeletonDegree + 1, "[4, 4]",
                 "p', q': how many control points a contact moves; with degree + 1 the dent does not jump. It changes "
                 "the drawing, not the force"),
        F::choice("dynamics", &T::dynamics_, kDynamicsNames, kAsFile,
                  "off: the body springs back at once. seen (or on): it swings and creeps, but this changes only the "
                  "drawing. felt: the hand feels the moving surface. auto: felt if the file gives damping or mass, "
                  "else off. file: auto for files of format hapticd-model/2, seen for others"),
        F::real("contact_ratio", &T::contact_ratio_, "", 1.1, 100, 3,
                "with dynamics felt: stiffness of the spring between probe and surface, divided by the body's "
                "stiffness. No fast motion feels a stiffer body"),
        F::real("relaxation.share", &T::relaxation_share_, "", 0, 10, 0,
                "with dynamics felt: a fast press is stiffer by this share of the stiffness, and then relaxes"),
        F::real("relaxation.time", &T::relaxation_time_, "s", 1e-4, 100, 0.5,
                "with dynamics felt: time constant of this relaxation"),
        F::real("shear_offset", &T::shear_offset_, "", 0, 0.5, kUsualShearOffset,
                "distance from the contact to the ends of four springs along the surface, as a share of the parameter "
                "range; 0: no such springs. They make the body stiffer than its file says; "
                "with shear_distance there are none")};
  }
  static constexpr auto contactFields() {  // what else a probe feels
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{
        F::real("damping_scale", &T::damping_scale_, "m", 1e-6, 1, 5e-3,
                "depth at which the contact's damping reaches its full value"),
        F::real(
            "friction_static", &T::friction_static_, "", 0, 10, 0,
            "mu_s: a stuck probe begins to slide when the force along the surface exceeds mu_s times the normal force"),
        F::real("friction_dynamic", &T::friction_dynamic_, "", 0, 10, 0,
                "mu_d: the friction on a sliding probe is mu_d times the normal force"),
        F::real("viscosity", &T::viscosity_, "N s/m", 0, 100, 0, "viscous drag along the surface during a contact"),
        F::choice(
            "volume", &T::volume_, kSwitchNames, 0,
            "on: the rest of the surface moves out when a press pushes a part in, so that the volume stays the same")};
  }
  static constexpr auto materialFields() {  // defaults for what a file does not give, and how to read its numbers
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{
        F::real("stiffness", &T::stiffness_, "N/m", 0, 1e6, 300,
                "stiffness of a medial mesh whose file gives none (.ma)"),
        F::real("stiffness_scale", &T::stiffness_scale_, "", 1e-3, 1e3, 1,
                "factor on every stiffness, whatever gives it; damping and mass stay"),
        F::real("damping", &T::damping_, "N s/m", 0, 1e6, 0.5,
                "damping of a medial mesh whose file gives none (.ma). A file that gives more than ten times this "
                "value is refused (up to 5 is always allowed)"),
        F::real("mass", &T::mass_, "kg", 0, 1e6, 0.01,
                "mass of each vertex of a medial mesh whose file gives none (.ma)"),
        F::integer("rings", &T::rings_, "", 0, 8, 2,
                   "medial mesh only: how many rings of neighbouring vertices a contact moves. "
                   "It changes the drawing, not the force"),
        F::real("crease", &T::crease_, "m", 0, 1, 1e-3,
                "medial mesh only: where a branch begins, "
                "the force turns from one part to the other over this width; 0: at once",
                HSP_P_LIVE),
        F::real("display_tolerance", &T::display_tolerance_, "m", 0, 1e-2, 0,
                "largest distance of the drawn mesh, which is updated 60 times a second, "
                "from the surface; 0: no such mesh"),
        F::real(
            "shear_distance", &T::shear_distance_, "m", 0, 1, 0,
            "distance along the surface, to either side, over which the change of the stiffness is taken. It pushes "
            "toward the softer side, and does not change the part of the force along the normal. 0: the change at "
            "the contact (of a mesh: over 1 mm), and shear_offset is used for files of format hapticd-model/1"),
        F::real(
            "probe_radius", &T::probe_radius_, "m", 1e-4, 0.1, 5e-3,
            "radius of the flat tip for which young, poisson and thickness of a file are converted into a stiffness"),
        F::real("tip_radius", &T::tip_radius_, "m", 0, 0.05, 0,
                "radius of the ball that touches the body, about the tip of the arm; 0: a point")};
  }

 public:
  /// The order must not change, because recordings hold the indices.
  static constexpr auto fields() { return join(skeletonFields(), dynamicsFields(), contactFields(), materialFields()); }

  void activate(const hsp_activation& activation, hsp_report& report);
  void deactivate();
  void reset() noexcept HSP_RT;
  hsp_status step(const hsp_step& step) noexcept HSP_RT;
  const void* extension(const char* name);

 private:
  static constexpr double kUsualShearOffset = 0.05;
  static constexpr const char* kSearchNames[] = {"newton", "binary"};
  static constexpr const char* kEnvelopeNames[] = {"exact", "foot"};
  static constexpr const char* kEvaluationNames[] = {"fast", "small"};
  static constexpr const char* kSwitchNames[] = {"off", "on"};
  static constexpr const char* kDynamicsNames[] = {"off", "on", "seen", "felt", "auto", "file"};
  enum Dynamics { kOff, kOn, kSeen, kFelt, kAuto, kAsFile };

  /// The state of a body as bytes: `kept` was saved at the last deactivation, `loaded` is for the next activation.
  struct States {
    std::vector<unsigned char> kept, loaded;
  };
  struct VolumeControl {
    std::unique_ptr<medial::MovingMesh> hull;
    medial::VolumeKeeper volume;
  };

  medial::BodyOptions bodyOptions(const MedialFile& file, double rate_hz) const;
  Dynamics dynamicsOf(const MedialFile& file) const;
  void openBody(const MedialFile& file, double rate_hz);
  /// [main] Reads the geometry file. If the file has problems, also logs warnings about its other values. @throws
  /// ModelFileError
  MedialFile readFile() const;
  const SoftBody& drawn() const noexcept { return drawn_body_ ? *drawn_body_ : *body_; }
  void openContacts(uint32_t probes);
  uint32_t openDisplay();    ///< @return the number of moving vertices; 0 if none are drawn
  void openAccount();        ///< with the energy of a surface that swings at the start
  std::size_t openVolume();  ///< @return bytes of the volume keeper; 0 if the volume is not kept
  static const void* surfacesExtension();
  static const void* geometryExtension();
  static const void* energyExtension();
  static const void* stateExtension();
  void describe(const MedialFile& file, double tick) const;
  void describeMaterial(const MedialFile& file, double tick) const;
  std::string sourceOf(const MedialFile& file) const;
  void describeDynamics(const MedialFile& file) const;
  void describeContact(const MedialFile& file, double tick) const;
  /// Returns the material of a point of the file. Its relaxation comes from the parameters.
  medial::Tissue tissueAt(const MedialFile& file, std::size_t point) const;
  std::vector<medial::Tissue> distinct(const MedialFile& file) const;
  double elapsed(const hsp_step& step) noexcept HSP_RT;
  FindOptions findOptions(const hsp_step& step) const noexcept HSP_RT;
  FindOptions searchOptions() const noexcept;
  /// The surface at a probe, if the probe is near one and its sample is good.
  struct LocatedSurface {
    hsp_status status = HSP_OK;
    bool found = false;
    Felt surface;
    Eigen::Vector3d moved{0, 0, 0};  ///< [m] of the probe since the last tick; 0 if it was put here
  };
  LocatedSurface locate(const hsp_probe& probe, const hsp_step& step, uint32_t index,
                        hsp_contact& contact) noexcept HSP_RT;
  hsp_status touch(const hsp_probe& probe, const hsp_step& step, uint32_t index, hsp_contact& contact) noexcept HSP_RT;
  hsp_status stepFelt(const hsp_step& step) noexcept HSP_RT;
  hsp_status addContact(const hsp_probe& probe, const hsp_step& step, uint32_t index,
                        hsp_contact& contact) noexcept HSP_RT;
  medial::BodyForce feltForce(const hsp_probe& probe, const medial::FeltContact& met, const Felt& felt,
                              const Track& track) noexcept HSP_RT;
  double feltShare(double dt) noexcept HSP_RT;
  static double restingShare(const medial::BodyForce& whole, const Eigen::Vector3d& moved, double dt,
                             Track& track) noexcept HSP_RT;
  void answer(const hsp_probe& probe, const medial::FeltContact& met, const Felt& felt, const medial::BodyForce& force,
              Track& track, hsp_contact& contact) noexcept HSP_RT;
  void push(const hsp_probe& probe, const LocatedSurface& located, const hsp_step& step, Track& track,
            hsp_contact& contact) noexcept HSP_RT;

  double energy() const noexcept HSP_RT;  ///< [J] energy of the body and its contacts

  int64_t nearby(const double p_model[3], double radius, hsp_near* out, uint64_t cap) const;
  hsp_status start(const hsp_near& near) noexcept HSP_RT;
  hsp_status stop(uint32_t probe) noexcept HSP_RT;
  int64_t save(void* buffer, uint64_t capacity) const;
  hsp_status load(const void* buffer, uint64_t length);
  void show(const hsp_step& step) noexcept HSP_RT;
  double displayed() const;  ///< [m] chord error of the mesh in the frames
  hsp_status mesh(double chord_error, hsp_mesh& out);

  std::string geometry_;
  int search_ = 0, depth_ = 10, envelope_ = 0, degree_ = 3, evaluation_ = 0, dynamics_ = kAsFile;
  double tolerance_ = 1e-8, split_ = 0.5, shear_offset_ = 0.05, damping_scale_ = 5e-3;
  double friction_static_ = 0, friction_dynamic_ = 0, viscosity_ = 0, display_tolerance_ = 0;
  double contact_ratio_ = 3, relaxation_share_ = 0, relaxation_time_ = 0.5;
  double stiffness_ = 300, stiffness_scale_ = 1, damping_ = 0.5, mass_ = 0.01, crease_ = 1e-3;
  double shear_distance_ = 0, probe_radius_ = 5e-3, tip_radius_ = 0;
  int volume_ = 0, rings_ = 2;
  std::vector<double> influence_{4, 4};

  std::unique_ptr<SoftBody> body_;
  std::unique_ptr<SoftBody> drawn_body_;  ///< only if a ball touches the body: `body_` is larger by the ball's radius
  std::vector<Track> tracks_;             ///< one per probe
  std::vector<medial::Press> presses_;    ///< contacts of this step; has room for all probes
  /// On a felt surface: one entry for each probe that is near the surface in this step, with the index of the probe.
  struct FeltProbe {
    uint32_t probe = 0;
    Felt felt;
    Eigen::Vector3d moved{0, 0, 0};  ///< [m] of the probe since the last tick
    medial::BodyForce force;         ///< `energy` is that of the springs, as a multiple of that of the surface
  };
  /// Contacts of this step. The list has as many entries as one surface can have contacts; the first met_.size() are in
  /// use.
  std::vector<medial::FeltContact> contacts_;
  std::unique_ptr<medial::FeltPlace> beside_;  ///< place of the rival foot, for the contact that is being handled
  std::vector<FeltProbe> met_;                 ///< contacts of this step; has room for all probes
  std::unique_ptr<DisplacementBuffer> displaced_;
  std::unique_ptr<Frames> frames_;         ///< written by step() if display_tolerance is above 0
  std::unique_ptr<VolumeControl> keeper_;  ///< keeps the volume, if `volume` is on
  std::unique_ptr<States> states_ = std::make_unique<States>();
  std::unique_ptr<Display> display_;
  double since_shown_ = 0;  ///< [s] time since the last set of displacements for drawing
  bool shown_at_rest_ = true;
  uint64_t last_time_ns_ = 0;
  double stored_ = 0;              ///< [J] energy in the springs of the contacts
  medial::EnergyAccount account_;  ///< of all contacts of a felt surface; other bodies have one per probe
};

}  // namespace hapticd
