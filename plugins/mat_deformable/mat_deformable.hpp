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
#include "state.hpp"

namespace hapticd {

class MatDeformable final : public Shape {
 public:
  static constexpr ShapeInfo kInfo = {"org.hapticd.shape.mat_deformable",
                                      "mat_deformable",
                                      "1.0",
                                      "MIT",
                                      "A soft body made of spheres along a skeleton: it yields, swings and settles.",
                                      HSP_C_DEFORMS};

 private:
  static constexpr auto skeletonFields() {  // how the foot is found
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{
        F::path("geometry", &T::geometry_,
                "model file (format hapticd-model/1) with medial, YAML or JSON; or a medial mesh, .ma", HSP_P_REQUIRED),
        F::choice("search", &T::search_, kSearchNames, 0,
                  "newton: safeguarded Newton from the last foot; binary: nested halving, the paper's way",
                  HSP_P_ACCURACY),
        F::integer("depth", &T::depth_, "", 4, 30, 10, "halvings of each parameter of search binary", HSP_P_ACCURACY),
        F::real("tolerance", &T::tolerance_, "m", 1e-12, 1e-3, 1e-8, "step at which search newton stops",
                HSP_P_ACCURACY | HSP_P_LIVE),
        F::choice("envelope", &T::envelope_, kEnvelopeNames, 0,
                  "exact: the union of the spheres; foot: the paper's test, too small where radii vary",
                  HSP_P_ACCURACY),
        F::integer("degree", &T::degree_, "", 1, medial::kMaxSkeletonDegree, 3, "of the skeleton spline, at most"),
        F::choice("evaluation", &T::evaluation_, kEvaluationNames, 0, "fast: a table a span; small: control points",
                  HSP_P_ACCURACY)};
  }
  static constexpr auto dynamicsFields() {  // how the body yields and swings
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{
        F::real("split", &T::split_, "", 0, 1, 0.5,
                "g: share of the depth by which the skeleton moves; 0.5: the opposite side stays, 1: it follows"),
        F::array("influence", &T::influence_, "", 2, 2, 2, 1, medial::kMaxSkeletonDegree + 1, "[4, 4]",
                 "p', q': control points that a contact moves; degree + 1: no jumps. Seen, not felt"),
        F::choice("dynamics", &T::dynamics_, kDynamicsNames, kAsFile,
                  "off: the body springs back at once; seen (or on): it swings and creeps for the eye alone; felt: the "
                  "hand meets the surface as it moves; auto: felt where damping or mass is given, else off; file: auto "
                  "for model files of format hapticd-model/2, seen for others"),
        F::real("contact_ratio", &T::contact_ratio_, "", 1.1, 100, 3,
                "felt: spring between probe and surface, over the stiffness of the body: the stiffest that fast motion "
                "feels"),
        F::real("relaxation.share", &T::relaxation_share_, "", 0, 10, 0,
                "felt: a fast press is stiffer by this share of the stiffness, and relaxes to it"),
        F::real("relaxation.time", &T::relaxation_time_, "s", 1e-4, 100, 0.5, "felt: time in which it relaxes"),
        F::real(
            "shear_offset", &T::shear_offset_, "", 0, 0.5, kUsualShearOffset,
            "distance of the four springs along the surface, as a share of the parameters; 0: none. They make a body "
            "stiffer than its file says: shear_distance does not")};
  }
  static constexpr auto contactFields() {  // what a probe feels besides
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{F::real("damping_scale", &T::damping_scale_, "m", 1e-6, 1, 5e-3,
                              "depth at which the damping of the contact is whole"),
                      F::real("friction_static", &T::friction_static_, "", 0, 10, 0,
                              "mu_s: force along the surface over normal force that a stuck probe must overcome"),
                      F::real("friction_dynamic", &T::friction_dynamic_, "", 0, 10, 0, "mu_d: of a sliding probe"),
                      F::real("viscosity", &T::viscosity_, "N s/m", 0, 100, 0, "drag along the surface in contact"),
                      F::choice("volume", &T::volume_, kSwitchNames, 0,
                                "on: what a press pushes in comes out all round, so that the volume stays")};
  }
  static constexpr auto materialFields() {  // what a file leaves open, and how its numbers are meant
    using T = MatDeformable;
    using F = Fields<T>;
    return std::array{
        F::real("stiffness", &T::stiffness_, "N/m", 0, 1e6, 300, "of a medial mesh whose file has none (.ma)"),
        F::real("damping", &T::damping_, "N s/m", 0, 1e6, 0.5,
                "likewise; a file may say up to ten times this, or 5, before it is refused"),
        F::real("mass", &T::mass_, "kg", 0, 1e6, 0.01, "of a vertex, likewise"),
        F::integer("rings", &T::rings_, "", 0, 8, 2,
                   "of a medial mesh: rings of neighbours that a contact moves with its cone or slab. Seen, not felt"),
        F::real(
            "crease", &T::crease_, "m", 0, 1, 1e-3,
            "of a medial mesh: width over which the force turns from one part to another in the crotch of a branch; "
            "0: at once",
            HSP_P_LIVE),
        F::real("display_tolerance", &T::display_tolerance_, "m", 0, 1e-2, 0,
                "chord error of the vertices that steps write 60 times a second for whoever draws; 0: none"),
        F::real(
            "shear_distance", &T::shear_distance_, "m", 0, 1, 0,
            "distance of the four springs along the surface, which then turn the force and leave its part along the "
            "normal as the file says; 0: shear_offset counts in files of format hapticd-model/1, none in others"),
        F::real("probe_radius", &T::probe_radius_, "m", 1e-4, 0.1, 5e-3,
                "of the flat tip with which a file's young, poisson and thickness are felt")};
  }

 public:
  /// In the order of their indices, which recordings hold.
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

  /// Bytes that describe a body: of the last deactivation; for the next activation.
  struct States {
    std::vector<unsigned char> kept, loaded;
  };
  struct Keeper {
    std::unique_ptr<medial::MovingMesh> hull;
    medial::VolumeKeeper volume;
  };

  medial::BodyOptions bodyOptions(const MedialFile& file, double rate_hz) const;
  Dynamics dynamicsOf(const MedialFile& file) const;
  void openBody(const MedialFile& file, double rate_hz);
  void openContacts(uint32_t probes);
  uint32_t openDisplay();    ///< @return vertices that move; 0: none are shown
  std::size_t openVolume();  ///< @return bytes that keep the volume; 0: it is not kept
  static const void* surfacesExtension();
  static const void* geometryExtension();
  static const void* energyExtension();
  static const void* stateExtension();
  void describe(const MedialFile& file, double tick) const;
  void describeMaterial(const MedialFile& file, double tick) const;
  void describeDynamics(const MedialFile& file) const;
  void describeContact(const MedialFile& file, double tick) const;
  medial::Tissue tissueAt(const MedialFile& file, std::size_t point) const;  ///< what the file says of a point
  std::vector<medial::Tissue> distinct(const MedialFile& file) const;
  void say(int level, const std::string& text) const;  ///< [main] to the log of the host, where it has one
  double elapsed(const hsp_step& step) noexcept HSP_RT;
  FindOptions findOptions(const hsp_step& step) const noexcept HSP_RT;
  FindOptions searchOptions() const noexcept;
  /// The surface that a probe is at, if there is one and the sample is good.
  struct Located {
    hsp_status status = HSP_OK;
    bool found = false;
    Felt surface;
  };
  Located locate(const hsp_probe& probe, const hsp_step& step, uint32_t index, hsp_contact& contact) noexcept HSP_RT;
  hsp_status touch(const hsp_probe& probe, const hsp_step& step, uint32_t index, hsp_contact& contact) noexcept HSP_RT;
  hsp_status stepFelt(const hsp_step& step) noexcept HSP_RT;
  hsp_status meet(const hsp_probe& probe, const hsp_step& step, uint32_t index, hsp_contact& contact) noexcept HSP_RT;
  void answer(const hsp_probe& probe, const medial::FeltContact& met, const Felt& felt, Track& track,
              hsp_contact& contact) noexcept HSP_RT;
  void push(const hsp_probe& probe, const Felt& felt, Track& track, hsp_contact& contact) noexcept HSP_RT;

  double energy() const noexcept HSP_RT;  ///< [J]

  int64_t nearby(const double p_model[3], double radius, hsp_near* out, uint64_t cap) const;
  hsp_status start(const hsp_near& near) noexcept HSP_RT;
  hsp_status stop(uint32_t probe) noexcept HSP_RT;
  int64_t save(void* buffer, uint64_t capacity) const;
  hsp_status load(const void* buffer, uint64_t length);
  void show(const hsp_step& step) noexcept HSP_RT;
  double displayed() const;  ///< [m] chord error of the frames
  hsp_status mesh(double chord_error, hsp_mesh& out);

  std::string geometry_;
  int search_ = 0, depth_ = 10, envelope_ = 0, degree_ = 3, evaluation_ = 0, dynamics_ = kAsFile;
  double tolerance_ = 1e-8, split_ = 0.5, shear_offset_ = 0.05, damping_scale_ = 5e-3;
  double friction_static_ = 0, friction_dynamic_ = 0, viscosity_ = 0, display_tolerance_ = 0;
  double contact_ratio_ = 3, relaxation_share_ = 0, relaxation_time_ = 0.5;
  double stiffness_ = 300, damping_ = 0.5, mass_ = 0.01, crease_ = 1e-3;
  double shear_distance_ = 0, probe_radius_ = 5e-3;
  int volume_ = 0, rings_ = 2;
  std::vector<double> influence_{4, 4};

  std::unique_ptr<SoftBody> body_;
  std::vector<Track> tracks_;           ///< one a probe
  std::vector<medial::Press> presses_;  ///< of this step, reserved for all probes
  /// What a step met on a surface that is felt, one a probe that is near, and which probe that is.
  struct Met {
    uint32_t probe = 0;
    Felt felt;
  };
  std::vector<medial::FeltContact> contacts_;  ///< as many as one surface answers; `met_` says how many are in use
  std::unique_ptr<medial::FeltPlace> beside_;  ///< of the rival, for the contact that is being met
  std::vector<Met> met_;                       ///< likewise
  std::unique_ptr<Displaced> displaced_;
  std::unique_ptr<Frames> frames_;  ///< written by the step, if display_tolerance asks for it
  std::unique_ptr<Keeper> keeper_;  ///< of the volume, if that was asked for
  std::unique_ptr<States> states_ = std::make_unique<States>();
  std::unique_ptr<Display> display_;
  double since_shown_ = 0;  ///< [s]
  bool shown_at_rest_ = true;
  uint64_t last_time_ns_ = 0;
  double stored_ = 0;  ///< [J] in the springs of the contacts
};

}  // namespace hapticd
