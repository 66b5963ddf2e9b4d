// SPDX-License-Identifier: MIT
/// A plugin claims the largest stiffness and damping of its shape, and how far its force may jump on purpose. The
/// claims and the motion of the probe give a bound on the change of the force in one step. If the force changes by
/// more, only the part of the change within this bound reaches the hand. Forces are compared as vectors in the world
/// frame. If the host turned the model since the last step, the former force is turned with it first. Torques are
/// bounded by the same claims, as if the hand held a handle at the distance kHandle from the tip.
#pragma once
#include <Eigen/Core>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// The claims of a shape, from its report and its parameters.
struct ClaimBounds {
  double stiffness = 0;       ///< [N/m] 0: no claim, so kUnclaimed is used
  double damping = 0;         ///< [N s/m] largest damping
  double jump = 0;            ///< [N] largest jump on purpose; values below kStep count as kStep
  bool moves_itself = false;  ///< the shape reports its own pose; kOwnSpeed and kOwnTurn then apply
};

/// One answer of a shape to one probe, in the world frame unless a comment says otherwise. `normal` is only used if a
/// surface is traced; `p_world` and `origin` are only used if the shape moves itself.
struct ClaimStep {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< [N] force on the probe
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< outward unit normal, if a surface is traced
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();   ///< [m] position of the probe
  Eigen::Vector3d p_model = Eigen::Vector3d::Zero();   ///< [m] the probe in the frame of the model, after the step
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s] relative to the model; zero if the shape uses none
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< [m] origin of the model, after the step
  /// rotation of the model since its last step, world frame; nullptr if the model does not move
  const Eigen::Matrix3d* turn = nullptr;
  /// [N] largest force that the arm lets through, 0: unknown; a larger force is reduced to this value before the check
  double max_force = 0;
  uint32_t in = 0, out = 0;  ///< HSP_IN_*, HSP_OUT_*
  // Only checkTorque() uses these.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] torque on the probe
  /// Orientation x y z w of the probe in the world; constant if the shape does not use the orientation.
  Eigen::Vector4d orientation = Eigen::Vector4d::UnitW();
  /// [N m] largest torque that the arm lets through, 0: unknown; a larger torque is reduced to this value before the
  /// check
  double max_torque = 0;
  bool former = false;  ///< for old recordings: kFindsAnew is not used
};

/// Bounds the force and torque of one model on one probe, and remembers the last step.
class Claim {
 public:
  /// factor on claims, because contact laws are steeper in places than their authors think
  static constexpr double kMargin = 10;
  static constexpr double kStep = 2;          ///< [N] a force may always jump by this much, as for a click
  static constexpr double kUnclaimed = 2000;  ///< [N/m] stiffness that is assumed if none is claimed
  /// [N s/m] damping that every shape may have without a claim, because friction and inertia act like damping
  static constexpr double kDamping = 100;
  static constexpr double kDrift = 100;   ///< [N/s] a force may always change at this rate
  static constexpr double kOwnSpeed = 5;  ///< [m/s] highest speed that is believed of a shape that moves itself
  static constexpr double kOwnTurn = 50;  ///< [rad/s] highest angular velocity that is believed of such a shape
  /// The force may change by any amount if a surface is newly found under the probe, or if the foot point goes over an
  /// edge. kPasses such changes may come in a row. After that, kPassesPerSecond of them are allowed per second.
  static constexpr double kPasses = 3, kPassesPerSecond = 20;
  /// Of these changes, so many may come in a row, and then so many per second, that push against the one before: a
  /// surface rests, and a hand comes from one side of it to the other no more often.
  static constexpr double kTurns = 2, kTurnsPerSecond = 3;
  /// [rad] if the normal turns by more than this in one step, the foot point went over an edge
  static constexpr double kEdge = 0.1;
  /// if a change is smaller than this share of the change that the stiffness explains, the other checks are skipped
  static constexpr double kSurely = 0.99;
  /// [m] Assumed distance from the tip to the point at which the hand holds the handle. With this lever, the bound on
  /// forces becomes a bound on torques.
  static constexpr double kHandle = 0.1;
  /// The force may change by any amount in the step after a live parameter was set with consent (HSP_P_SAFETY). kAsked
  /// such changes may come in a row. After that, kAskedPerSecond of them are allowed per second, because a program that
  /// sets parameters in every tick must not allow a plugin to kick.
  static constexpr double kAsked = 3, kAskedPerSecond = 2;
  /// [s] After a live parameter was set, a large change of the force is let through slowly. For at most this time,
  /// holding it back is not counted against the plugin (Guard::strike()).
  static constexpr double kExcused = 1;
  /// [s] After a jump of the probe or a bad sample, the search finds the surface again some ticks later. For this time
  /// the force may rise at once even if the normal has not turned, and the plugin is not blamed if its force is held
  /// back.
  static constexpr double kFindsAnew = 0.1;

  /// [rt] Returns the force of `step`, or the part of it that the claim allows, world frame.
  /// @param dt [s] since the last step  @param held becomes true if the force was held back
  Eigen::Vector3d check(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) noexcept HSP_RT;

  /// [rt] Like check(), but for the torque of `step`. Call it before check(), because check() replaces the position of
  /// the probe in the last step, which both need.
  Eigen::Vector3d checkTorque(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) noexcept HSP_RT;

  /// [rt] Somebody set a live parameter of the model. In the next step the force may change without an explanation: at
  /// once if the person at the arm agreed, else slowly.
  void expectChange(bool consented) noexcept HSP_RT {
    asked_ = true;
    consented_ = consented_ || consented;
  }

  /// [rt] True if a change that was held back is not the plugin's fault, because somebody set a parameter or the probe
  /// jumped.
  bool excused() const noexcept HSP_RT { return excused_ > 0 || finds_anew_ > 0; }

  /// [any] Forgets the last step, so that any force is allowed in the next step.
  void forget() noexcept { known_ = torque_known_ = false; }

 private:
  /// How large a change may be, [N] or [N m].
  struct ChangeBounds {
    double moved;  ///< part that motion explains
    double jump;   ///< jump that is allowed in addition
    double drift;  ///< slow change that is always allowed in this step
  };
  double holdBack(Eigen::Vector3d& let, const Eigen::Vector3d& from, const Eigen::Vector3d& change,
                  const ChangeBounds& room, const ClaimStep& step, double dt, bool& held) noexcept HSP_RT;
  bool mayJump(const ClaimStep& step) noexcept HSP_RT;
  double angle(const ClaimStep& step, const ClaimBounds& bounds) const noexcept HSP_RT;
  bool surelyExplained(double square, const ClaimStep& step, const ClaimBounds& bounds) const noexcept HSP_RT;
  static double turn(Eigen::Vector3d& explained, const Eigen::Matrix3d& turn, const ClaimBounds& bounds,
                     double dt) noexcept HSP_RT;
  double explained(const ClaimStep& step, const ClaimBounds& bounds, double dt) const noexcept HSP_RT;
  double ownMotion(const ClaimStep& step, double dt) const noexcept HSP_RT;
  bool takePass(const ClaimStep& step) noexcept HSP_RT;
  void remember(const ClaimStep& step, const ClaimBounds& bounds) noexcept HSP_RT;

  bool known_ = false, traced_ = false;
  bool torque_known_ = false;
  // asked_: a parameter was set before this step. consented_: by the person at the arm. jumps_: force and torque may
  // jump in this step
  bool asked_ = false, consented_ = false, jumps_ = false;
  double passes_ = kPasses, turns_ = kTurns, asked_passes_ = kAsked;
  double excused_ = 0, finds_anew_ = 0;  // [s] time that is left of kExcused, and of kFindsAnew
  // [N], [N m] the force and the torque that the last pass let through
  Eigen::Vector3d passed_ = Eigen::Vector3d::Zero(), passed_torque_ = Eigen::Vector3d::Zero();
  /// [N] The force that motion explains, world frame. The force that check() returns differs from this force by at most
  /// one jump.
  Eigen::Vector3d explained_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_world_ = Eigen::Vector3d::Zero(), p_model_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), normal_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d explained_torque_ = Eigen::Vector3d::Zero();  // [N m] like explained_
  Eigen::Vector4d orientation_ = Eigen::Vector4d::UnitW();
};

/// A force that broke the claims of a shape: a pull, although it claims to push only, or the largest jump.
struct Breach {
  double t = -1;      ///< [s] time since the start of the run; negative: unknown
  double depth = -1;  ///< [m] depth that the shape reported; negative: unknown or outside
  double force = 0;   ///< [N] force of the pull, or size of the jump
};

/// [rt] True if the force of a contact pulls the probe deeper in, or from outside toward the surface. A pull as small
/// as a rounding error does not count. The outward direction is calculated from the foot point, not taken from the
/// reported normal. @param p [m] the probe, in the model frame
bool pullsIn(const hsp_contact& contact, const Eigen::Vector3d& p) noexcept HSP_RT;

}  // namespace hapticd::servo
