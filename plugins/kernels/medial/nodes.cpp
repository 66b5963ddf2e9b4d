// SPDX-License-Identifier: MIT
#include "kernels/medial/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/medial/influence.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector4d;

constexpr double kLargest = 1.0;  ///< [m] settle times are those of a motion that begins with this amplitude

void requireMaterial(const Oscillator& o, std::size_t i) {
  const auto bad = [](double x) { return !(x >= 0) || !std::isfinite(x); };
  if (bad(o.mass) || bad(o.damping) || bad(o.stiffness))
    throw std::invalid_argument("material of node " + std::to_string(i) + ": mass " + std::to_string(o.mass) +
                                ", damping " + std::to_string(o.damping) + ", stiffness " +
                                std::to_string(o.stiffness) + "; all must be finite numbers of at least 0");
}

/// Returns the step of a node. Without mass the node creeps; without mass and damping, or without a spring, it returns
/// to rest at once.
OscillatorStep stepOf(const Oscillator& o, double dt) noexcept {
  if (!(o.stiffness > 0) || (!(o.mass > 0) && !(o.damping > 0))) return {0, 0, 0, 0};
  if (!(o.mass > 0)) return {std::exp(-o.stiffness / o.damping * dt), 0, 0, 0};
  OscillatorStep step = oscillatorStep(o, dt);
  step.xx *= 1 - kRoundingLoss;
  step.xv *= 1 - kRoundingLoss;
  step.vx *= 1 - kRoundingLoss;
  step.vv *= 1 - kRoundingLoss;
  return step;
}

/// Returns the time [s] in which the slowest part of a motion decays from kLargest to kAsleep.
double settleTimeOf(const Oscillator& o) noexcept {
  if (!(o.stiffness > 0)) return 0;
  const double half = 0.5 * o.damping, discriminant = half * half - o.mass * o.stiffness;
  const double rate = !(o.mass > 0)       ? (o.damping > 0 ? o.stiffness / o.damping : HUGE_VAL)
                      : discriminant <= 0 ? half / o.mass
                                          : o.stiffness / (half + std::sqrt(discriminant));
  const double time = std::log(kLargest / kAsleep) / rate;
  return time < kLongestSettle ? time : kLongestSettle;
}

bool sameOscillator(const Oscillator& a, const Oscillator& b) {
  return a.mass == b.mass && a.damping == b.damping && a.stiffness == b.stiffness;
}

}  // namespace

Nodes::Nodes(std::size_t count, const std::vector<Oscillator>& material, const DeformationOptions& options)
    : options_(options) {
  if (material.size() != 1 && material.size() != count)
    throw std::invalid_argument("deformation: " + std::to_string(material.size()) + " materials, expected 1 or " +
                                std::to_string(count));
  nodes_.resize(count);
  is_awake_.assign(count, 0);
  awake_.reserve(count);
  std::vector<uint16_t> which;
  for (std::size_t i = 0; i < material.size(); ++i) {
    requireMaterial(material[i], i);
    auto known = std::find_if(materials_.begin(), materials_.end(),
                              [&](const Material& m) { return sameOscillator(m.oscillator, material[i]); });
    if (known == materials_.end()) {
      if (materials_.size() > UINT16_MAX) throw std::invalid_argument("more than 65536 materials");
      Material added;
      added.oscillator = material[i];
      if (material[i].stiffness > 0) added.time_scale2 = material[i].mass / material[i].stiffness;
      settle_ = std::max(settle_, settleTimeOf(material[i]));
      known = materials_.insert(materials_.end(), added);
    }
    which.push_back(static_cast<uint16_t>(known - materials_.begin()));
  }
  materials_.shrink_to_fit();
  if (materials_.size() > 1) which_ = std::move(which);
}

void Nodes::prepare(double dt) noexcept {
  if (std::fabs(dt - prepared_dt_) <= kSameStep * dt) return;
  prepared_dt_ = dt;
  for (Material& material : materials_) material.step = stepOf(material.oscillator, dt);
}

void Nodes::advance(double dt) noexcept {
  if (awake_.empty() || !options_.dynamics || !(dt > 0)) return;
  if (dt >= settle_) return clear();
  prepare(dt);
  for (std::size_t k = 0; k < awake_.size();) {
    const std::size_t i = awake_[k];
    Node& node = nodes_[i];
    const Material& material = materialOf(i);
    const Vector4d moved = material.step.xx * node.x + material.step.xv * node.v;
    node.v = material.step.vx * node.x + material.step.vv * node.v;
    node.x = moved;
    const double amplitude2 = node.x.squaredNorm() + material.time_scale2 * node.v.squaredNorm();
    if (amplitude2 > kAsleep * kAsleep) {
      ++k;
      continue;
    }
    node = Node{};  // also if its displacement is NaN
    is_awake_[i] = 0;
    awake_[k] = awake_.back();
    awake_.pop_back();
  }
}

void Nodes::reset() noexcept {
  clear();
  bulge_ = 0;
}

void Nodes::clear() noexcept {
  for (const uint32_t i : awake_) {
    nodes_[i] = Node{};
    is_awake_[i] = 0;
  }
  awake_.clear();
}

void Nodes::wake(std::size_t node) noexcept {
  if (is_awake_[node] != 0) return;
  is_awake_[node] = 1;
  awake_.push_back(static_cast<uint32_t>(node));  // room for all is reserved, so it never allocates
}

void Nodes::place(std::size_t i, const Vector4d& displacement, const Vector4d& rate) noexcept {
  wake(i);
  nodes_[i].x = displacement;
  nodes_[i].v = rate;
}

void Nodes::yield(const NodeContact& contact, std::span<const NodeWeight> felt,
                  std::span<const NodeWeight> moved) noexcept {
  Vector4d inward;
  inward << -contact.normal, -1;  // displacement of the contour = inward . (skeleton, radius)
  Vector4d share;
  const Split unit = splitDepth(1, options_.split);
  share << -unit.skeleton * contact.normal, -unit.radius;
  Vector4d x = Vector4d::Zero(), v = Vector4d::Zero();
  for (const NodeWeight& part : felt) {
    x += part.weight * nodes_[part.node].x;
    v += part.weight * nodes_[part.node].v;
  }
  const double push = contact.depth + bulge_ - inward.dot(x);
  if (!(push > -kAsleep)) return;  // the contour lies deeper than the probe; its springs bring it back
  const double kick = options_.dynamics ? std::max(0.0, contact.speed - inward.dot(v)) : 0;
  if (!(std::max(push, 0.0) + kick > 0) || !std::isfinite(push + kick)) return;
  const Vector4d dx = std::max(push, 0.0) * share, dv = kick * share;
  for (const NodeWeight& part : moved) {
    wake(part.node);
    nodes_[part.node].x += part.weight * dx;
    nodes_[part.node].v += part.weight * dv;
  }
}

double Nodes::energy() const noexcept {
  double sum = 0;
  for (const uint32_t i : awake_) {
    const Oscillator& o = materialOf(i).oscillator;
    sum += 0.5 * (o.stiffness * nodes_[i].x.squaredNorm() + o.mass * nodes_[i].v.squaredNorm());
  }
  return sum;
}

std::size_t Nodes::bytes() const noexcept {
  return nodes_.capacity() * sizeof(Node) + materials_.capacity() * sizeof(Material) +
         which_.capacity() * sizeof(uint16_t) + awake_.capacity() * sizeof(uint32_t) + is_awake_.capacity();
}

}  // namespace hapticd::medial
