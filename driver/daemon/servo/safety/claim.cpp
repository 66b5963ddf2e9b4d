// SPDX-License-Identifier: MIT
#include "servo/safety/claim.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

namespace {

using Eigen::Vector3d;

/// Returns the point between zero and the force `of` that is nearest to the force `to`. The change of the force is
/// counted from this point, because a force may always shrink.
Vector3d nearestPart(const Vector3d& of, const Vector3d& to) noexcept HSP_RT {
  const double square = of.squaredNorm();
  if (!(square > 0)) return Vector3d::Zero();
  return std::clamp(to.dot(of) / square, 0.0, 1.0) * of;
}

/// Returns the largest stiffness [N/m] that a contact law may have at its steepest place.
double stiffnessOf(const ClaimBounds& bounds) noexcept HSP_RT {
  return Claim::kMargin * (bounds.stiffness > 0 ? bounds.stiffness : Claim::kUnclaimed);
}

}  // namespace

Vector3d Claim::check(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) noexcept HSP_RT {
  Vector3d let = step.force;
  // Compares squares, so that most ticks need no square root.
  if (const double most = step.max_force, square = let.squaredNorm(); most > 0 && square > most * most)
    let *= most / std::sqrt(square);
  passes_ = std::min(kPasses, passes_ + kPassesPerSecond * dt);
  turns_ = std::min(kTurns, turns_ + kTurnsPerSecond * dt);
  asked_passes_ = std::min(kAsked, asked_passes_ + kAskedPerSecond * dt);
  excused_ -= dt;
  finds_anew_ -= dt;
  held = false;
  Vector3d from = let;
  double follows = 1;  // share of the change by which explained_ moves toward the new force
  if (known_ && (step.in & (HSP_IN_JUMP | HSP_IN_INVALID)) == 0) {
    const double turned = step.turn != nullptr ? turn(explained_, *step.turn, bounds, dt) : 0;
    from = nearestPart(explained_, let);
    const Vector3d change = let - from;
    const double square = change.squaredNorm();
    if (!surelyExplained(square, step, bounds)) {
      const ChangeBounds room{explained(step, bounds, dt) + turned, std::max(kStep, bounds.jump), kDrift * dt};
      follows = holdBack(let, from, change, room, step, dt, held);
    }
  }
  explained_ = follows < 1 ? Vector3d(from + follows * (let - from)) : Vector3d(from + (let - from));
  remember(step, bounds);
  return held ? let : step.force;
}

/// True if the stiffness alone explains a change of this square [N^2], as in nearly every tick of a contact; the other
/// checks are then skipped. It compares squares, with a margin for rounding.
bool Claim::surelyExplained(double square, const ClaimStep& step, const ClaimBounds& bounds) const noexcept HSP_RT {
  if (bounds.moves_itself) return false;
  const double per_metre = kSurely * stiffnessOf(bounds);
  return square <= per_metre * per_metre * (step.p_model - p_model_).squaredNorm();
}

/// Moves `let` back toward `from` until the change fits `room`. @return the share of the change by which the explained
/// force moves toward the new one
double Claim::holdBack(Vector3d& let, const Vector3d& from, const Vector3d& change, const ChangeBounds& room,
                       const ClaimStep& step, double dt, bool& held) noexcept HSP_RT {
  const double size = change.norm(), most = room.moved + room.jump, follows = room.moved + room.drift;
  held = size > most && !mayJump(step);
  if (held) let = from + change * (most / size);
  if (!held && (size > most || size <= follows)) return 1;
  // A change after a set parameter is let through slowly. Until it is complete, the plugin is not at fault.
  if (asked_ && dt > 0) excused_ = std::max(excused_, std::min(kExcused, size / room.drift * dt));
  return follows / std::min(size, most);
}

/// True if force and torque may change in this step without an explanation. Each such step uses up one allowed change.
bool Claim::mayJump(const ClaimStep& step) noexcept HSP_RT {
  jumps_ = jumps_ || takePass(step);
  if (jumps_ || !consented_ || asked_passes_ < 1) return jumps_;
  asked_passes_ -= 1;
  return jumps_ = true;
}

/// Returns the change [N] or [N m] that the turn of the model since the last step explains. If the host turns the
/// model, the explained force turns with it, and the result is 0. If the shape turns itself, the result is bounded.
double Claim::turn(Vector3d& explained, const Eigen::Matrix3d& turn, const ClaimBounds& bounds,
                   double dt) noexcept HSP_RT {
  const Vector3d carried = turn * explained;
  if (bounds.moves_itself) return std::min((carried - explained).norm(), kOwnTurn * dt * explained.norm());
  explained = carried;
  return 0;
}

/// Returns the largest change [N] of the force that the motion of probe and model since the last step explains.
double Claim::explained(const ClaimStep& step, const ClaimBounds& bounds, double dt) const noexcept HSP_RT {
  double moved = (step.p_model - p_model_).norm(), speed = std::max(step.velocity.norm(), velocity_.norm());
  double change = (step.velocity - velocity_).norm();
  if (bounds.moves_itself) {
    const double own = (step.p_world - p_world_).norm();
    moved = std::min(moved, own + ownMotion(step, dt));
    if (dt > 0) speed = std::min(speed, own / dt + kOwnSpeed);
    change = std::min(change, speed);
  }
  if (dt > 0) speed = std::max(speed, moved / dt);
  return stiffnessOf(bounds) * moved + std::max(kDamping * change, kMargin * bounds.damping * speed);
}

/// Returns how far [m] the surface at the probe may have moved by the pose that the shape reports. It is bounded by
/// kOwnSpeed and kOwnTurn, so that a model that spins about the probe explains next to nothing.
double Claim::ownMotion(const ClaimStep& step, double dt) const noexcept HSP_RT {
  const double along = std::min((step.origin - origin_).norm(), kOwnSpeed * dt);
  if (step.turn == nullptr) return along;
  const Vector3d arm = step.p_world - step.origin;
  return along + std::min((*step.turn * arm - arm).norm(), kOwnTurn * dt * arm.norm());
}

bool Claim::takePass(const ClaimStep& step) noexcept HSP_RT {
  if ((step.out & HSP_OUT_TRACED) == 0 || passes_ < 1) return false;
  if (traced_ && !(finds_anew_ > 0) && step.normal.dot(normal_) > std::cos(kEdge)) return false;
  const bool turns = step.force.dot(passed_) < 0 || step.torque.dot(passed_torque_) < 0;
  if (turns && !step.former) {
    if (turns_ < 1) return false;
    turns_ -= 1;
  }
  passes_ -= 1;
  passed_ = step.force;
  passed_torque_ = step.torque;
  return true;
}

/// Remembers only the values that the next step needs, because it runs for each shape, probe and tick.
void Claim::remember(const ClaimStep& step, const ClaimBounds& bounds) noexcept HSP_RT {
  known_ = (step.in & HSP_IN_INVALID) == 0;
  asked_ = consented_ = jumps_ = false;
  if ((step.in & (HSP_IN_JUMP | HSP_IN_INVALID)) != 0 && !step.former) finds_anew_ = kFindsAnew;
  traced_ = (step.out & HSP_OUT_TRACED) != 0;
  p_model_ = step.p_model;
  velocity_ = step.velocity;
  if (traced_) normal_ = step.normal;
  if (!bounds.moves_itself) return;
  p_world_ = step.p_world;
  origin_ = step.origin;
}

/// Bounds torques like forces: on a handle of length l, a stiffness k gives k l^2 per radian, and a jump f of the force
/// gives a jump f l of the torque.
Vector3d Claim::checkTorque(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) noexcept HSP_RT {
  Vector3d let = step.torque;
  if (const double size = let.norm(); step.max_torque > 0 && size > step.max_torque) let *= step.max_torque / size;
  held = false;
  Vector3d from = let;
  double follows = 1;  // share of the change by which explained_torque_ moves toward the new torque
  if (torque_known_ && (step.in & (HSP_IN_JUMP | HSP_IN_INVALID)) == 0) {
    const double turned = step.turn != nullptr ? turn(explained_torque_, *step.turn, bounds, dt) : 0;
    from = nearestPart(explained_torque_, let);
    const double round = angle(step, bounds), speed = dt > 0 ? round / dt : 0;
    const double moved =
        explained(step, bounds, dt) + kHandle * (stiffnessOf(bounds) * round + kMargin * bounds.damping * speed);
    const ChangeBounds room{kHandle * moved + turned, kHandle * std::max(kStep, bounds.jump), kHandle * kDrift * dt};
    follows = holdBack(let, from, let - from, room, step, dt, held);
  }
  explained_torque_ = from + follows * (let - from);
  torque_known_ = (step.in & HSP_IN_INVALID) == 0;
  orientation_ = step.orientation;
  return held ? let : step.torque;
}

/// Returns by how much [rad] the probe turned in the frame of the model since the last step. It is never overestimated.
/// A turn that the shape itself reports does not count here: explained() covers the motion of its surface.
double Claim::angle(const ClaimStep& step, const ClaimBounds& bounds) const noexcept HSP_RT {
  // [rad] an angle of up to half a turn, divided by the distance between the quaternions
  constexpr double kOfChord = 2.3;
  constexpr double kOfMatrix = 0.72;  // [rad] a small angle, divided by the distance between the rotation matrices
  const double chord = std::min((step.orientation - orientation_).norm(), (step.orientation + orientation_).norm());
  const bool carried = step.turn != nullptr && !bounds.moves_itself;
  return kOfChord * chord + (carried ? kOfMatrix * (*step.turn - Eigen::Matrix3d::Identity()).norm() : 0);
}

bool pullsIn(const hsp_contact& contact, const Vector3d& p) noexcept HSP_RT {
  // [m] A nearer foot gives no direction. [N] A smaller force is rounding, and so is a smaller share of a force.
  constexpr double kSmallest = 1e-6, kRounding = 0.01;
  if ((contact.flags & HSP_OUT_TRACED) == 0) return false;
  const Vector3d force(contact.force), out = Vector3d(contact.point) - p;
  const double outward = contact.depth_m > 0 ? force.dot(out) : -force.dot(out);
  if (!(outward < 0)) return false;  // the force pushes outward, as nearly always
  const double depth = out.norm(), size = force.norm();
  return depth > kSmallest && size > kRounding && outward < -kRounding * size * depth;
}

}  // namespace hapticd::servo
