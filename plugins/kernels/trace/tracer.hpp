// SPDX-License-Identifier: MIT
/// Traces one probe over the active surfaces of a model. One Tracer a probe; the Model is shared.
#pragma once
#include <array>
#include <cstdint>

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
  /// [m] A foot that holds a contact is left only for one nearer by more than this, however near others come; it still
  /// slides on across edges. 0: the nearest foot always. Large: a proxy, which never comes out of the far side.
  double hold = 0;
  /// Whether parts that run into each other are felt as one solid. Otherwise the nearest foot of all decides alone.
  bool unite = true;
};

enum class TraceStatus : std::uint8_t {
  kOk,        ///< foot within tolerance
  kDegraded,  ///< the evaluations ran out first; residual says how good the foot is
  kIdle,      ///< nothing is active
  kInvalid    ///< the probe is not a finite position; tracks are kept as they were
};

/// The nearest foot, in the model's frame. Inside two parts at once: what leads out of both.
struct Foot {
  Eigen::Vector3d point{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 1};  ///< outward, unit
  double depth = 0;                 ///< [m] > 0 inside, minus the distance outside
  double distance = 0;              ///< [m] from the probe to the point
  double behind = 0;                ///< [m] how far the probe is behind the surface, negative in front of it
  double aside = 0;                 ///< [m] how far it is beside a free edge that holds the foot
  double u = 0, v = 0;              ///< parameters of the model file
  double residual = 0;              ///< [m] estimated error of the foot
  int surface = -1;                 ///< index in the model file
  int evaluations = 0;              ///< of this tick, all surfaces together
  TraceStatus status = TraceStatus::kIdle;
  bool on_edge = false;  ///< the foot lies on a side of its patch
};

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
  /// [rt] Nearest foot of probe `p` (model frame). A probe that is no finite position leaves all tracks unchanged.
  Foot step(const Eigen::Vector3d& p, const TraceOptions& options = {}) noexcept;

  bool active(int surface) const noexcept;
  int activeCount() const noexcept { return static_cast<int>(tracks_.active().size()); }
  const Model& model() const noexcept { return model_; }

 private:
  /// What is known of a part of the model.
  struct Part {
    int nearest = -1;  ///< track
    double depth = 0;  ///< [m] > 0 inside, when its nearest foot was last certain
    double way = 0;    ///< [m] gone until then
    bool known = false;
  };

  int nearestOf(int part, int start, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  void locate(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  int note(int track) noexcept;
  int refine(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  bool tryFrom(int track, const Eigen::Array2d& uv, const Eigen::Vector3d& p, double tolerance) noexcept;
  int cross(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  void crossSeams(int track, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  int crossSide(int track, int side, const Eigen::Vector3d& p, const TraceOptions& options) noexcept;
  bool isFarther(int patch, const Eigen::Array2d& uv, const LocalFoot& there, const Eigen::Vector3d& p) const noexcept;
  int leavePole(int track, int side, const Eigen::Vector3d& p, const TraceOptions& options, bool around) noexcept;
  void drop(int track) noexcept;
  bool isHopeless(const Track& rival, double best) const noexcept;

  Foot answer(const Eigen::Vector3d& p, const TraceOptions& options, int budget) noexcept;
  Foot describe(int track, const Eigen::Vector3d& p, int evaluations) const noexcept;
  void decideSide(int track, const Eigen::Vector3d& p, Foot& foot) const noexcept;
  Eigen::Vector3d surfaceNormal(int track) const noexcept;
  Eigen::Vector3d edgeNormal(int track) const noexcept;
  void uniteParts(const Eigen::Vector3d& p, const TraceOptions& options, Foot& foot) noexcept;
  bool refreshPart(int part, const Eigen::Vector3d& p, const TraceOptions& options, double deepest,
                   Foot& foot) noexcept;

  const Model& model_;
  Tracks tracks_;
  std::array<Part, Model::kMaxParts> parts_{};
  Eigen::Vector3d last_p_{0, 0, 0};
  int nearest_ = -1;  ///< track
  int budget_ = 0;    ///< evaluations left in this tick
  bool has_last_ = false;
};

}  // namespace hapticd::trace
