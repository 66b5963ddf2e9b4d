// SPDX-License-Identifier: MIT
/// The feet that a Tracer follows: one for each active patch, and rivals, feet in other valleys of the same patches.
#pragma once
#include <cstdint>
#include <vector>

#include "kernels/trace/model.hpp"
#include "kernels/trace/newton.hpp"

namespace hapticd::trace {

/// One foot that is followed, or will be from a record of (u, v) as soon as it could be the nearest.
struct Track {
  Iterate at;
  LocalFoot foot;
  std::uint64_t tick = 0;     ///< last tick that refined it
  std::uint64_t touched = 0;  ///< last tick that refined it or in which a search offered it
  int patch = -1;
  int part = 0;        ///< of the model, see Model::part()
  int slot = -1;       ///< index among the active ones, -1: not active
  int rival = -1;      ///< next foot on the same patch, -1: none
  bool asked = false;  ///< activated by the host; otherwise by a neighbour's foot on a common side
  bool held = false;   ///< a contact is on it: only the host may drop it
};

/// Bookkeeping without geometry: which feet are followed, and how near the surface under each can be by now. The
/// distance to a foot changes by at most the way the probe goes (it is 1-Lipschitz), so a bound is kept for free.
class Tracks {
 public:
  /// [main] Allocates all there will ever be.
  explicit Tracks(const Model& model);

  Track& operator[](int index) noexcept { return tracks_[static_cast<std::size_t>(index)]; }
  const Track& operator[](int index) const noexcept { return tracks_[static_cast<std::size_t>(index)]; }
  /// [rt] Indices of the feet that are followed. Index of the first foot of a patch: the patch; rivals come after.
  const std::vector<int>& active() const noexcept { return active_; }
  bool isRival(int index) const noexcept { return index >= patch_count_; }

  /// [rt] Follows a patch from (u, v), which a search found at `distance` [m] or more. On a patch that is followed this
  /// starts a rival, or takes the place of a foot that has long been of no interest, unless it leads to a foot that is
  /// followed already or is more than kSoon [m] farther than the nearest, at `best`.
  void offer(int patch, const Eigen::Array2d& uv, double distance, double best, bool asked) noexcept;
  /// [rt] Follows a patch that was not followed, from (u, v) where a neighbour's foot has come to the common side.
  void follow(int patch, const Eigen::Array2d& uv) noexcept;
  /// [rt] Goes on with a patch from (u, v), where a neighbour's foot has come to the common side. The foot that the
  /// patch had becomes a rival if there is room.
  void restart(int patch, const Eigen::Array2d& uv) noexcept;
  /// [rt] Keeps a foot that another has displaced, if there is room.
  void keepAsRival(int patch, const Iterate& at, const LocalFoot& foot) noexcept;
  /// [rt] Follows a foot of this tick that was found elsewhere. Returns its index: that of the same foot if it is
  /// followed already.
  int put(int patch, const Iterate& at, const LocalFoot& foot) noexcept;
  /// [rt] Stops following a foot; the first foot of a patch takes its rivals with it.
  void drop(int index) noexcept;
  /// [rt] Rivals on the patch of `index` that have come to the same foot in this tick are one. Returns the index under
  /// which that foot goes on.
  int merge(int index) noexcept;
  void clear() noexcept;  ///< [rt]

  void nextTick() noexcept { ++tick_; }                  ///< [rt]
  std::uint64_t tick() const noexcept { return tick_; }  ///< [rt]
  /// [rt] The probe moved by `way` [m].
  void gone(double way) noexcept {
    way_ += way;
    if (way_ > kLongestWay) [[unlikely]]
      countAnew();
  }
  double way() const noexcept { return way_; }  ///< [rt] [m] gone since the last clear(), or so
  /// [rt] Notes the distance of a foot that was refined in this tick; it may yet come nearer by what it is wrong.
  void refined(int index) noexcept {
    Track& t = (*this)[index];
    t.tick = t.touched = tick_;
    key_[static_cast<std::size_t>(t.slot)] = t.foot.distance - (t.foot.residual > 0 ? t.foot.residual : 0) + way_;
  }
  /// [rt] Notes that a foot cannot be nearer than `distance` [m].
  void farther(int index, double distance) noexcept {
    key_[static_cast<std::size_t>((*this)[index].slot)] = distance + way_;
  }
  /// [rt] The foot not refined in this tick that could be nearer than `best` and has the smallest bound; -1: none.
  /// @param part only feet of this part; -1: all.
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

  /// [rt] [m] No point of the surface under a foot is nearer than this.
  double atLeast(int index) const noexcept { return key_[static_cast<std::size_t>((*this)[index].slot)] - way_; }

  /// [rt] Whether the surfaces under all other feet are farther than `distance` [m].
  bool isAlone(int index, double distance) const noexcept {
    if (key_.size() == 1) return true;
    const int own = (*this)[index].slot;
    for (std::size_t slot = 0; slot < key_.size(); ++slot)
      if (!(key_[slot] > distance + way_) && static_cast<int>(slot) != own) return false;
    return true;
  }

  /// [rt] Whether no other foot could be nearer than this one, refined in this tick.
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
  static constexpr double kLongestWay = 1e4;  ///< [m] then keys are counted from zero again, to keep their digits

  void append(int index, double bound) noexcept;
  Track* newRival(int patch) noexcept;
  void noteSearch() noexcept;
  void countAnew() noexcept;
  bool follows(int patch, const Eigen::Array2d& uv, double bound) noexcept;
  void set(int index, const Eigen::Array2d& uv, double bound) noexcept;
  bool isSame(int patch, const LocalFoot& one, const LocalFoot& other) const noexcept;

  const Model& model_;
  int patch_count_;
  std::vector<Track> tracks_;
  std::vector<int> active_;  ///< dense
  std::vector<double> key_;  ///< by slot: distance when last refined + way gone until then
  double way_ = 0;           ///< [m] length of the probe's path
  std::uint64_t tick_ = 0;
  /// Ticks in which the last two searches told their results, and the way gone by then.
  std::uint64_t told_ = 0, told_before_ = 0;
  double way_told_ = 0, way_told_before_ = 0;
};

}  // namespace hapticd::trace
