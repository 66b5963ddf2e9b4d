// SPDX-License-Identifier: MIT
#include "foot_scan.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd {
namespace {

using Eigen::Vector3d;

constexpr double kDense = 0.5;  ///< distance of neighbouring samples, as a share of the least radius
/// most samples in an interval between points of the skeleton, along each direction
constexpr int kMostPerInterval = 6;
constexpr uint32_t kATick = 64;  ///< samples that are examined in one tick; they take about 0.2 us
/// samples whose direction has a greater cosine to the foot's direction belong to the foot's own place
constexpr double kAside = 0.87;
constexpr double kFarAside = 0.7;  ///< samples with a smaller cosine certainly belong to another place
constexpr double kParting = 0.05;  ///< [rad] feet whose directions differ by less are at one place
constexpr double kParted = 0.15;   ///< [rad] feet whose directions differ by more are at two places
/// share of the radius by which a foot between two samples may be nearer than these samples
constexpr double kMayBeNearer = 0.1;
constexpr uint32_t kGroup = 8;  ///< number of samples that are ruled out together; kATick is a multiple of it
/// A condition that a sample misses is multiplied by this. So a sample that clearly misses it gets a large negative
/// depth, and one that misses it only by rounding stays possible.
constexpr float kSteep = 1e6F;
constexpr float kRounding = 2e-5F;  ///< share of size_; more than the rounding error of floats

std::vector<double> between(const std::vector<double>& t, int per_interval) {
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < t.size(); ++i)
    for (int k = 0; k < per_interval; ++k) all.push_back(t[i] + (t[i + 1] - t[i]) * k / per_interval);
  all.push_back(t.back());
  return all;
}

/// Returns the number of samples per interval along u (0) or v (1) with which their distance is small compared with the
/// radius.
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

/// True if p is deeper than `deepest` in the sphere of a sample; then sets `deepest` to this depth. Far aside of the
/// foot, p may be less deep by `width`. So the other flank of a valley is known before it begins to push.
bool FootScan::nearer(const Sample& sample, const Vector3d& p, const medial::SkeletonFoot& foot, double width,
                      double& deepest) noexcept {
  const Vector3d away = p - sample.center;
  const double reach = sample.radius + width - deepest, distance2 = away.squaredNorm();
  if (!(reach > 0) || !(distance2 < reach * reach)) return false;  // most samples end here, without a square root
  const double distance = std::sqrt(distance2), along = away.dot(foot.normal);
  const double over = sample.radius - distance + (along < kFarAside * distance ? width : 0);
  if (along > kAside * distance || !(over > deepest)) return false;
  deepest = over;
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

/// Returns the start of the next group, from the k-th sample on, in which nearer() may be true for some sample. A
/// sample that is not far enough aside gets a large negative depth.
uint32_t FootScan::nextGroup(const Probe& probe, uint32_t first, uint32_t k, uint32_t looks) const noexcept {
  using Group = Eigen::Array<float, kGroup, 1>;
  const float deepest = probe.deepest - kRounding;
  for (; k < looks; k += kGroup) {
    const auto at = [i = first + k](const std::vector<float>& all) { return Eigen::Map<const Group>(all.data() + i); };
    const Group x = probe.p.x() - at(x_), y = probe.p.y() - at(y_), z = probe.p.z() - at(z_);
    const Group distance = (x * x + y * y + z * z).sqrt(), over = at(radius_) - distance;
    const Group along = probe.normal.x() * x + probe.normal.y() * y + probe.normal.z() * z - kRounding;
    const Group aside = over.min(kSteep * (static_cast<float>(kAside) * distance - along));
    const Group far_aside = (over + probe.width).min(kSteep * (static_cast<float>(kFarAside) * distance - along));
    if (aside.max(far_aside).maxCoeff() > deepest) break;
  }
  return k;
}

/// Rules most samples out in groups, with floats, and examines the others in double precision.
std::optional<std::array<double, 2>> FootScan::rival(const Vector3d& p, const medial::SkeletonFoot& foot, double width,
                                                     uint32_t& next) const noexcept {
  const auto count = static_cast<uint32_t>(samples_.size()), looks = std::min(kATick, count);
  const Sample* best = nullptr;
  double deepest = foot.depth - kMayBeNearer * foot.radius;
  const Probe probe{((p - middle_) / size_).cast<float>(), foot.normal.cast<float>(),
                    static_cast<float>(deepest / size_), static_cast<float>(width / size_)};
  const uint32_t first = next + 1 < count ? next + 1 : 0;
  for (uint32_t k = nextGroup(probe, first, 0, looks); k < looks; k = nextGroup(probe, first, k + kGroup, looks)) {
    for (uint32_t i = k; i < std::min(k + kGroup, looks); ++i)
      if (const Sample& sample = samples_[(first + i) % count]; nearer(sample, p, foot, width, deepest)) best = &sample;
  }
  next = (first + looks - 1) % count;
  if (best == nullptr) return std::nullopt;
  return std::array{best->u, best->v};
}

double FootScan::apart(const medial::SkeletonFoot& a, const medial::SkeletonFoot& b) noexcept {
  const double angle = (a.normal - b.normal).norm();
  return std::clamp((angle - kParting) / (kParted - kParting), 0.0, 1.0);
}

}  // namespace hapticd
