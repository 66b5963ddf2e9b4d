// SPDX-License-Identifier: MIT
/// Traces one probe over the active surfaces of a model. While no contact is held, the result is the nearest foot
/// point. While one is held, the result is the foot point of that contact. Each probe needs its own Tracer. All Tracers
/// can share one Model.
#pragma once
#include <array>
#include <cstdint>

#include "kernels/contact/contact_state.hpp"
#include "kernels/trace/model.hpp"
#include "kernels/trace/tracks.hpp"

namespace hapticd::trace {

enum class Method : std::uint8_t {
  /// direct parametric tracing (Thompson et al. 1999): a fixed number of first-order steps per tick; Newton's method
  /// near a pole
  kDirect,
  kNewton  ///< safeguarded Newton's method to a tolerance
};

struct TraceOptions {
  Method method = Method::kNewton;
  int iterations = 1;                 ///< steps of kDirect per tick on a surface, 1 to 4
  double tolerance = 1e-9;            ///< [m] kNewton stops when the estimated error of the foot point is below this
  static constexpr int kForSide = 6;  ///< evaluations that show on which side of an open shell a path began
  /// evaluations that a tick has at least where both sides are felt: with fewer, a press at a pole, seam or fold falls
  /// through or is felt late
  static constexpr int kForShell = 12;
  /// most evaluations of surfaces in one tick, over all surfaces; kForSide more where a probe seems to have come
  /// through an open shell, since the side from which the shell is felt depends on them
  int max_evaluations = 12;
  /// Which sides of the faces are felt, and the contact hysteresis. By default the probe always feels the front of the
  /// nearest face, and no contact is held.
  contact::ContactRule rule{contact::Sides::kFront, 0};
  /// True if overlapping parts are felt as one solid. If false, the model is not divided into parts: one foot point is
  /// found on all surfaces together.
  bool unite = true;
};

/// The foot point that is felt, in the model frame. If the probe is inside several parts at once and `unite` is true,
/// it is the point at which the shortest way out of all of them ends.
using contact::Foot;
using contact::FootStatus;

/// Follows local foot points (local minima of the distance) of all active surfaces from tick to tick. A surface is
/// evaluated only in ticks in which it could have the nearest foot point (see tracks.hpp).
class Tracer {
 public:
  /// [main] Allocates all that stepping needs.
  explicit Tracer(const Model& model);

  /// [rt] Starts tracing a surface at (u, v). If the surface is already active, its known foot points are kept, and the
  /// foot point near (u, v) is followed as well.
  /// @param distance [m] lower bound of the distance from the probe to the surface; 0 if it is unknown
  void activate(int surface, double u, double v, double distance = 0) noexcept;
  /// [rt] Stops tracing a surface.
  void deactivate(int surface) noexcept;
  /// [rt] Stops tracing all surfaces and forgets the contact and the last position of the probe.
  void reset() noexcept;
  /// [rt] Returns the foot point that the probe at `p` (model frame) feels. If `p` is not finite, the status is
  /// kInvalid and all tracks stay unchanged. The next contact then begins on the nearest face.
  Foot step(const Eigen::Vector3d& p, const TraceOptions& options = {}) noexcept;
  /// [rt] Forgets the last position of the probe and the side it was on, so that the next contact begins on the nearest
  /// face.
  void forgetContact() noexcept;
  /// [rt] Moves the probe to the other side of a shell (pop-through): from the next tick on, it feels that side.
  void popThrough() noexcept;

  bool active(int surface) const noexcept;
  int activeCount() const noexcept { return static_cast<int>(tracks_.active().size()); }
  const Model& model() const noexcept { return model_; }

 private:
  class Faces;

  /// The contact with one part of the model, or with the whole model.
  struct Contact {
    contact::ContactState state;
    int held = -1;  ///< track that holds the contact, or -1
  };
  /// The first face that the path of the probe meets.
  struct Crossing {
    double share = 2;  ///< fraction of the probe's path at which it crosses the face, 0 to 1; 2 if there is no crossing
    double side = 1;   ///< side of the face through which the probe enters: 1 front, -1 back
    int track = -1;
    bool sure = false;  ///< a path that ends beyond the surface has crossed it, since it cannot lead round its shell
  };

  /// What firstCrossing() knows of the path.
  struct Path {
    contact::PathStart from;
    double touching;  ///< the side (1 front, -1 back) on which the start counts if it lies on a surface
    int closed;       ///< shell that the path cannot lead round, because it does not end near by; -1 if there is none
  };
  /// The height of a point over the surface near a foot.
  struct HeightOver {
    double height = 0;    ///< [m] 0 if it cannot be computed
    bool inside = false;  ///< the foot of the point is inside a smooth piece of the surface, not at its end
  };

  /// The last known position of the probe relative to one part. It shows whether the part can be skipped in this tick.
  struct Part {
    int nearest = -1;  ///< track with the nearest foot of the part, or -1
    double depth = 0;  ///< [m] depth of the probe (above 0 inside) when the part's nearest foot was last certain
    double way = 0;    ///< [m] Tracks::pathLength() when `depth` was computed
    bool known = false;
  };

  Foot settle(const Eigen::Vector3d& p, const Eigen::Vector3d& last, const TraceOptions& options, int budget) noexcept;
  int nearestOf(int part, int start, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  bool mayBeNearer(int nearest, int part, const Eigen::Vector3d& p) const noexcept;
  void findFoot(const Patch& patch, Iterate& at, const Eigen::Vector3d& p, const TraceOptions& options, int steps,
                LocalFoot& foot) noexcept;
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
  bool isSpent() noexcept;
  void admitUnfinished(int track) noexcept;
  bool isHopeless(const Track& rival, double best) const noexcept;

  Contact& contactOf(int part) noexcept { return contacts_[static_cast<std::size_t>(part < 0 ? 0 : part)]; }
  int nearestTrack(int part) const noexcept {
    return part < 0 ? nearest_ : parts_[static_cast<std::size_t>(part)].nearest;
  }
  bool isUnchanged(const Eigen::Vector3d& p, const Eigen::Vector3d& last, const TraceOptions& options) noexcept;
  void hold(int part, int track) noexcept;
  contact::Followed follow(int part, double side, const Eigen::Vector3d& p, const TraceOptions& options,
                           Foot& foot) noexcept;
  int slideOver(int track, int side, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  int slideSmoothly(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  int slideOn(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  bool isReleased(int track, int side, double felt, const Eigen::Vector3d& p) const noexcept;
  Crossing firstCrossing(int part, const Path& path, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  Eigen::Vector3d normalBeyond(const Patch& patch, int side, const Eigen::Array2d& uv) const noexcept;
  bool goesOn(const Patch& patch, SideMask sides, const Eigen::Array2d& uv) const noexcept;
  /// The shell on which a track is, or -1 if there is no track.
  int shellOf(int track) const noexcept { return track < 0 ? -1 : model_.patch(tracks_[track].patch).shell; }
  bool isNextToHeld(int part) const noexcept;
  HeightOver heightOver(int track, const Eigen::Vector3d& point) noexcept;
  bool isOnSameSide(int track, const Eigen::Vector3d& point) noexcept;
  int sideBeyond(const Patch& patch, const LocalFoot& foot) const noexcept;
  bool crosses(int track, const Eigen::Vector3d& from, const Eigen::Vector3d& p, const TraceOptions& options,
               Crossing& crossing) noexcept;

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
  std::array<Contact, Model::kMaxParts> contacts_{};  ///< one per part; the first is also used for the whole model
  Eigen::Vector3d last_p_{0, 0, 0};
  int nearest_ = -1;         ///< track with the nearest foot point of all surfaces, or -1
  int budget_ = 0;           ///< evaluations left in this tick
  int last_shell_ = -1;      ///< shell of the nearest foot in the last tick, or -1
  bool undecided_ = false;   ///< true if the evaluations of this tick did not suffice to decide whether a path enters
  bool unfinished_ = false;  ///< true if a place beyond a side of the foot that is followed remains unseen in this tick
  bool has_last_ = false;
};

}  // namespace hapticd::trace
