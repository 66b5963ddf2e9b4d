// SPDX-License-Identifier: MIT
#include "foot_scan.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd {
namespace {

using Eigen::Vector3d;

constexpr int kPerInterval = 2;       ///< samples to an interval of the skeleton's points, each way
constexpr uint32_t kATick = 64;       ///< samples that a tick looks at: some 0.2 us
constexpr double kApart = 0.5;        ///< of the radius: samples nearer than that to the foot are of its own place
constexpr double kMayBeNearer = 0.1;  ///< of the radius: a foot between samples is nearer than they are

std::vector<double> between(const std::vector<double>& t) {
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < t.size(); ++i)
    for (int k = 0; k < kPerInterval; ++k) all.push_back(t[i] + (t[i + 1] - t[i]) * k / kPerInterval);
  all.push_back(t.back());
  return all;
}

}  // namespace

FootScan::FootScan(const medial::Skeleton& skeleton) {
  const auto& [us, vs] = skeleton.parameters();
  const std::vector<double> u_all = skeleton.curve() ? std::vector<double>{us.front()} : between(us);
  const std::vector<double> v_all = between(vs);
  samples_.reserve(u_all.size() * v_all.size());
  spline::SurfacePoint s;
  for (const double u : u_all) {
    for (const double v : v_all) {
      skeleton.surface().evaluate1(u, v, s);
      samples_.push_back({s.S, skeleton.radius().evaluate(u, v).f, u, v});
    }
  }
}

std::optional<std::array<double, 2>> FootScan::rival(const Vector3d& p, const medial::SkeletonFoot& foot,
                                                     uint32_t& next) const noexcept {
  const auto count = static_cast<uint32_t>(samples_.size());
  const Sample* best = nullptr;
  const double apart = kApart * foot.radius;
  double deepest = foot.depth - kMayBeNearer * foot.radius;
  for (uint32_t k = std::min(kATick, count); k > 0; --k) {
    next = next + 1 < count ? next + 1 : 0;
    const Sample& sample = samples_[next];
    const double depth = sample.radius - (p - sample.center).norm();
    if (!(depth > deepest) || (sample.center - foot.center).squaredNorm() < apart * apart) continue;
    deepest = depth;
    best = &sample;
  }
  if (best == nullptr) return std::nullopt;
  return std::array{best->u, best->v};
}

}  // namespace hapticd
