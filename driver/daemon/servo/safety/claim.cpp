// SPDX-License-Identifier: MIT
#include "servo/safety/claim.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

namespace {

using Eigen::Vector3d;

/// The part of a force that another has too: a force may always shrink.
Vector3d nearestPart(const Vector3d& of, const Vector3d& to) noexcept HSP_RT {
  const double square = of.squaredNorm();
  if (!(square > 0)) return Vector3d::Zero();
  return std::clamp(to.dot(of) / square, 0.0, 1.0) * of;
}

}  // namespace

Vector3d Claim::judge(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) noexcept HSP_RT {
  const double asked = step.force.norm();
  const bool beyond = bounds.force > 0 && asked > bounds.force;
  Vector3d let = beyond ? Vector3d(step.force * (bounds.force / asked)) : step.force;
  passes_ = std::min(kPasses, passes_ + kPassesPerSecond * dt);
  held = false;
  Vector3d from = let;
  double follows = 1;  // the share of the change that explained_ goes along with
  if (known_ && (step.in & (HSP_IN_JUMP | HSP_IN_INVALID)) == 0) {
    const double moved = explained(step, bounds, dt), most = moved + std::max(kStep, bounds.jump);
    from = nearestPart(explained_, let);
    const Vector3d change = let - from;
    const double size = change.norm();
    held = size > most && !takePass(step);
    if (held) let = from + change * (most / size);
    if (held || (size <= most && size > moved + kDrift * dt)) follows = (moved + kDrift * dt) / std::min(size, most);
  }
  explained_ = from + std::min(1.0, follows) * (let - from);
  remember(step);
  return held ? let : step.force;
}

/// [N] How far the force may have changed by what the probe and the model did since the last step.
double Claim::explained(const ClaimStep& step, const ClaimBounds& bounds, double dt) noexcept HSP_RT {
  double way = (step.p_model - p_model_).norm(), speed = std::max(step.velocity.norm(), velocity_.norm());
  double change = (step.velocity - velocity_).norm();
  double turned = 0;
  if (step.turn != nullptr) {
    const Vector3d carried = *step.turn * explained_;
    turned = (carried - explained_).norm();
    if (!bounds.moves_itself) explained_ = carried;  // the host turned it
  }
  if (bounds.moves_itself) {
    const double own = (step.p_world - p_world_).norm();
    way = std::min(way, own + ownWay(step, dt));
    if (dt > 0) speed = std::min(speed, own / dt + kOwnSpeed);
    change = std::min(change, speed);
    turned = std::min(turned, kOwnTurn * dt * explained_.norm());
  }
  if (dt > 0) speed = std::max(speed, way / dt);
  const double stiffness = bounds.stiffness > 0 ? bounds.stiffness : kUnclaimed;
  return kMargin * stiffness * way + std::max(kDamping * change, kMargin * bounds.damping * speed) +
         (bounds.moves_itself ? turned : 0);
}

/// [m] How far the surface at the probe may have come by a pose that is the shape's own word: a body's speed along, and
/// a body's speed round, so that a model that spins in place explains next to nothing there.
double Claim::ownWay(const ClaimStep& step, double dt) const noexcept HSP_RT {
  const double along = std::min((step.origin - origin_).norm(), kOwnSpeed * dt);
  if (step.turn == nullptr) return along;
  const Vector3d arm = step.p_world - step.origin;
  return along + std::min((*step.turn * arm - arm).norm(), kOwnTurn * dt * arm.norm());
}

bool Claim::takePass(const ClaimStep& step) noexcept HSP_RT {
  if ((step.out & HSP_OUT_TRACED) == 0 || passes_ < 1) return false;
  if (traced_ && step.normal.dot(normal_) > std::cos(kEdge)) return false;
  passes_ -= 1;
  return true;
}

void Claim::remember(const ClaimStep& step) noexcept HSP_RT {
  known_ = (step.in & HSP_IN_INVALID) == 0;
  traced_ = (step.out & HSP_OUT_TRACED) != 0;
  p_world_ = step.p_world;
  p_model_ = step.p_model;
  velocity_ = step.velocity;
  normal_ = step.normal;
  origin_ = step.origin;
}

bool pullsIn(const hsp_contact& contact, const Vector3d& p) noexcept HSP_RT {
  constexpr double kSmallest = 1e-6, kRounding = 0.01;  // [m] to a foot that tells no direction; [N], and of the force
  if ((contact.flags & HSP_OUT_TRACED) == 0) return false;
  const Vector3d force(contact.force), out = Vector3d(contact.point) - p;
  const double depth = out.norm(), size = force.norm();
  if (!(depth > kSmallest) || !(size > kRounding)) return false;
  const double outward = contact.depth_m > 0 ? force.dot(out) : -force.dot(out);
  return outward < -kRounding * size * depth;
}

}  // namespace hapticd::servo
