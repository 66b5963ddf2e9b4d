// SPDX-License-Identifier: MIT
/// Base class of shapes that trace NURBS models. It has the parameters of geometry and tracing, the tracers, and the
/// extensions for surfaces and geometry. A derived class adds the forces of a contact.
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "hapticd/shape.hpp"
#include "hapticd/shape_names.h"
#include "kernels/brep/contact/tracer.hpp"
#include "kernels/contact/ball_proxy.hpp"
#include "kernels/trace/tracer.hpp"
#include "traced_shape/mesh.hpp"

namespace hapticd {

/// The contact of a probe with a model: foot point, normal and depth, as felt from the side on which the probe is.
struct Touch {
  contact::Foot foot;
  Eigen::Vector3d normal{0, 0, 1};  ///< unit normal, pointing away from the solid
  double depth = 0;                 ///< [m] penetration depth, > 0 inside
  bool traced = false;              ///< true if `foot` is valid
  hsp_status status = HSP_OK;       ///< status that step() returns for this probe
};

/// [main] Returns triangles that are within `chord_error` [m] of the surfaces.
Mesh tessellate(const trace::Model& model, double chord_error);

/// Base class of the shapes that trace. A derived class T calls load() in activate() and trace() for each probe, and
/// joins tracingFields<T>() into its table of parameters.
class TracedShape : public Shape {
 public:
  template <class T>
  static constexpr auto tracingFields() {
    using F = Fields<T>;
    return std::array{
        F::path("geometry", &TracedShape::geometry_,
                "model file (format hapticd-model/1, YAML or JSON); "
                "for nurbs_rigid also a part (.hpart), see hapticd import",
                HSP_P_REQUIRED),
        F::choice(
            "sides", &TracedShape::sides_, kSideNames, kAuto,
            "front: the solid is behind the outward normal; back: in front of it; both: a shell that pushes the probe "
            "back to the side from which it came; auto: both for parts that are not closed, front for all others"),
        F::choice("method", &TracedShape::method_, kMethodNames, 1,
                  "dpt: the first-order step of Thompson et al., except near a pole; newton: a safeguarded Newton "
                  "iteration down to `tolerance`",
                  HSP_P_ACCURACY),
        F::integer("iterations", &TracedShape::iterations_, "", 1, 4, 1, "steps per tick with method: dpt",
                   HSP_P_ACCURACY),
        F::choice("evaluation", &TracedShape::evaluation_, kEvaluationNames, 0,
                  "table: stores the polynomials of each knot span, fastest; net: uses only the control points, a "
                  "tenth of the memory",
                  HSP_P_ACCURACY),
        F::real("tolerance", &TracedShape::tolerance_, "m", 1e-12, 1e-3, 1e-9,
                "with method: newton, the search ends when the foot point's error is below this",
                HSP_P_ACCURACY | HSP_P_LIVE),
        F::real("contact_hysteresis", &TracedShape::contact_hysteresis_, "m", 0, kHoldAlways, kHoldAlways,
                "a contact stays on the face where it began, and changes to another face only if that is nearer by "
                "more than this. 0: always the nearest face; default: the contact stays until the probe comes out")};
  }

  /// Old names of parameters, and those that came later. They stand at the end of the table, because recordings refer
  /// to parameters by their number.
  template <class T>
  static constexpr auto laterFields() {
    using F = Fields<T>;
    return std::array{F::real("hold", &TracedShape::hold_, "m", kNotGiven, kHoldAlways, kNotGiven,
                              "the former name of contact_hysteresis; -1 means that it is not given"),
                      F::real("tip_radius", &TracedShape::tip_radius_, "m", 0, kLargestTip, 0,
                              "radius of the ball that touches the model, about the tip of the arm; 0: a point")};
  }

  void deactivate();
  void reset() noexcept HSP_RT;

 protected:
  /// [N] The claimed stiffness holds up to this force if no arm is known. It is more than any hand-held arm exerts.
  static constexpr double kUnknownForce = 100;
  enum Sides { kFront = 0, kBack = 1, kBoth = 2, kAuto = 3 };

  /// [main] Reads and prepares the model, with one tracer per probe. Writes the warnings of the model to the log, and
  /// the sizes of the model and of its memory to `report`. @throws std::exception with a text for the user.
  void load(const hsp_activation& activation, hsp_report& report);
  /// [rt] Traces one probe, and sets point, normal, depth, parameters and flags of its contact. The forces stay zero.
  Touch trace(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT;
  /// [main] Call it after load(): a contact that is twice as deep as the whole force of the arm presses is let go once
  /// the probe is outside again, behind another face. Else a body that went over a hand would pull it along behind it.
  /// @param depth [m] at which the wall pushes with the arm's largest force
  void letGoBeyond(double depth) { deepest_ = std::clamp(2 * depth, kLeastHeld, kMostHeld); }
  /// [rt] Call it after a probe was pushed through a shell: from now on this probe feels the shell's other side.
  void popThrough(uint32_t probe) noexcept HSP_RT;
  const trace::Model& model() const noexcept { return *model_; }  ///< the traced model; valid only if part() is null
  /// [any] Returns the part that is traced instead of a model file; null if there is none.
  const brep::Model* part() const noexcept { return part_.get(); }

  /// [main] Returns the extensions of a T; call it from T's extension().
  template <class T>
  const void* tracedExtension(const char* name);

  /// [main] Allows parts instead of model files; call it before load().
  /// @param instance see brep::ModelOptions @param without names that are left out, separated by commas
  void takeParts(const std::string& instance, const std::string& without) {
    takes_parts_ = true;
    instance_ = instance;
    without_ = without;
  }

  std::string geometry_;
  int sides_ = kAuto, method_ = 1, iterations_ = 1, evaluation_ = 0;
  double tolerance_ = 1e-9, contact_hysteresis_ = kHoldAlways, hold_ = kNotGiven, tip_radius_ = 0;

 private:
  /// [m] A contact that is less deep is held, as in a thin plate; one that is deeper is let go, however soft the wall
  /// is.
  static constexpr double kLeastHeld = 0.03, kMostHeld = 0.1;
  /// [m] with a contact hysteresis of at least this, the contact never changes to another face
  static constexpr double kHoldAlways = 1;
  static constexpr double kNotGiven = -1;
  static constexpr double kLargestTip = 0.05;  ///< [m] half of the distance at which surfaces are traced by default
  static constexpr const char* kSideNames[] = {"front", "back", "both", "auto"};
  static constexpr const char* kMethodNames[] = {"dpt", "newton"};
  static constexpr const char* kEvaluationNames[] = {"table", "net"};

  /// The foot points that the proximity search has found for one probe since the last step. After a jump only these are
  /// valid.
  struct OfferedFeet {
    std::array<hsp_near, 64> near;
    uint32_t count = 0;
  };

  /// The result of a search around a point. Several requests near this point can be answered with it.
  struct CachedSearch {
    Eigen::Vector3d at{0, 0, 0};
    /// [m] position of the last request that was answered with this result. A request far from it comes from another
    /// hand
    Eigen::Vector3d asked{0, 0, 0};
    double radius = -1;
    int uses = 0;  ///< number of requests answered with this result
    trace::Found found;
  };

  template <class T>
  static hsp_ext_surfaces surfacesOf(uint32_t count);
  template <class T>
  static hsp_ext_geometry geometryOf();
  template <class T>
  static hsp_ext_names namesOf();
  const CachedSearch& searchAbout(const Eigen::Vector3d& p, double radius) const;
  void beginAnew(uint32_t probe) noexcept HSP_RT;
  template <class FootAt>
  contact::Foot footOf(const hsp_probe& probe, uint32_t index, const FootAt& foot_at) noexcept HSP_RT;
  void forgetContact(uint32_t probe) noexcept HSP_RT;
  bool fitsAt(const Eigen::Vector3d& p, uint32_t probe) noexcept HSP_RT;
  trace::TraceOptions optionsOf(const hsp_step& step) const noexcept HSP_RT;
  int64_t nearby(const double p_model[3], double radius, hsp_near* out, uint64_t cap) const;
  hsp_status start(const hsp_near& near) noexcept HSP_RT;
  hsp_status stop(uint32_t probe, uint32_t surface) noexcept HSP_RT;
  hsp_status mesh(double chord_error, hsp_mesh& out);
  hsp_status bounds(double min[3], double max[3]) const;
  int64_t nameOf(uint32_t feature, char* text, uint64_t cap) const;
  void takeFormerNames();
  contact::ContactRule contactRule() const noexcept HSP_RT;
  Touch answer(const contact::Foot& foot, hsp_contact& contact) const noexcept HSP_RT;

  void loadPart(const std::string& bytes, const hsp_activation& activation, hsp_report& report);
  Touch tracePart(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT;

  bool takes_parts_ = false;
  double deepest_ = kMostHeld;  ///< see letGoBeyond()
  std::string instance_, without_;
  std::unique_ptr<brep::Model> part_;
  std::vector<brep::Tracer> part_tracers_;  ///< one per probe
  std::vector<contact::BallProxy> balls_;   ///< one per probe; empty if a point touches the model
  std::unique_ptr<trace::Model> model_;
  std::vector<trace::Tracer> tracers_;            ///< one per probe
  std::vector<OfferedFeet> offers_;               ///< one per probe
  std::vector<char> searched_;                    ///< by probe: 1 if a search has returned a result since the last jump
  mutable std::array<CachedSearch, 4> searches_;  ///< [sim] the newest results, enough for several fingers
  mutable std::size_t next_search_ = 0;           ///< [sim] index of the result that is replaced next
  Mesh mesh_;
  hsp_ext_surfaces surfaces_extension_{};
  hsp_ext_geometry geometry_extension_{};
  hsp_ext_names names_extension_{};
};

/// Returns the foot of a probe, or of the ball about it. The kernel lets go a point that went through, see
/// letGoBeyond(). Of a ball it knows the proxy alone, so here the ball is let go. @param foot_at function that traces a
/// point
template <class FootAt>
contact::Foot TracedShape::footOf(const hsp_probe& probe, uint32_t index, const FootAt& foot_at) noexcept HSP_RT {
  const Eigen::Vector3d p(probe.position);
  if (balls_.empty() || !p.allFinite()) return foot_at(p);
  contact::Foot foot = balls_[index].step(foot_at, p, tip_radius_);
  if (!(foot.depth > deepest_) || !fitsAt(p, index)) return foot;
  forgetContact(index);
  if (model_) searched_[index] = 0;
  return balls_[index].step(foot_at, p, tip_radius_);
}

template <class T>
hsp_ext_surfaces TracedShape::surfacesOf(uint32_t count) {
  return {sizeof(hsp_ext_surfaces), count,
          [](const hsp_shape* shape, const double p_model[3], double radius, hsp_near* out, uint64_t cap) -> int64_t {
            const TracedShape& self = *reinterpret_cast<const T*>(shape);
            return self.nearby(p_model, radius, out, cap);
          },
          [](hsp_shape* shape, const hsp_near* near) HSP_RT -> hsp_status {
            TracedShape& self = *reinterpret_cast<T*>(shape);
            return self.start(*near);
          },
          [](hsp_shape* shape, uint32_t probe, uint32_t surface) HSP_RT -> hsp_status {
            TracedShape& self = *reinterpret_cast<T*>(shape);
            return self.stop(probe, surface);
          }};
}

template <class T>
hsp_ext_geometry TracedShape::geometryOf() {
  return {sizeof(hsp_ext_geometry), 0,
          [](hsp_shape* shape, double chord_error, hsp_mesh* out) -> hsp_status {
            TracedShape& self = *reinterpret_cast<T*>(shape);
            return self.mesh(chord_error, *out);
          },
          [](hsp_shape* shape, double min[3], double max[3]) -> hsp_status {
            const TracedShape& self = *reinterpret_cast<T*>(shape);
            return self.bounds(min, max);
          }};
}

template <class T>
hsp_ext_names TracedShape::namesOf() {
  return {sizeof(hsp_ext_names), 0, [](hsp_shape* shape, uint32_t feature, char* text, uint64_t cap) -> int64_t {
            const TracedShape& self = *reinterpret_cast<T*>(shape);
            return self.nameOf(feature, text, cap);
          }};
}

template <class T>
const void* TracedShape::tracedExtension(const char* name) {
  const std::string_view wanted = name;
  if (wanted == HSP_EXT_SURFACES && model_) {
    surfaces_extension_ = surfacesOf<T>(static_cast<uint32_t>(model_->surfaceCount()));
    return &surfaces_extension_;
  }
  if (wanted == HSP_EXT_GEOMETRY && (model_ || part_)) {
    geometry_extension_ = geometryOf<T>();
    return &geometry_extension_;
  }
  if (wanted == HSP_EXT_NAMES && part_) {
    names_extension_ = namesOf<T>();
    return &names_extension_;
  }
  return nullptr;
}

}  // namespace hapticd
