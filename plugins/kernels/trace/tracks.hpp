// SPDX-License-Identifier: MIT
/// The foot points that a Tracer follows: one for each active patch, and rivals. A rival is a foot point at another
/// local minimum of the distance on the same patch.
#pragma once
#include <cstdint>
#include <vector>

#include "kernels/trace/model.hpp"
#include "kernels/trace/newton.hpp"

namespace hapticd::trace {

/// One foot point that is followed. If only its parameters (u, v) are known, it is computed as soon as it could be the
/// nearest.
struct Track {
  Iterate at;
  LocalFoot foot;
  std::uint64_t tick = 0;     ///< last tick in which the foot point was refined
  std::uint64_t touched = 0;  ///< last tick in which the foot point was refined, or a search result led to it
  int patch = -1;
  int part = 0;    ///< index of the patch's part, see Model::part()
  int slot = -1;   ///< index in Tracks::active(), or -1 if not active
  int rival = -1;  ///< index of the next foot point on the same patch, or -1
  /// true if the host activated the patch, false if the foot point of a neighbour reached the common side
  bool asked = false;
  bool held = false;  ///< true if this foot point holds a contact; the tracer then does not drop it by itself
};

/// The probe in the tick before a record comes.
struct Probe {
  Eigen::Vector3d p{0, 0, 0};
  bool known = false;  ///< false before the first tick
  double best = 0;     ///< [m] distance of the nearest foot point
};

/// The list of followed foot points, with a lower bound of the distance to each. If the probe moves by a length, no
/// distance changes by more than that length. So the bounds stay valid without any evaluation.
class Tracks {
 public:
  /// [main] Allocates all memory that will ever be needed.
  explicit Tracks(const Model& model);

  Track& operator[](int index) noexcept { return tracks_[static_cast<std::size_t>(index)]; }
  const Track& operator[](int index) const noexcept { return tracks_[static_cast<std::size_t>(index)]; }
  /// [rt] Returns the indices of the followed foot points. The first foot point of a patch has the index of the patch.
  /// Rivals have larger indices.
  const std::vector<int>& active() const noexcept { return active_; }
  bool isRival(int index) const noexcept { return index >= patch_count_; }

  /// [rt] Follows a patch from the result (u, v) of a search. If the patch is already followed, (u, v) becomes a rival,
  /// or replaces a foot point that no recent search has found. The result is ignored if it leads to a foot point that
  /// is followed already, or is more than kSoon [m] farther away than `probe.best`.
  /// @param distance [m] lower bound of the distance from the probe to the patch
  /// @param asked true if the host activated the patch
  void offer(int patch, const Eigen::Array2d& uv, double distance, const Probe& probe, bool asked) noexcept;
  /// [rt] Starts following a patch at (u, v), where a neighbour's foot has reached the common side. Does nothing if the
  /// patch is followed already.
  void follow(int patch, const Eigen::Array2d& uv) noexcept;
  /// [rt] Moves the first foot point of a patch to (u, v), where the foot point of a neighbour has reached the common
  /// side. The old foot point becomes a rival if there is room.
  void restart(int patch, const Eigen::Array2d& uv) noexcept;
  /// [rt] Keeps a foot point as a rival after another one has replaced it, if there is room.
  void keepAsRival(int patch, const Iterate& at, const LocalFoot& foot) noexcept;
  /// [rt] Follows a foot point that was computed in this tick. Returns its index. If the same foot point is followed
  /// already, returns the index of that one.
  int put(int patch, const Iterate& at, const LocalFoot& foot) noexcept;
  /// [rt] Stops following a foot point. If it is the first one of a patch, the rivals of the patch are dropped too.
  void drop(int index) noexcept;
  /// [rt] Merges the foot `index` with another foot of its patch if both have reached the same point in this tick.
  /// Returns the index of the foot that remains.
  int merge(int index) noexcept;
  void clear() noexcept;  ///< [rt] stops following all feet

  void nextTick() noexcept { ++tick_; }                  ///< [rt] begins a tick
  std::uint64_t tick() const noexcept { return tick_; }  ///< [rt] number of this tick
  /// [rt] Adds `way` [m], by which the probe has moved, to the length of its path.
  void gone(double way) noexcept {
    way_ += way;
    if (way_ > kLongestWay) [[unlikely]]
      countAnew();
  }
  double pathLength() const noexcept {
    return way_;
  }  ///< [rt] [m] length of the probe's path since it was last reset to 0
  /// [rt] Sets the bound of a foot point that was refined in this tick: its distance less its residual, because the
  /// true foot point may be nearer by the residual. Where evaluations ended before, the true foot may be anywhere.
  void refined(int index) noexcept {
    Track& t = (*this)[index];
    t.tick = t.touched = tick_;
    const double bound = t.foot.distance - (t.foot.residual > 0 ? t.foot.residual : 0);
    key_[static_cast<std::size_t>(t.slot)] = (t.foot.converged ? bound : 0) + way_;
  }
  /// [rt] Sets the bound of a foot point that cannot be nearer than `distance` [m].
  void farther(int index, double distance) noexcept {
    key_[static_cast<std::size_t>((*this)[index].slot)] = distance + way_;
  }
  /// [rt] Returns the index of the foot point with the smallest bound among those that were not refined in this tick
  /// and could be nearer than `best` [m], or -1 if there is none. @param part only foot points of this part; -1: of all
  /// parts
  int mostPromising(double best, int part) const noexcept {
    double lowest = best + way_;
    int found = -1;
    for (std::size_t slot = 0; slot < key_.size(); ++slot) {
      if (!(key_[slot] < lowest)) continue;
      const Track& t = (*this)[active_[slot]];
      if (t.tick == tick_ || (part >= 0 && t.part != part)) continue;
      lowest = key_[slot];
      found = active_[slot];
    }
    return found;
  }

  /// [rt] Returns a lower bound of the distance [m] to the surface around a foot.
  double atLeast(int index) const noexcept { return key_[static_cast<std::size_t>((*this)[index].slot)] - way_; }

  /// [rt] True if the bounds of all other foot points are greater than `distance` [m].
  bool isAlone(int index, double distance) const noexcept {
    if (key_.size() == 1) return true;
    const int own = (*this)[index].slot;
    for (std::size_t slot = 0; slot < key_.size(); ++slot)
      if (!(key_[slot] > distance + way_) && static_cast<int>(slot) != own) return false;
    return true;
  }

  /// [rt] True if no other foot point can be nearer than this one, which was refined in this tick.
  bool isNearest(int index) const noexcept {
    if (key_.size() == 1) return true;
    const Track& t = (*this)[index];
    const double lowest = t.foot.distance + way_;
    for (std::size_t slot = 0; slot < key_.size(); ++slot)
      if (key_[slot] < lowest && static_cast<int>(slot) != t.slot) return false;
    return true;
  }

 private:
  static constexpr int kRivals = 32;
  /// [m] When the path is this long, way_ is reset to 0 and all keys are reduced by it, so that they do not lose
  /// digits.
  static constexpr double kLongestWay = 1e4;

  void append(int index, double bound) noexcept;
  Track* newRival(int patch) noexcept;
  void noteSearch() noexcept;
  void countAnew() noexcept;
  bool follows(int patch, const Eigen::Array2d& uv, double bound, const Probe& probe) noexcept;
  bool isCertainlyFarther(int index, const Eigen::Array2d& uv, double bound, const Probe& probe) const noexcept;
  void set(int index, const Eigen::Array2d& uv, double bound) noexcept;
  bool isSame(int patch, const LocalFoot& one, const LocalFoot& other) const noexcept;

  const Model& model_;
  int patch_count_;
  std::vector<Track> tracks_;
  std::vector<int> active_;  ///< indices of the active feet, by slot
  /// [m] by slot: bound of the distance, plus the value of way_ at the time when the bound was found
  std::vector<double> key_;
  double way_ = 0;  ///< [m] length of the probe's path
  std::uint64_t tick_ = 0;
  /// The ticks in which the results of the last two searches arrived, and the values of way_ [m] in those ticks.
  std::uint64_t told_ = 0, told_before_ = 0;
  double way_told_ = 0, way_told_before_ = 0;
};

}  // namespace hapticd::trace
