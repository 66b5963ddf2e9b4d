// SPDX-License-Identifier: MIT
/// A plugin claims how stiff its shape is at most, how much it damps, and how far its force may jump on purpose. These
/// claims and the motion of the probe bound the change of the force. A force that changes by more is let through only
/// as far as the bound. Forces are compared as vectors in the world frame, after every rotation, whether the model is
/// traced or not. So are torques: by the same numbers, at the length of a handle.
#pragma once
#include <Eigen/Core>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// What a shape may do to a probe, from its report and its parameters.
struct ClaimBounds {
  double stiffness = 0;       ///< [N/m] 0: nothing was claimed, so kUnclaimed holds
  double damping = 0;         ///< [N s/m]
  double jump = 0;            ///< [N] jumps on purpose; at least kStep
  bool moves_itself = false;  ///< it reports its own pose, which explains only so much
};

/// One answer of a shape to one probe, in the world frame unless a comment says otherwise. `normal` is used if a
/// surface is traced, `p_world` and `origin` if the shape moves itself.
struct ClaimStep {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< [N]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< outward, if a surface is traced
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();   ///< [m] the probe
  Eigen::Vector3d p_model = Eigen::Vector3d::Zero();   ///< [m] the same in the frame of the model, after the step
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s] relative to the model; zero if it asks for none
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< [m] of the model, after the step
  const Eigen::Matrix3d* turn = nullptr;               ///< of the model since its last step; nullptr: it does not turn
  double max_force = 0;      ///< [N] that the arm lets through; 0: unknown. Larger forces are not compared.
  uint32_t in = 0, out = 0;  ///< HSP_IN_*, HSP_OUT_*
  // Only judgeTorque() uses these.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] on the probe
  /// x y z w of the probe in the world; constant if the shape does not read how the probe is turned.
  Eigen::Vector4d orientation = Eigen::Vector4d::UnitW();
  double max_torque = 0;  ///< [N m] that the arm lets through; 0: unknown. Larger torques are not compared.
  bool former = false;    ///< as formerly, a jump of the probe excuses nothing
};

/// What is remembered for one model and one probe.
class Claim {
 public:
  static constexpr double kMargin = 10;       ///< laws of contact are steeper in places than their authors think
  static constexpr double kStep = 2;          ///< [N] a click may come as suddenly as this
  static constexpr double kUnclaimed = 2000;  ///< [N/m] used where nothing is claimed
  static constexpr double kDamping = 100;     ///< [N s/m] allowed to every shape: friction and inertia act like it
  static constexpr double kDrift = 100;       ///< [N/s] by which a force may change with nothing to explain it
  static constexpr double kOwnSpeed = 5;      ///< [m/s] speed of a surface that moves itself
  static constexpr double kOwnTurn = 50;      ///< [rad/s] the same
  /// A surface that is found anew under the probe, or a foot that goes over an edge, changes the force at once.
  /// kPasses such changes may come together, and kPassesPerSecond per second.
  static constexpr double kPasses = 3, kPassesPerSecond = 20;
  static constexpr double kEdge = 0.1;     ///< [rad] a normal that turns farther in one step has crossed an edge
  static constexpr double kSurely = 0.99;  ///< share of what stiffness explains: a smaller change needs no second look
  /// [m] distance from the tip to where a hand holds the handle, which turns a force into a torque.
  static constexpr double kHandle = 0.1;
  /// A live parameter that somebody set may change the force at once: kAsked such changes may come together, and
  /// kAskedPerSecond per second. A program that sets one in every tick must not let a plugin kick.
  static constexpr double kAsked = 3, kAskedPerSecond = 2;
  static constexpr double kExcused = 1;  ///< [s] for which a change that was asked for may be held back without blame
  /// [s] After a jump of the probe or a bad sample the search finds the surface anew some ticks later. The force may
  /// then come at once, whatever the normal was, and the plugin is not blamed for what is held back.
  static constexpr double kFindsAnew = 0.1;

  /// [rt] How much of the force of `step` may pass, world frame: all of it, or what the claim explains.
  /// @param dt [s] since the last step  @param held true if the force was held back
  Eigen::Vector3d judge(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) noexcept HSP_RT;

  /// [rt] The same for the torque of `step`. Call it before judge(), which remembers where the probe was.
  Eigen::Vector3d judgeTorque(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) noexcept HSP_RT;

  /// [rt] Somebody set a live parameter of the model: in the next step the force may change with nothing to explain it.
  void expectChange() noexcept HSP_RT { asked_ = true; }

  /// [rt] True if somebody asked for what was held back in the last step, or the probe jumped, so that the plugin is
  /// not at fault.
  bool excused() const noexcept HSP_RT { return excused_ > 0 || finds_anew_ > 0; }

  /// [any] Compares the next step with nothing.
  void forget() noexcept { known_ = torque_known_ = false; }

 private:
  /// What may become of a change, [N] or [N m].
  struct Room {
    double moved;  ///< that motion explains
    double jump;   ///< beyond it
    double drift;  ///< allowed in this step, with nothing to explain it
  };
  double holdBack(Eigen::Vector3d& let, const Eigen::Vector3d& from, const Eigen::Vector3d& change, const Room& room,
                  const ClaimStep& step, double dt, bool& held) noexcept HSP_RT;
  bool mayJump(const ClaimStep& step) noexcept HSP_RT;
  double angle(const ClaimStep& step, const ClaimBounds& bounds) const noexcept HSP_RT;
  bool surelyExplained(double square, const ClaimStep& step, const ClaimBounds& bounds) const noexcept HSP_RT;
  static double turn(Eigen::Vector3d& explained, const Eigen::Matrix3d& turn, const ClaimBounds& bounds,
                     double dt) noexcept HSP_RT;
  double explained(const ClaimStep& step, const ClaimBounds& bounds, double dt) const noexcept HSP_RT;
  double ownWay(const ClaimStep& step, double dt) const noexcept HSP_RT;
  bool takePass(const ClaimStep& step) noexcept HSP_RT;
  void remember(const ClaimStep& step, const ClaimBounds& bounds) noexcept HSP_RT;

  bool known_ = false, traced_ = false;
  bool torque_known_ = false;
  bool asked_ = false, jumps_ = false;  // in this step: a parameter was set; a jump was allowed
  double passes_ = kPasses, asked_passes_ = kAsked;
  double excused_ = 0, finds_anew_ = 0;  // [s] for which that still holds
  /// [N] The force that motion explains, world frame: the force that passes is never farther from it than a jump.
  Eigen::Vector3d explained_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_world_ = Eigen::Vector3d::Zero(), p_model_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), normal_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d explained_torque_ = Eigen::Vector3d::Zero();  // [N m] as explained_
  Eigen::Vector4d orientation_ = Eigen::Vector4d::UnitW();
};

/// A pull by a surface that reported that it only pushes.
struct Pull {
  double t = -1;      ///< [s] since the start of the run; negative: unknown
  double depth = -1;  ///< [m] as the shape reported it; negative: unknown, or outside
  double force = 0;   ///< [N]
};

/// [rt] True if the force of a contact pulls the probe deeper in, or toward the surface from outside, by more than
/// rounding. Model frame. @param p where the probe is. The foot tells the way out, not the normal that the shape names.
bool pullsIn(const hsp_contact& contact, const Eigen::Vector3d& p) noexcept HSP_RT;

}  // namespace hapticd::servo
