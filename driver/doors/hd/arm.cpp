// SPDX-License-Identifier: MIT
#include "arm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coordinates.hpp"
#include "joint_torque.hpp"
#include "units.hpp"

namespace hapticd::hd {

namespace {

constexpr uint64_t kHoldNs = 100'000'000;  ///< [ns] a force ends this long after the frame that set it

constexpr HDenum kCapabilities[] = {HD_FORCE_OUTPUT, HD_MAX_FORCE_CLAMPING, HD_FORCE_RAMPING, HD_SOFTWARE_FORCE_LIMIT,
                                    HD_ONE_FRAME_LIMIT};

uint32_t bitOf(HDenum capability) {
  const auto found = std::find(std::begin(kCapabilities), std::end(kCapabilities), capability);
  return found != std::end(kCapabilities) ? 1u << (found - std::begin(kCapabilities)) : 0;
}

/// Values of hapticd_state.fault. kStopped: the arm is held, or the daemon ends.
constexpr uint32_t kNone = 0, kDeviceLost = 2, kDeviceFault = 3, kStale = 4, kUncalibrated = 7, kStopped = 8;

/// Returns the HDAPI's error for the daemon's reason for withholding a force (hapticd_state.fault), or HD_SUCCESS if
/// there is nothing to report.
HDerror errorOf(uint32_t fault) {
  constexpr uint32_t kTooFast = 5, kOverheated = 10;
  switch (fault) {
    case kNone:
      return HD_SUCCESS;
    case kStopped:
      return HD_FORCE_ERROR;
    case kDeviceLost:
    case kStale:
      return HD_COMM_ERROR;
    case kTooFast:
      return HD_EXCEEDED_MAX_VELOCITY;
    case kOverheated:
      return HD_WARM_MOTORS;
    default:
      return HD_DEVICE_FAULT;
  }
}

constexpr const char* kFrameIsUsed =
    "a frame was refused: HD_ONE_FRAME_LIMIT allows one frame of a device in a tick, and another callback, "
    "or an earlier frame of this one, has used it (0x0400; the hdEndFrame that follows gets 0x0401)\n"
    "  fix: let the first callback of a tick call hdBeginFrame, the last one hdEndFrame, "
    "and all others only get and set in between; or call hdDisable(HD_ONE_FRAME_LIMIT)";

std::string hintOf(const std::string& arm, uint32_t fault) {
  if (fault == kStopped)
    return "the arm " + arm +
           " is held, so it gives no force\n  fix: hapticd ctl clear, after the person who holds the arm has agreed";
  const bool ends = fault == kDeviceLost || fault == kDeviceFault || fault == kStale || fault == kUncalibrated;
  return "the arm " + arm + (fault == kDeviceLost ? " is lost" : " is at fault (" + std::to_string(fault) + ")") +
         ", so it gives no force\n  fix: hapticd ctl status says what it is; " +
         (ends ? "the force comes back by itself once the arm works" : "hapticd ctl clear lets the force come back");
}

double sizeOf(const double v[3]) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

bool allFinite(const double v[3]) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

void scaleTo(double v[3], double most) {
  const double size = sizeOf(v);
  if (size > most)
    for (int i = 0; i < 3; ++i) v[i] *= most / size;
}

}  // namespace

void Arm::open(std::shared_ptr<Link> link, DeviceFacts facts) {
  // [s] time in which a force that is switched on grows from zero to the largest force.
  constexpr double kRampTime = 0.05;
  link_ = std::move(link);
  facts_ = std::move(facts);
  motion_ = {};
  frame_ = last_ = {};
  ended_ = pushed_ = seen_ = false;  // the daemon may be a new one; a frame that is open now can still be ended
  told_fault_ = 0, stopped_since_ = -1, told_limit_ = false;
  std::fill_n(held_force_, 3, 0.0), std::fill_n(held_torque_, 3, 0.0);
  capabilities_ = bitOf(HD_MAX_FORCE_CLAMPING) | bitOf(HD_FORCE_RAMPING) | bitOf(HD_SOFTWARE_FORCE_LIMIT) |
                  bitOf(HD_ONE_FRAME_LIMIT);
  bounds_ = {0, 0, facts_.max_force / kRampTime};
  refresh();
  fillFrame(frame_);
}

void Arm::close() {
  link_.reset();  // the connection ends with its last owner, and the force ends with the connection
  in_frame_ = false;
  capabilities_ = 0;
}

/// Takes a new state of the arm, unless another thread has already taken a newer one.
void Arm::update(const hapticd_state& state) {
  if (seen_ && state.tick <= now_.tick) return;
  seen_ = true;
  now_ = state;
  toProgram(facts_, now_);
  motion_.add(now_);
}

void Arm::tick(const hapticd_state& state, uint64_t ns) {
  update(state);
  woke_ns_ = ns;
}

void Arm::refresh() {
  hapticd_state state;
  if (isOpen() && link_->next(UINT64_MAX, 0, state) == 1) update(state);
}

/// A new frame begins with the force of the last frame.
const Frame& Arm::newest() {
  refresh();
  newest_ = frame_;
  fillFrame(newest_);
  return newest_;
}

void Arm::fillFrame(Frame& frame) const {
  frame.state = now_;
  if (facts_.pushable)  // the daemon estimates a velocity for programs that push
    std::copy_n(now_.velocity, 3, frame.velocity);
  else
    motion_.velocity(frame.velocity);
  motion_.angularVelocity(frame.angular);
}

void Arm::begin(uint64_t scheduler_tick) {
  if (in_frame_) return;
  if (scheduler_tick != UINT64_MAX && ended_ && ended_in_ == scheduler_tick && isEnabled(HD_ONE_FRAME_LIMIT)) {
    hintOnce(kFrameIsUsed);
    return errors_.push(HD_ILLEGAL_BEGIN, handle_);
  }
  last_ = frame_;
  if (scheduler_tick == UINT64_MAX) refresh();
  frame_ = {};
  fillFrame(frame_);
  in_frame_ = true;
  reportFault();
}

void Arm::reportFault() {
  const uint32_t fault = now_.fault;
  if (fault != kStopped) stopped_since_ = -1;
  if (fault == told_fault_) return;
  // A daemon that ends ramps its forces out, which looks like a hold. The scheduler reports that the daemon has gone.
  constexpr double kEnds = 0.25;  // [s] a hold that lasts longer than this is not the end of a daemon
  if (fault == kStopped && stopped_since_ < 0) stopped_since_ = now_.t;
  if (fault == kStopped && now_.t - stopped_since_ < kEnds) return;
  told_fault_ = fault;
  if (fault != kNone) hintOnce(keptForever(hintOf(facts_.name, fault)));
  if (const HDerror error = errorOf(fault); error != HD_SUCCESS) errors_.push(error, handle_, static_cast<int>(fault));
}

void Arm::end(uint64_t scheduler_tick, uint64_t ns, bool pushes) {
  if (!in_frame_) return errors_.push(HD_ILLEGAL_END, handle_);
  in_frame_ = false;
  ended_ = scheduler_tick != UINT64_MAX;
  ended_in_ = scheduler_tick;
  if (pushes && forceOn() && force_since_ns_ == 0) force_since_ns_ = ns;
  double force[3], torque[3];
  std::copy_n(frame_.force, 3, force), std::copy_n(frame_.torque, 3, torque);
  addJointTorque(force, torque);
  reportLimit(force);
  if (const HDerror error = checked(ns, force); error != HD_SUCCESS) {
    errors_.push(error, handle_);
    std::fill_n(force, 3, 0.0);
  }
  if (facts_.output_dof <= 3 || !allFinite(torque)) std::fill_n(torque, 3, 0.0);
  std::copy_n(force, 3, held_force_), std::copy_n(torque, 3, held_torque_);
  last_end_ns_ = ns;
  if (pushes && forceOn()) answer(frame_.state.tick, force, torque, ns);
}

bool Arm::knowsJacobian() const {
  hapticd_jacobian jacobian;
  return isOpen() && link_->jacobian(jacobian);
}

void Arm::addJointTorque(double force[3], double torque[3]) const {
  const double* of_joint = frame_.joint_torque;
  if (std::all_of(of_joint, of_joint + std::size(frame_.joint_torque), [](double t) { return t == 0; })) return;
  hapticd_jacobian jacobian;
  if (!link_ || !link_->jacobian(jacobian)) return;
  double more_force[3], more_torque[3];
  wrenchOf(facts_, jacobian, of_joint, more_force, more_torque);
  fromWorld(facts_, more_force), fromWorld(facts_, more_torque);
  for (int i = 0; i < 3; ++i) force[i] += more_force[i], torque[i] += more_torque[i];
}

/// Reports an error when the daemon begins to limit the program's force, because the user then feels less than the
/// program asked for.
void Arm::reportLimit(const double force[3]) {
  const bool beyond = forceOn() && facts_.max_force > 0 && allFinite(force) && sizeOf(force) > facts_.max_force;
  const bool tells = isEnabled(HD_SOFTWARE_FORCE_LIMIT) && isEnabled(HD_MAX_FORCE_CLAMPING);
  if (beyond && tells && !told_limit_) errors_.push(HD_EXCEEDED_MAX_FORCE, handle_);
  told_limit_ = beyond;
}

/// Limits the force that the program asked for, and returns an error if it breaks a bound. After an error the force is
/// zero.
HDerror Arm::checked(uint64_t ns, double force[3]) const {
  if (!forceOn()) return HD_SUCCESS;
  if (!allFinite(force)) return hintOnce("a force is not a finite number, so no force is sent"), HD_FORCE_ERROR;
  if (bounds_.velocity > 0 && sizeOf(frame_.velocity) * kMmPerMetre > bounds_.velocity) return HD_EXCEEDED_MAX_VELOCITY;
  const double step[3] = {force[0] - last_.force[0], force[1] - last_.force[1], force[2] - last_.force[2]};
  if (bounds_.impulse > 0 && sizeOf(step) > bounds_.impulse) return HD_EXCEEDED_MAX_FORCE_IMPULSE;
  if (facts_.max_force > 0 && sizeOf(force) > facts_.max_force) {
    if (isEnabled(HD_MAX_FORCE_CLAMPING))
      scaleTo(force, facts_.max_force);
    else if (isEnabled(HD_SOFTWARE_FORCE_LIMIT))
      return HD_EXCEEDED_MAX_FORCE;
  }
  if (isEnabled(HD_FORCE_RAMPING) && bounds_.ramp > 0)
    scaleTo(force, bounds_.ramp * static_cast<double>(ns - force_since_ns_) / kNsPerSecond);
  return HD_SUCCESS;
}

/// Sends the answer to a tick, unless this tick or a later one was answered: the servo would ignore such an answer.
void Arm::answer(uint64_t tick, const double force[3], const double torque[3], uint64_t ns) {
  if (pushed_ && tick <= pushed_tick_) return;
  hapticd_push push{};
  push.tick = tick;
  std::copy_n(force, 3, push.force), std::copy_n(torque, 3, push.torque);
  toWorld(facts_, push.force), toWorld(facts_, push.torque);
  push.woke_ns = woke_ns_, push.written_ns = ns;
  link_->push(push);
  pushed_tick_ = tick, pushed_ = true;
}

void Arm::heartbeat(uint64_t ns) {
  if (!isOpen() || !forceOn()) return;
  constexpr double kNothing[3] = {};
  const bool holds = ns - last_end_ns_ < kHoldNs;
  answer(now_.tick, holds ? held_force_ : kNothing, holds ? held_torque_ : kNothing, ns);
}

bool Arm::isCapability(HDenum capability) {
  return bitOf(capability) != 0;
}

bool Arm::isEnabled(HDenum capability) const {
  return (capabilities_ & bitOf(capability)) != 0;
}

bool Arm::enable(HDenum capability, bool on, std::string& why) {
  if (on && capability == HD_FORCE_OUTPUT && !link_->lead(why)) return false;
  capabilities_ = on ? capabilities_ | bitOf(capability) : capabilities_ & ~bitOf(capability);
  if (!forceOn()) force_since_ns_ = 0;  // the force ramps in when it is switched on again
  return bitOf(capability) != 0;
}

double Arm::motorTemperature(int joint) const {
  const auto place = static_cast<size_t>(joint);
  if (!isOpen() || place >= facts_.motors.size()) return 0;
  double celsius[16];
  constexpr size_t kMost = std::size(celsius);
  if (place >= kMost) return 0;
  std::fill_n(celsius, kMost, facts_.motors[place].ambient);
  link_->temperatures(celsius, kMost);
  const DeviceFacts::Motor& motor = facts_.motors[place];
  const double span = motor.hottest - motor.ambient;
  return span > 0 ? std::clamp((celsius[place] - motor.ambient) / span, 0.0, 1.0) : 0;
}

}  // namespace hapticd::hd
