/// The velocity of one probe from its positions: (x_i - x_(i-n)) / (nT), Thompson et al. 1999, Eq. 5.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "hapticd/abi.h"
#include "scene/scene.hpp"

namespace hapticd::servo {

class ProbeVelocity {
 public:
  /// [main] @param rate [Hz] of the samples
  ProbeVelocity(const scene::Velocity& how, double /*rate*/) : history_(static_cast<size_t>(how.parameter) + 1) {}

  /// [rt] Takes a position [m], dt [s] after the last; gives the velocity [m/s].
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept HSP_RT {
    now_ += dt;
    history_[next_] = {now_, position};
    next_ = next_ + 1 == history_.size() ? 0 : next_ + 1;
    if (count_ < history_.size()) ++count_;
    if (count_ < 2) return Eigen::Vector3d::Zero();
    const Entry& oldest = history_[count_ < history_.size() ? 0 : next_];
    return (position - oldest.position) / (now_ - oldest.time);
  }

  void reset() noexcept HSP_RT { next_ = count_ = 0; }  ///< [rt] forgets the past

 private:
  struct Entry {
    double time = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
  };
  std::vector<Entry> history_;
  size_t next_ = 0, count_ = 0;
  double now_ = 0;
};

}  // namespace hapticd::servo
