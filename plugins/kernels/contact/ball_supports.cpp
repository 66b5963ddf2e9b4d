// SPDX-License-Identifier: MIT
#include "kernels/contact/ball_supports.hpp"

#include <algorithm>
#include <span>

namespace hapticd::contact {

void BallSupports::move(std::size_t from, std::size_t to) noexcept {
  if (from == to) return;
  free_[to] = free_[from];
  supports_[to] = supports_[from];
}

void BallSupports::add(const HalfSpace& free, const Support& support) noexcept {
  count_ = std::min(count_ + 1, kMostHalfSpaces);
  for (std::size_t i = count_ - 1; i > 0; --i) move(i - 1, i);
  free_[0] = free;
  supports_[0] = support;
}

void BallSupports::age() noexcept {
  for (Support& support : supports_) support.old = true;
}

bool BallSupports::dropOld(const Eigen::Vector3d& center, double radius, double touching) noexcept {
  const std::size_t before = count_;
  count_ = 0;
  for (std::size_t i = 0; i < before; ++i) {
    const bool gone = supports_[i].old && (center - supports_[i].point).norm() > radius + touching;
    if (!gone) move(i, count_++);
  }
  return count_ != before;
}

void BallSupports::turnTo(const Eigen::Vector3d& center, double radius) noexcept {
  if (count_ == 1) return clear();
  for (std::size_t i = 0; i < count_; ++i) {
    const Eigen::Vector3d out = center - supports_[i].point;
    if (out.squaredNorm() > 0) free_[i] = beyond(supports_[i].point, out.normalized(), radius);
  }
}

Eigen::Vector3d BallSupports::nearestTo(const Eigen::Vector3d& p) noexcept {
  const HeldPoint nearest = nearestCommonPoint(std::span(free_).first(count_), p);
  count_ = nearest.by.size;
  for (std::size_t i = 0; i < count_; ++i) move(nearest.by.planes[i], i);  // they rise: none is overwritten unread
  return nearest.point;
}

}  // namespace hapticd::contact
