// SPDX-License-Identifier: MIT
#include "values.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>

#include "rotation.hpp"
#include "units.hpp"

namespace hapticd::hd {

namespace {

constexpr size_t kTurnJoints = 3;  // the first three joints move the tip, the next three rotate it

void copy(const double* from, int count, double factor, double* out) {
  for (int i = 0; i < count; ++i) out[i] = factor * from[i];
}

/// Writes a value of a frame: of the open frame for CURRENT_..., of the frame before it for LAST_....
struct FrameValue {
  HDenum current, last;
  int count;
  void (*get)(const Arm& arm, const Frame& frame, double* out);
};

void buttons(const Arm& arm, const Frame& frame, double* out) {
  const auto& order = arm.facts().button_of;
  uint32_t theirs = order.empty() ? frame.state.buttons : 0;
  for (size_t i = 0; i < order.size(); ++i) theirs |= (frame.state.buttons >> order[i] & 1u) << i;
  out[0] = theirs;
}
void safetySwitch(const Arm& arm, const Frame& frame, double* out) {
  const int button = arm.facts().enable_button;
  out[0] = button < 0 || (frame.state.buttons >> button & 1u) != 0 ? 1 : 0;
}
void inkwell(const Arm&, const Frame&, double* out) {
  out[0] = 1;  // always out of the inkwell: no arm of hapticd has an inkwell
}
void nothing(const Arm&, const Frame&, double* out) {
  std::fill_n(out, kMostNumbers, 0.0);
}
void position(const Arm&, const Frame& frame, double* out) {
  copy(frame.state.position, 3, kMmPerMetre, out);
}
void velocity(const Arm&, const Frame& frame, double* out) {
  copy(frame.velocity, 3, kMmPerMetre, out);
}
void transform(const Arm&, const Frame& frame, double* out) {
  toTransform(frame.state, out);
}
void angularVelocity(const Arm&, const Frame& frame, double* out) {
  copy(frame.angular, 3, 1, out);
}
void threeJoints(const Arm& arm, const Frame& frame, size_t first, double* out) {
  nothing(arm, frame, out);
  const auto& joints = arm.facts().joint_of;
  for (size_t i = 0; i < 3 && first + i < joints.size(); ++i) {
    const DeviceFacts::Joint& joint = joints[first + i];
    out[i] = joint.sign * frame.state.joints[joint.joint] + joint.offset;
  }
}
void jointAngles(const Arm& arm, const Frame& frame, double* out) {
  threeJoints(arm, frame, 0, out);
}
void gimbalAngles(const Arm& arm, const Frame& frame, double* out) {
  threeJoints(arm, frame, kTurnJoints, out);
}
void force(const Arm&, const Frame& frame, double* out) {
  copy(frame.force, 3, 1, out);
}
void torque(const Arm&, const Frame& frame, double* out) {
  copy(frame.torque, 3, kMmPerMetre, out);
}

void jointTorque(const Arm&, const Frame& frame, double* out) {
  copy(frame.joint_torque, 3, kMmPerMetre, out);
}
void gimbalTorque(const Arm&, const Frame& frame, double* out) {
  copy(frame.joint_torque + kTurnJoints, 3, kMmPerMetre, out);
}

constexpr FrameValue kOfFrames[] = {
    {HD_CURRENT_BUTTONS, HD_LAST_BUTTONS, 1, buttons},
    {HD_CURRENT_SAFETY_SWITCH, HD_LAST_SAFETY_SWITCH, 1, safetySwitch},
    {HD_CURRENT_INKWELL_SWITCH, HD_LAST_INKWELL_SWITCH, 1, inkwell},
    {HD_CURRENT_ENCODER_VALUES, HD_LAST_ENCODER_VALUES, 6, nothing},
    {HD_CURRENT_PINCH_VALUE, HD_LAST_PINCH_VALUE, 1, nothing},
    {HD_CURRENT_POSITION, HD_LAST_POSITION, 3, position},
    {HD_CURRENT_VELOCITY, HD_LAST_VELOCITY, 3, velocity},
    {HD_CURRENT_TRANSFORM, HD_LAST_TRANSFORM, 16, transform},
    {HD_CURRENT_ANGULAR_VELOCITY, HD_LAST_ANGULAR_VELOCITY, 3, angularVelocity},
    {HD_CURRENT_JOINT_ANGLES, HD_LAST_JOINT_ANGLES, 3, jointAngles},
    {HD_CURRENT_GIMBAL_ANGLES, HD_LAST_GIMBAL_ANGLES, 3, gimbalAngles},
    {HD_CURRENT_FORCE, HD_LAST_FORCE, 3, force},
    {HD_CURRENT_TORQUE, HD_LAST_TORQUE, 3, torque},
    {HD_CURRENT_JOINT_TORQUE, HD_LAST_JOINT_TORQUE, 3, jointTorque},
    {HD_CURRENT_GIMBAL_TORQUE, HD_LAST_GIMBAL_TORQUE, 3, gimbalTorque},
    {HD_CURRENT_MOTOR_DAC_VALUES, HD_LAST_MOTOR_DAC_VALUES, 6, nothing},
};

/// Writes a value of the arm or of the scheduler.
struct ArmValue {
  HDenum name;
  int count;
  void (*get)(const Query& asked, double* out);
};

/// Returns the largest stiffness for programs. A program that answers one tick late makes walls buzz at a third of the
/// stiffness that shapes can have.
double stiffness(const Query& asked) {
  constexpr double kLate = 3;
  const bool in_time = sysconf(_SC_NPROCESSORS_ONLN) > 1 && asked.scheduler.realTime();
  return asked.arm.facts().max_stiffness / (in_time ? 1 : kLate);
}

/// Returns the largest torque on the hand in mN m. It is 0 for an arm of three joints.
double torque(const Arm& arm) {
  return arm.facts().output_dof > 3 ? arm.facts().max_torque * kMmPerMetre : 0;
}

void temperatures(const Query& asked, double* out) {
  for (int i = 0; i < asked.arm.facts().output_dof; ++i) out[i] = asked.arm.motorTemperature(i);
}

constexpr ArmValue kOfArms[] = {
    {HD_MAX_WORKSPACE_DIMENSIONS, 6, [](const Query& a, double* o) { copy(a.arm.facts().workspace, 6, 1, o); }},
    {HD_USABLE_WORKSPACE_DIMENSIONS, 6, [](const Query& a, double* o) { copy(a.arm.facts().usable, 6, 1, o); }},
    {HD_TABLETOP_OFFSET, 1, [](const Query& a, double* o) { o[0] = a.arm.facts().tabletop; }},
    {HD_INPUT_DOF, 1, [](const Query& a, double* o) { o[0] = a.arm.facts().input_dof; }},
    {HD_OUTPUT_DOF, 1, [](const Query& a, double* o) { o[0] = a.arm.facts().output_dof; }},
    {HD_CALIBRATION_STYLE, 1, [](const Query&, double* o) { o[0] = HD_CALIBRATION_AUTO; }},
    {HD_DEVICE_FIRMWARE_VERSION, 1, [](const Query& a, double* o) { o[0] = a.arm.facts().firmware; }},
    {HD_UPDATE_RATE, 1, [](const Query& a, double* o) { o[0] = a.scheduler.rate(); }},
    {HD_INSTANTANEOUS_UPDATE_RATE, 1, [](const Query& a, double* o) { o[0] = a.scheduler.instantaneousRate(); }},
    {HD_NOMINAL_MAX_STIFFNESS, 1, [](const Query& a, double* o) { o[0] = stiffness(a); }},
    {HD_NOMINAL_MAX_FORCE, 1, [](const Query& a, double* o) { o[0] = a.arm.facts().max_force; }},
    {HD_NOMINAL_MAX_CONTINUOUS_FORCE, 1, [](const Query& a, double* o) { o[0] = a.arm.facts().continuous_force; }},
    {HD_NOMINAL_MAX_DAMPING, 1, [](const Query& a, double* o) { o[0] = a.arm.facts().max_damping; }},
    {HD_NOMINAL_MAX_TORQUE_STIFFNESS, 1, [](const Query&, double* o) { o[0] = 0; }},
    {HD_NOMINAL_MAX_TORQUE_DAMPING, 1, [](const Query&, double* o) { o[0] = 0; }},
    {HD_NOMINAL_MAX_TORQUE_FORCE, 1, [](const Query& a, double* o) { o[0] = torque(a.arm); }},
    {HD_NOMINAL_MAX_TORQUE_CONTINUOUS_FORCE, 1, [](const Query&, double* o) { o[0] = 0; }},
    {HD_SOFTWARE_VELOCITY_LIMIT, 1, [](const Query& a, double* o) { o[0] = a.arm.bounds().velocity; }},
    {HD_SOFTWARE_FORCE_IMPULSE_LIMIT, 1, [](const Query& a, double* o) { o[0] = a.arm.bounds().impulse; }},
    {HD_FORCE_RAMPING_RATE, 1, [](const Query& a, double* o) { o[0] = a.arm.bounds().ramp; }},
    {HD_JOINT_ANGLE_REFERENCES, 3, [](const Query&, double* o) { std::fill_n(o, 3, 0.0); }},
    {HD_USER_STATUS_LIGHT, 1, [](const Query& a, double* o) { o[0] = a.arm.light; }},
};

}  // namespace

int numbersOf(const Query& asked, HDenum name, double out[kMostNumbers]) {
  for (const FrameValue& value : kOfFrames) {
    if (value.current != name && value.last != name) continue;
    value.get(asked.arm, value.current == name ? asked.current : asked.arm.last(), out);
    return value.count;
  }
  for (const ArmValue& value : kOfArms)
    if (value.name == name) return value.get(asked, out), value.count;
  if (name == HD_MOTOR_TEMPERATURE) return temperatures(asked, out), asked.arm.facts().output_dof;
  return textOf(asked.arm.facts(), name) != nullptr ? -1 : 0;
}

const std::string* textOf(const DeviceFacts& facts, HDenum name) {
  static const auto& version = *new std::string("3.40.0");
  switch (name) {
    case HD_VERSION:
      return &version;
    case HD_DEVICE_MODEL_TYPE:
      return &facts.model;
    case HD_DEVICE_DRIVER_VERSION:
      return &facts.driver;
    case HD_DEVICE_VENDOR:
      return &facts.vendor;
    case HD_DEVICE_SERIAL_NUMBER:
      return &facts.serial;
    case HD_DEVICE_FIRMWARE_VERSION:
      return &facts.firmware_text;
    default:
      return nullptr;
  }
}

int numbersToSet(HDenum name) {
  switch (name) {
    case HD_CURRENT_FORCE:
    case HD_CURRENT_TORQUE:
    case HD_CURRENT_JOINT_TORQUE:
    case HD_CURRENT_GIMBAL_TORQUE:
    case HD_CURRENT_MOTOR_DAC_VALUES:
      return 3;
    case HD_SOFTWARE_VELOCITY_LIMIT:
    case HD_SOFTWARE_FORCE_IMPULSE_LIMIT:
    case HD_FORCE_RAMPING_RATE:
    case HD_USER_STATUS_LIGHT:
      return 1;
    default:
      return 0;
  }
}

HDerror set(Arm& arm, HDenum name, const double* numbers) {
  Bounds& bounds = arm.bounds();
  const auto bound = [&](double& kept) -> HDerror {
    if (!(numbers[0] >= 0)) return HD_INVALID_VALUE;
    kept = numbers[0];
    return HD_SUCCESS;
  };
  switch (name) {
    case HD_SOFTWARE_VELOCITY_LIMIT:
      return bound(bounds.velocity);
    case HD_SOFTWARE_FORCE_IMPULSE_LIMIT:
      return bound(bounds.impulse);
    case HD_FORCE_RAMPING_RATE:
      return bound(bounds.ramp);
    case HD_USER_STATUS_LIGHT:
      arm.light = static_cast<int32_t>(numbers[0]);
      return HD_SUCCESS;
    case HD_CURRENT_MOTOR_DAC_VALUES:
      return HD_INVALID_OPERATION;
    case HD_CURRENT_JOINT_TORQUE:
      if (!arm.knowsJacobian()) return HD_INVALID_OPERATION;
      break;
    default:
      break;
  }
  if (!arm.inFrame()) return HD_FRAME_ERROR;
  double* joints = arm.frame().joint_torque;
  if (name == HD_CURRENT_JOINT_TORQUE) copy(numbers, 3, 1 / kMmPerMetre, joints);
  if (name == HD_CURRENT_GIMBAL_TORQUE && arm.facts().output_dof > 3)
    copy(numbers, 3, 1 / kMmPerMetre, joints + kTurnJoints);
  if (name == HD_CURRENT_FORCE) copy(numbers, 3, 1, arm.frame().force);
  if (name == HD_CURRENT_TORQUE) copy(numbers, 3, 1 / kMmPerMetre, arm.frame().torque);
  return HD_SUCCESS;  // a gimbal without motors gives no torque, so the numbers are ignored
}

}  // namespace hapticd::hd
