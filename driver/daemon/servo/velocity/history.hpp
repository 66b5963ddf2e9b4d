// SPDX-License-Identifier: MIT
/// The last positions of a probe, newest first, each with the time since the position before it. No absolute times are
/// stored, because they would lose digits over days.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace hapticd::velocity {

class History {
 public:
  explicit History(int capacity) : samples_(static_cast<size_t>(capacity)) {}  ///< [main] allocates

  /// [rt] Adds a position. @param dt [s] since the last one
  void push(const Eigen::Vector3d& position, double dt) noexcept {
    newest_ = newest_ == 0 ? samples_.size() - 1 : newest_ - 1;
    samples_[newest_] = {position, dt};
    if (count_ < static_cast<int>(samples_.size())) ++count_;
  }
  /// [rt] Returns a position; age 0 is the newest.
  const Eigen::Vector3d& position(int age) const noexcept { return at(age).position; }
  double step(int age) const noexcept { return at(age).dt; }  ///< [rt] [s] time from the sample before to sample `age`
  int count() const noexcept { return count_; }
  void clear() noexcept { count_ = 0; }

 private:
  struct Sample {
    Eigen::Vector3d position{0, 0, 0};
    double dt = 0;
  };
  const Sample& at(int age) const noexcept {
    const size_t i = newest_ + static_cast<size_t>(age);
    return samples_[i < samples_.size() ? i : i - samples_.size()];
  }
  std::vector<Sample> samples_;
  size_t newest_ = 0;
  int count_ = 0;
};

}  // namespace hapticd::velocity
