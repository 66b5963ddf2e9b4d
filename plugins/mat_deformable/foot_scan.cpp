// SPDX-License-Identifier: MIT
#include "foot_scan.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd {
namespace {

using Eigen::Vector3d;

constexpr double kDense = 0.5;        ///< of the least radius: distance of neighbouring samples
constexpr int kMostPerInterval = 6;   ///< samples to an interval of the skeleton's points, each way
constexpr uint32_t kATick = 64;       ///< samples that a tick looks at: some 0.2 us
constexpr double kAside = 0.87;       ///< cosine to the foot's direction: samples within are of its own place
constexpr double kParting = 0.05;     ///< [rad] directions of two feet that differ by less are one
constexpr double kParted = 0.15;      ///< [rad] those that differ by more are two
constexpr double kMayBeNearer = 0.1;  ///< of the radius: a foot between samples is nearer than they are
constexpr uint32_t kGroup = 8;        ///< samples that are ruled out together; kATick is a multiple
constexpr float kAside2 = kAside * kAside;
constexpr float kRounding = 2e-5F;  ///< of the size squared: more than single numbers err by

std::vector<double> between(const std::vector<double>& t, int per_interval) {
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < t.size(); ++i)
    for (int k = 0; k < per_interval; ++k) all.push_back(t[i] + (t[i + 1] - t[i]) * k / per_interval);
  all.push_back(t.back());
  return all;
}

/// Samples an interval along u (0) or v (1), for their distance to be small beside the radius.
int perInterval(const medial::Skeleton& skeleton, std::size_t axis) {
  const auto& [us, vs] = skeleton.parameters();
  const std::vector<double>& t = axis == 0 ? us : vs;
  double longest = 0, least = HUGE_VAL;
  spline::SurfacePoint s;
  for (const double u : us) {
    for (const double v : vs) {
      skeleton.surface().evaluate1(u, v, s);
      longest = std::max(longest, (axis == 0 ? s.Su : s.Sv).norm());
      const double radius = skeleton.radius().evaluate(u, v).f;
      if (radius > 0) least = std::min(least, radius);
    }
  }
  const double interval =
      longest * (t.back() - t.front()) / static_cast<double>(std::max<std::size_t>(t.size(), 2) - 1);
  return static_cast<int>(std::clamp(std::ceil(interval / (kDense * least)), 1.0, 1.0 * kMostPerInterval));
}

}  // namespace

/// Whether the sphere of a sample reaches over p by more than `deepest`, which it then sets.
bool FootScan::nearer(const Sample& sample, const Vector3d& p, const medial::SkeletonFoot& foot,
                      double& deepest) noexcept {
  const Vector3d away = p - sample.center;
  const double reach = sample.radius - deepest, distance2 = away.squaredNorm();
  if (!(reach > 0) || !(distance2 < reach * reach)) return false;  // most: no root is taken
  const double distance = std::sqrt(distance2);
  if (away.dot(foot.normal) > kAside * distance) return false;
  deepest = sample.radius - distance;
  return true;
}

FootScan::FootScan(const medial::Skeleton& skeleton) {
  const auto& [us, vs] = skeleton.parameters();
  const std::vector<double> u_all =
      skeleton.curve() ? std::vector<double>{us.front()} : between(us, perInterval(skeleton, 0));
  const std::vector<double> v_all = between(vs, perInterval(skeleton, 1));
  samples_.reserve(u_all.size() * v_all.size());
  spline::SurfacePoint s;
  for (const double u : u_all) {
    for (const double v : v_all) {
      skeleton.surface().evaluate1(u, v, s);
      samples_.push_back({s.S, skeleton.radius().evaluate(u, v).f, u, v});
    }
  }
  scale();
}

void FootScan::scale() {
  Eigen::AlignedBox3d box;
  double greatest = 0;
  for (const Sample& sample : samples_) {
    box.extend(sample.center);
    greatest = std::max(greatest, sample.radius);
  }
  middle_ = box.center();
  size_ = std::max(0.5 * box.diagonal().norm() + greatest, 1e-300);
  for (std::vector<float>* all : {&x_, &y_, &z_, &radius_}) all->reserve(samples_.size() + kATick);
  for (std::size_t i = 0; i < samples_.size() + kATick; ++i) {
    const Sample& sample = samples_[i % samples_.size()];
    const Vector3d place = (sample.center - middle_) / size_;
    x_.push_back(static_cast<float>(place.x()));
    y_.push_back(static_cast<float>(place.y()));
    z_.push_back(static_cast<float>(place.z()));
    radius_.push_back(static_cast<float>(sample.radius / size_));
  }
}

/// Most samples are ruled out by the group, in single numbers; what the rest are is found to the last bit.
std::optional<std::array<double, 2>> FootScan::rival(const Vector3d& p, const medial::SkeletonFoot& foot,
                                                     uint32_t& next) const noexcept {
  const auto count = static_cast<uint32_t>(samples_.size()), looks = std::min(kATick, count);
  const Sample* best = nullptr;
  double deepest = foot.depth - kMayBeNearer * foot.radius;
  const Probe probe{((p - middle_) / size_).cast<float>(), foot.normal.cast<float>(),
                    static_cast<float>(deepest / size_)};
  const uint32_t first = next + 1 < count ? next + 1 : 0;
  for (uint32_t k = 0; k < looks; k += kGroup) {
    if (ruledOut(probe, first + k)) continue;
    for (uint32_t i = k; i < std::min(k + kGroup, looks); ++i)
      if (const Sample& sample = samples_[(first + i) % count]; nearer(sample, p, foot, deepest)) best = &sample;
  }
  next = (first + looks - 1) % count;
  if (best == nullptr) return std::nullopt;
  return std::array{best->u, best->v};
}

/// Whether each sample of a group is too far, |p - c|^2 > (r - deepest)^2, or surely in the direction of the foot.
bool FootScan::ruledOut(const Probe& probe, uint32_t first) const noexcept {
  using Group = Eigen::Array<float, kGroup, 1>;
  const auto at = [first](const std::vector<float>& all) { return Eigen::Map<const Group>(all.data() + first); };
  const Group x = probe.p.x() - at(x_), y = probe.p.y() - at(y_), z = probe.p.z() - at(z_);
  const Group distance2 = x * x + y * y + z * z, reach = at(radius_) - probe.deepest;
  const Group along = probe.normal.x() * x + probe.normal.y() * y + probe.normal.z() * z;
  const Group far = distance2 - reach * reach, beside = along * along.abs() - kAside2 * distance2;
  return far.max(beside).minCoeff() > kRounding;
}

double FootScan::apart(const medial::SkeletonFoot& a, const medial::SkeletonFoot& b) noexcept {
  const double angle = (a.normal - b.normal).norm();
  return std::clamp((angle - kParting) / (kParted - kParting), 0.0, 1.0);
}

}  // namespace hapticd
