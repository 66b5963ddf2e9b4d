// SPDX-License-Identifier: MIT
/// Traces one probe over the active surfaces of a model: the nearest foot outside, the held one inside. One Tracer a
/// probe; the Model is shared.
#pragma once
#include <array>
#include <cstdint>

#include "kernels/contact/contact_state.hpp"
#include "kernels/trace/model.hpp"
#include "kernels/trace/tracks.hpp"

namespace hapticd::trace {

enum class Method : std::uint8_t {
  kDirect,  ///< the paper's first-order step, a fixed number of them a tick
  kNewton   ///< safeguarded Newton to a tolerance
};

struct TraceOptions {
  Method method = Method::kNewton;
  int iterations = 1;        ///< steps a tick of kDirect on a surface, 1..4
  double tolerance = 1e-9;   ///< [m] error of the foot at which kNewton stops
  int max_evaluations = 12;  ///< bound of the work of one tick, over all surfaces
  /// What is felt, and how long a contact is held. Here: the front of the nearest face, always.
  contact::ContactRule rule{contact::Sides::kFront, 0};
  /// Whether parts that run into each other are felt as one solid. Otherwise the nearest foot of all decides alone.
  bool unite = true;
};

/// The foot as it is felt, in the model's frame. Inside two parts at once: what leads out of both.
using contact::Foot;
using contact::FootStatus;

/// Local feet of all active surfaces, advanced once a tick. A surface is evaluated only in ticks in which it could hold
/// the nearest foot (see tracks.hpp).
class Tracer {
 public:
  /// [main] Allocates all that stepping needs.
  explicit Tracer(const Model& model);

  /// [rt] Starts tracing a surface at (u, v); `distance` [m], where known, is a lower bound of its distance from the
  /// probe. On an active surface (u, v) is followed beside the feet that are known, and taken when it is the nearest.
  void activate(int surface, double u, double v, double distance = 0) noexcept;
  /// [rt] Stops tracing a surface.
  void deactivate(int surface) noexcept;
  /// [rt] Forgets everything: nothing is active.
  void reset() noexcept;
  /// [rt] Foot of probe `p` (model frame) as it is felt. A probe that is no finite position leaves all tracks
  /// unchanged; after it a contact begins on the nearest face.
  Foot step(const Eigen::Vector3d& p, const TraceOptions& options = {}) noexcept;
  /// [rt] Forgets where the probe was: a contact begins on the nearest face.
  void forgetContact() noexcept;
  /// [rt] A shell gives way: from now on it is felt from its other side.
  void popThrough() noexcept;

  bool active(int surface) const noexcept;
  int activeCount() const noexcept { return static_cast<int>(tracks_.active().size()); }
  const Model& model() const noexcept { return model_; }

 private:
  class Faces;

  /// The contact with a part of the model, or with all of it.
  struct Contact {
    contact::ContactState state;
    int held = -1;  ///< track that the contact is held on, -1: none
  };
  /// The first face in the probe's way.
  struct Crossing {
    double share = 2;  ///< of the way
    double side = 1;   ///< of the face from which it is entered
    int track = -1;
  };

  /// What is known of a part of the model.
  struct Part {
    int nearest = -1;  ///< track
    double depth = 0;  ///< [m] > 0 inside, when its nearest foot was last certain
    double way = 0;    ///< [m] gone until then
    bool known = false;
  };

  Foot settle(const Eigen::Vector3d& p, const Eigen::Vector3d& last, const TraceOptions& options, int budget) noexcept;
  int nearestOf(int part, int start, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  void locate(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  LocalFoot footFrom(int patch, Iterate& at, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  int note(int track) noexcept;
  int refine(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  bool tryFrom(int track, const Eigen::Array2d& uv, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  int cross(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  void crossSeams(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  int crossSide(int track, int side, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  bool isFarther(int patch, const Eigen::Array2d& uv, const LocalFoot& there, const Eigen::Vector3d& p) const noexcept;
  int leavePole(int track, int side, const Eigen::Vector3d& p, const TraceOptions& options, bool around) noexcept;
  void drop(int track) noexcept;
  void dropUnlessHeld(int track) noexcept;
  bool isHopeless(const Track& rival, double best) const noexcept;

  Contact& contactOf(int part) noexcept { return contacts_[static_cast<std::size_t>(part < 0 ? 0 : part)]; }
  int nearestTrack(int part) const noexcept {
    return part < 0 ? nearest_ : parts_[static_cast<std::size_t>(part)].nearest;
  }
  bool goesOn(const Eigen::Vector3d& p, const Eigen::Vector3d& last, const TraceOptions& options) noexcept;
  void hold(int part, int track) noexcept;
  contact::Followed follow(int part, double side, const Eigen::Vector3d& p, const TraceOptions& options,
                           Foot& foot) noexcept;
  int slideOver(int track, int side, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  bool isReleased(int track, int side, double felt, const Eigen::Vector3d& p) const noexcept;
  Crossing firstCrossing(int part, const Eigen::Vector3d& from, const Eigen::Vector3d& p, double touching,
                         const TraceOptions& options) noexcept;
  bool crosses(int track, const Eigen::Vector3d& from, const Eigen::Vector3d& p, Crossing& crossing) noexcept;

  Foot nearestFoot(int part, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  Foot describe(int track, const Eigen::Vector3d& p, int evaluations) const noexcept;
  void decideSide(int track, const Eigen::Vector3d& p, Foot& foot) const noexcept;
  Eigen::Vector3d surfaceNormal(int track) const noexcept;
  Eigen::Vector3d edgeNormal(int track) const noexcept;
  void uniteParts(const Eigen::Vector3d& p, const Eigen::Vector3d& last, const TraceOptions& options,
                  Foot& foot) noexcept;
  bool refreshPart(int part, const Eigen::Vector3d& p, const Eigen::Vector3d& last, const TraceOptions& options,
                   double reach, Foot& foot) noexcept;
  bool nearestOfPart(int part, const Eigen::Vector3d& p, const TraceOptions& options, Foot& foot) noexcept;

  const Model& model_;
  Tracks tracks_;
  std::array<Part, Model::kMaxParts> parts_{};
  std::array<Contact, Model::kMaxParts> contacts_{};  ///< by part; the first is also that with all parts together
  Eigen::Vector3d last_p_{0, 0, 0};
  int nearest_ = -1;  ///< track
  int budget_ = 0;    ///< evaluations left in this tick
  bool has_last_ = false;
};

}  // namespace hapticd::trace
