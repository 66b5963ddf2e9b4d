/// Traces one probe over the active surfaces of a model. One Tracer a probe; the Model is shared.
#pragma once
#include <cstdint>
#include <vector>

#include "kernels/trace/model.hpp"
#include "kernels/trace/newton.hpp"

namespace hapticd::trace {

enum class Method : std::uint8_t {
  kDirect,  ///< the paper's first-order step, a fixed number of them a tick
  kNewton   ///< safeguarded Newton to a tolerance
};

struct TraceOptions {
  Method method = Method::kNewton;
  int iterations = 1;        ///< steps a tick of kDirect, 1..4
  double tolerance = 1e-9;   ///< [m] error of the foot at which kNewton stops
  int max_evaluations = 12;  ///< bound of the work of one tick, over all surfaces
};

enum class TraceStatus : std::uint8_t {
  kOk,        ///< foot within tolerance
  kDegraded,  ///< the evaluations ran out first; residual says how good the foot is
  kIdle,      ///< nothing is active
  kInvalid    ///< the probe is not a finite position; tracks are kept as they were
};

/// The nearest foot, in the model's frame.
struct Foot {
  Eigen::Vector3d point{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 1};  ///< outward, unit
  double depth = 0;                 ///< [m] > 0 inside, minus the distance outside
  double distance = 0;           ///< [m] from the probe to the point
  double behind = 0;  ///< [m] how far the probe is behind the surface, negative in front of it
  double aside = 0;   ///< [m] how far it is beside a free edge that holds the foot
  double u = 0, v = 0;              ///< parameters of the model file
  double residual = 0;              ///< [m] estimated error of the foot
  int surface = -1;                 ///< index in the model file
  int evaluations = 0;              ///< of this tick, all surfaces together
  TraceStatus status = TraceStatus::kIdle;
  bool on_edge = false;  ///< the foot lies on a side of its patch
};

/// Local feet of all active surfaces, advanced once a tick. The distance to a surface changes by at most the way the
/// probe goes (it is 1-Lipschitz), so a surface is evaluated only in ticks in which it could hold the nearest foot.
class Tracer {
 public:
  /// [main] Allocates all that stepping needs.
  explicit Tracer(const Model& model);

  /// [rt] Starts tracing a surface at (u, v); `distance` [m], where known, is a lower bound of its distance from the
  /// probe. On an active surface (u, v) is a second candidate: it is taken if it proves nearer than the tracked foot.
  void activate(int surface, double u, double v, double distance = 0) noexcept;
  /// [rt] Stops tracing a surface.
  void deactivate(int surface) noexcept;
  /// [rt] Forgets everything: nothing is active.
  void reset() noexcept;
  /// [rt] Nearest foot of probe `p` (model frame). A probe that is no finite position leaves all tracks unchanged.
  Foot step(const Eigen::Vector3d& p, const TraceOptions& options = {}) noexcept;

  bool active(int surface) const noexcept;
  int activeCount() const noexcept { return static_cast<int>(active_.size()); }
  const Model& model() const noexcept { return model_; }

 private:
  struct Track {
    Iterate at;
    LocalFoot foot;
    Eigen::Array2d candidate{0, 0};
    std::uint64_t tick = 0;  ///< last tick that refined it
    int slot = -1;           ///< index in active_, -1: not active
    bool has_candidate = false;
    bool asked = false;  ///< activated by the host; otherwise by a neighbour's foot on a common side
  };

  Track& track(int patch) noexcept { return tracks_[static_cast<std::size_t>(patch)]; }
  const Track& track(int patch) const noexcept { return tracks_[static_cast<std::size_t>(patch)]; }
  void start(int patch, const Eigen::Array2d& uv, double distance, bool asked) noexcept;
  void drop(int patch) noexcept;
  void goneTo(const Eigen::Vector3d& p) noexcept;
  int mostPromising(double best) const noexcept;

  void stepDirect(const Eigen::Vector3d& p, int iterations) noexcept;
  void stepNewton(const Eigen::Vector3d& p, double tolerance) noexcept;
  void refine(int patch, const Eigen::Vector3d& p, double tolerance) noexcept;
  bool tryFrom(int patch, const Eigen::Array2d& uv, const Eigen::Vector3d& p, double tolerance) noexcept;
  void store(int patch) noexcept;
  void cross(const Eigen::Vector3d& p, double tolerance) noexcept;
  bool crossSide(int patch, int side, const Eigen::Vector3d& p, double tolerance) noexcept;
  bool leavePole(int patch, int side, const Eigen::Vector3d& p, double tolerance) noexcept;

  Foot describe(int patch, const Eigen::Vector3d& p) const noexcept;
  Eigen::Vector3d surfaceNormal(int patch) const noexcept;
  Eigen::Vector3d edgeNormal(int patch) const noexcept;

  const Model& model_;
  std::vector<Track> tracks_;  ///< by patch
  std::vector<int> active_;    ///< patches, dense
  std::vector<double> key_;    ///< by slot: distance when last refined + way gone until then
  Eigen::Vector3d last_p_{0, 0, 0};
  double way_ = 0;  ///< [m] length of the probe's path
  std::uint64_t tick_ = 0;
  int nearest_ = -1;
  int budget_ = 0;  ///< evaluations left in this tick
  bool has_last_ = false;
};

}  // namespace hapticd::trace
