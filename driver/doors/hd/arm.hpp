// SPDX-License-Identifier: MIT
/// An opened arm: its frames, its capabilities, and the force that is sent. The caller must hold Library::lock.
#pragma once
#include <cstdint>
#include <memory>

#include "errors.hpp"
#include "facts.hpp"
#include "link.hpp"
#include "motion.hpp"

namespace hapticd::hd {

/// A frame of the HDAPI: the state that was read at its beginning, and the force that the program has set in it. SI
/// units.
struct Frame {
  hapticd_state state{};
  double velocity[3] = {}, angular[3] = {};
  double force[3] = {}, torque[3] = {};  ///< [N], [N m]
  double joint_torque[6] = {};  ///< [N m] of turret, thigh, shin, gimbal; converted and added to force and torque
};

/// Bounds that the library checks. The daemon's limits do not depend on them.
struct Bounds {
  double velocity = 0;  ///< [mm/s] largest speed of the tip; 0 for no check
  double impulse = 0;   ///< [N] largest change of force from one frame to the next; 0 for no check
  double ramp = 0;      ///< [N/s] growth of the force after it was switched on
};

class Arm {
 public:
  explicit Arm(HHD handle, ErrorStack& errors) : handle_(handle), errors_(errors) {}

  void open(std::shared_ptr<Link> link, DeviceFacts facts);
  void close();
  bool isOpen() const { return link_ != nullptr; }
  bool alive() const { return isOpen() && link_->alive(); }
  const std::shared_ptr<Link>& link() const { return link_; }
  const DeviceFacts& facts() const { return facts_; }

  /// To be called when a tick of the scheduler begins. @param ns time of the beginning (CLOCK_MONOTONIC)
  void tick(const hapticd_state& state, uint64_t ns);
  /// To be called when a tick of the scheduler ends. Tells the servo that this program still runs, and which force to
  /// apply.
  void heartbeat(uint64_t ns);

  /// Begins a frame. @param scheduler_tick number of the current tick, or UINT64_MAX if the caller is not in a tick
  void begin(uint64_t scheduler_tick);
  /// Ends a frame. @param pushes true if the scheduler runs, so that it sends the force in the ticks that follow
  void end(uint64_t scheduler_tick, uint64_t ns, bool pushes);
  bool inFrame() const { return in_frame_; }
  Frame& frame() { return frame_; }
  const Frame& last() const { return last_; }
  /// Returns the daemon's present state, for a caller that is neither in a frame nor in a tick.
  const Frame& newest();

  static bool isCapability(HDenum capability);
  bool isEnabled(HDenum capability) const;
  /// Switches a capability on or off. @return false, and the reason in `why`, if there is no such capability or it is
  /// not available
  bool enable(HDenum capability, bool on, std::string& why);
  Bounds& bounds() { return bounds_; }
  bool forceOn() const { return isEnabled(HD_FORCE_OUTPUT); }
  bool knowsJacobian() const;                ///< true if joint torques can be turned into a force
  double motorTemperature(int joint) const;  ///< from 0 (ambient temperature) to 1 (the hottest that is allowed)
  bool first = false;                        ///< true if the arm was opened as the default device
  int32_t light = 0;                         ///< value of HD_USER_STATUS_LIGHT; no arm has this light

 private:
  void update(const hapticd_state& state);
  void refresh();
  void fillFrame(Frame& frame) const;
  void reportFault();
  void reportLimit(const double force[3]);
  HDerror checked(uint64_t ns, double force[3]) const;
  void addJointTorque(double force[3], double torque[3]) const;
  void answer(uint64_t tick, const double force[3], const double torque[3], uint64_t ns);

  HHD handle_;
  ErrorStack& errors_;
  std::shared_ptr<Link> link_;
  DeviceFacts facts_;
  Motion motion_;
  hapticd_state now_{};
  Frame frame_, last_, newest_;
  bool seen_ = false, in_frame_ = false, ended_ = false;
  uint64_t ended_in_ = 0, last_end_ns_ = 0, woke_ns_ = 0, force_since_ns_ = 0;
  uint64_t pushed_tick_ = 0;
  bool pushed_ = false;
  double held_force_[3] = {}, held_torque_[3] = {};
  uint32_t capabilities_ = 0, told_fault_ = 0;
  /// [s] time of the daemon at which the arm was first seen to be held; < 0 if the arm is not held
  double stopped_since_ = -1;
  /// true while the program asks for more force than the arm can exert, which was reported once
  bool told_limit_ = false;
  Bounds bounds_;
};

}  // namespace hapticd::hd
