// SPDX-License-Identifier: MIT
/// An opened arm: its frames, its capabilities, and the force that goes out. The caller holds the library's lock.
#pragma once
#include <cstdint>
#include <memory>

#include "errors.hpp"
#include "facts.hpp"
#include "link.hpp"
#include "motion.hpp"

namespace hapticd::hd {

/// What a frame read and asked for, in SI units.
struct Frame {
  hapticd_state state{};
  double velocity[3] = {}, angular[3] = {};
  double force[3] = {}, torque[3] = {};  ///< [N], [N m]
  double joint_torque[6] = {};           ///< [N m] of turret, thigh, shin and gimbal; added to force and torque
};

/// Bounds that the library itself checks; the daemon has its own, which do not depend on these.
struct Bounds {
  double velocity = 0;  ///< [mm/s] 0: not checked
  double impulse = 0;   ///< [N] from one frame to the next; 0: not checked
  double ramp = 0;      ///< [N/s]
};

class Arm {
 public:
  explicit Arm(HHD handle, ErrorStack& errors) : handle_(handle), errors_(errors) {}

  void open(std::shared_ptr<Link> link, Facts facts);
  void close();
  bool isOpen() const { return link_ != nullptr; }
  bool alive() const { return isOpen() && link_->alive(); }
  const std::shared_ptr<Link>& link() const { return link_; }
  const Facts& facts() const { return facts_; }

  /// A tick of the scheduler begins. @param ns CLOCK_MONOTONIC
  void tick(const hapticd_state& state, uint64_t ns);
  /// The tick ends: the servo hears that this program lives, and which force holds.
  void heartbeat(uint64_t ns);

  /// @param scheduler_tick number of the current tick; UINT64_MAX: the caller is in none
  void begin(uint64_t scheduler_tick);
  /// @param pushes the scheduler runs, so that somebody continues the force
  void end(uint64_t scheduler_tick, uint64_t ns, bool pushes);
  bool inFrame() const { return in_frame_; }
  Frame& frame() { return frame_; }
  const Frame& last() const { return last_; }
  /// The daemon's present state, for a reader that is in no frame and no tick.
  const Frame& newest();

  static bool isCapability(HDenum capability);
  bool isEnabled(HDenum capability) const;
  /// @return false if there is no such capability, or it is not available
  bool enable(HDenum capability, bool on, std::string& why);
  Bounds& bounds() { return bounds_; }
  bool forceOn() const { return isEnabled(HD_FORCE_OUTPUT); }
  bool knowsJacobian() const;                ///< joint torques can be turned into a force
  double motorTemperature(int joint) const;  ///< 0 cold to 1 as hot as it may get
  bool first = false;                        ///< opened as the default device
  int32_t light = 0;                         ///< HD_USER_STATUS_LIGHT, which no arm has

 private:
  void look(const hapticd_state& state);
  void refresh();
  void see(Frame& frame) const;
  void reportFault();
  void tellOfLimit(const double force[3]);
  HDerror checked(uint64_t ns, double force[3]) const;
  void addJointTorque(double force[3], double torque[3]) const;
  void answer(uint64_t tick, const double force[3], const double torque[3], uint64_t ns);

  HHD handle_;
  ErrorStack& errors_;
  std::shared_ptr<Link> link_;
  Facts facts_;
  Motion motion_;
  hapticd_state now_{};
  Frame frame_, last_, newest_;
  bool seen_ = false, in_frame_ = false, ended_ = false;
  uint64_t ended_in_ = 0, last_end_ns_ = 0, woke_ns_ = 0, force_since_ns_ = 0;
  uint64_t pushed_tick_ = 0;
  bool pushed_ = false;
  double held_force_[3] = {}, held_torque_[3] = {};
  uint32_t capabilities_ = 0, told_fault_ = 0;
  double stopped_since_ = -1;  ///< [s] of the daemon's time; < 0: the arm is not held
  bool told_limit_ = false;    ///< that the program asks for more than the arm's force was reported
  Bounds bounds_;
};

}  // namespace hapticd::hd
