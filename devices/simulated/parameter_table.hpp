// SPDX-License-Identifier: MIT
/// The parameter table of the simulated arm: the keys of its device files, with unit, range, default and documentation.
#pragma once
#include "hapticd/device.hpp"
#include "simulated/parameters.hpp"

namespace hapticd::simulated {

inline constexpr const char* kKinds[] = {"premium15", "chain", "phantom", "delta"};
inline constexpr const char* kScripts[] = {"hold", "stroke", "press", "tap", "circle", "path", "none", "guided"};
inline constexpr int kMaxDelay = 16;

/// The lines of the parameter table, for a device class T that derives from Parameters.
template <class T>
struct ParameterTable {
  using F = Fields<T>;

  static constexpr auto arm() {
    return std::array{
        F::choice("arm.kind", &T::kind, kKinds, 0,
                  "The mechanism: a PHANToM Premium 1.5, the serial chain of arm.dh, an arm built like the PHANToM "
                  "with other lengths (arm.lengths), or a delta such as the Novint Falcon."),
        F::vector3(
            "arm.origin", &T::origin, "m", -1, 1, "[0, 0, 0]",
            "premium15, phantom: position of the tip in the neutral pose, in the device frame. delta: position of "
            "the middle of its base. chain: an offset that is added to arm.base_position."),
        F::array("arm.dh", &T::dh, "m, rad, m, rad", 4, 0, 64, -10, 10, "[]",
                 "chain: one row a, alpha, d, theta for each joint (standard Denavit-Hartenberg)."),
        F::array(
            "arm.limits", &T::limits, "rad", 2, 0, 32, -100, 100, "[]",
            "chain, phantom, delta: one row [least, greatest angle] for each joint. Default: half a turn to either "
            "side for a chain, the stops of the Premium 1.5 for a phantom, those of the Falcon for a delta."),
        F::array(
            "arm.masses", &T::masses, "kg", 1, 0, 16, 0, 1000, "[]",
            "chain: mass of each link. phantom: ma mc mbe mdf; default: those of the Premium 1.5. delta: upper arm, "
            "rod pair, platform; default: guessed ones of a Falcon."),
        F::array("arm.centers", &T::centers, "m", 3, 0, 48, -10, 10, "[]",
                 "chain: centre of mass of each link, in the frame after its joint."),
        F::array("arm.inertias", &T::inertias, "kg m^2", 3, 0, 48, 0, 1000, "[]",
                 "chain: principal inertias of each link about its centre of mass, along the axes of the frame after "
                 "its joint. phantom: rows a, c, be, df and base; default: those of the Premium 1.5."),
        F::vector3("arm.base_position", &T::base_position, "m", -10, 10, "[0, 0, 0]",
                   "chain: position of its first frame in the device frame."),
        F::array("arm.base_orientation", &T::base_orientation, "", 4, 0, 4, -1.001, 1.001, "[]",
                 "Orientation in the device frame of the first frame of a chain, or of the base of a delta: a unit "
                 "quaternion w, x, y, z."),
        F::vector3("arm.tool_position", &T::tool_position, "m", -10, 10, "[0, 0, 0]",
                   "chain: position of the tip in the frame of the last link."),
        F::array("arm.lengths", &T::lengths, "m", 1, 0, 8, -10, 10, "[]",
                 "phantom: l1 l2 l3 l5 l6 (default: Premium 1.5). delta: a b c d e f r s (default: Falcon)."),
        F::array("arm.angles", &T::angles, "rad", 1, 0, 3, -10, 10, "[]",
                 "delta: angles about its axis at which the three arms are mounted; default: those of the Falcon."),
        F::array("arm.max_torque", &T::arm_torque, "N m", 1, 0, 16, 0, 1e5, "[]",
                 "Largest torque of each joint, behind its gear, as in the device file of a real arm. "
                 "It replaces joint.max_torque.")};
  }

  /// What the arm reports of itself, and how it is simulated.
  static constexpr auto device() {
    return std::array{
        F::real("device.rate", &T::rate, "Hz", 1, 100000, 1000,
                "Sample rate that the arm reports. With servo.pace: device, its samples come at this rate."),
        F::real("device.max_force", &T::max_force, "N", 0, 10000, 8.5, "Largest force that the arm reports."),
        F::real("device.continuous_force", &T::continuous_force, "N", 0, 10000, 1.4,
                "Largest lasting force that the arm reports."),
        F::real("device.max_stiffness", &T::max_stiffness, "N/m", 0, 1e6, 3500,
                "Largest stable stiffness that the arm reports."),
        F::real("device.mass", &T::felt_mass, "kg", 0, 1000, 0.075, "Mass felt at the tip that the arm reports."),
        F::integer("delay", &T::delay, "", 0, kMaxDelay, 0, "Delay of the commands, as a number of servo ticks."),
        F::real("substep", &T::substep, "s", 1e-6, 1e-2, 2e-4, "Longest step of the integration.", HSP_P_ACCURACY),
        F::integer("seed", &T::seed, "", 0, 1000000000, 1,
                   "Seed of tremor and noise: the same seed gives the same numbers.")};
  }

  static constexpr auto joint() {
    return std::array{
        F::array("joint.gear", &T::gear, "", 1, 0, 16, 0.001, 1e4, "[]",
                 "Gear ratio: motor turns per joint turn. Each list of joint.* has one number for all joints, or one "
                 "number for each joint; the default for premium15 is its published numbers."),
        F::array("joint.counts", &T::counts, "", 1, 0, 16, 0, 1e9, "[]",
                 "Encoder counts per motor turn; 0 for exact positions."),
        F::array("joint.damping", &T::damping, "N m s/rad", 1, 0, 16, 0, 1e4, "[]", "Viscous friction."),
        F::array("joint.friction", &T::friction, "N m", 1, 0, 16, 0, 1e4, "[]", "Coulomb friction."),
        F::real("joint.friction_speed", &T::friction_speed, "rad/s", 1e-4, 100, 0.1,
                "Coulomb friction is friction * tanh(rate / friction_speed)."),
        F::array("joint.max_torque", &T::max_torque, "N m", 1, 0, 16, 0, 1e5, "[]",
                 "Largest torque of the motor, before the gear."),
        F::array("joint.rotor", &T::rotor, "kg m^2", 1, 0, 16, 0, 100, "[]", "Inertia of the motor, before the gear."),
        F::real("joint.motor_lag", &T::motor_lag, "s", 0, 1, 1.09e-4,
                "Electrical time constant of the motors (RE25: 0.238 mH / 2.18 ohm)."),
        F::array("joint.stiffness", &T::stiffness, "N m/rad", 1, 0, 16, 0, 1e6, "[]",
                 "Stiffness of the arm's own position loop. Without it the arm takes only torques."),
        F::array("joint.rate_damping", &T::rate_damping, "N m s/rad", 1, 0, 16, 0, 1e5, "[]",
                 "Damping of the arm's own position loop, on the velocity of the joint relative to its reference."),
        F::boolean("joint.torque_sensors", &T::torque_sensors, false,
                   "If true, samples carry the torque from motor to link, minus friction."),
        F::real("joint.torque_noise", &T::torque_noise, "N m", 0, 100, 0, "White noise of the torque sensors, rms.")};
  }

  static constexpr auto hand() {
    return std::array{
        F::choice("hand.script", &T::script, kScripts, 1,
                  "Motion of the hand. hold: rests; stroke: strokes over the object; press: presses into it and comes "
                  "out again; tap: taps on it; circle: circles round it; path: follows a path file; none: there is no "
                  "hand; guided: a program leads the hand (`hapticd ctl lead`)."),
        F::real("hand.mass", &T::mass, "kg", 0, 100, 0.2, "Mass of the hand at the tip."),
        F::real("hand.stiffness", &T::hand_stiffness, "N/m", 0, 1e5, 500,
                "Stiffness of the spring from the tip to the wanted position of the hand."),
        F::real("hand.damping", &T::hand_damping, "N s/m", 0, 1e4, 5, "Damper parallel to hand.stiffness."),
        F::vector3("hand.center", &T::center, "m", -10, 10, "[0, 0, 0]",
                   "Centre of the object to touch, device frame."),
        F::vector3("hand.normal", &T::normal, "", -1, 1, "[0, 0, 1]", "Direction from the centre to the hand."),
        F::vector3("hand.axis", &T::axis, "", -1, 1, "[0, 1, 0]", "Axis that strokes and circles turn about."),
        F::real("hand.radius", &T::radius, "m", 0, 10, 0.045,
                "Distance from the centre or axis to the point that the hand aims for. stroke, circle: less than the "
                "object's radius. press, tap: the object's radius; hand.rise is the depth."),
        F::real("hand.sweep", &T::sweep, "rad", 0, 100, 0.9, "Angle of a stroke to either side."),
        F::real("hand.rise", &T::rise, "m", 0, 1, 0.008,
                "stroke: height of the rise along the axis. "
                "press, tap: depth to which the hand moves inwards from hand.radius."),
        F::real("hand.rate", &T::hand_rate, "Hz", 0, 100, 0.3, "Strokes, presses, taps or circles per second."),
        F::real("hand.approach", &T::approach, "m", 0, 1, 0.02,
                "The hand starts at this distance, along hand.normal, from the first point of its script."),
        F::real("hand.lead_in", &T::lead_in, "s", 0.001, 100, 0.5,
                "Time that the hand takes to come in by the distance hand.approach."),
        F::real("hand.tremor", &T::tremor, "N", 0, 100, 0.05, "Tremor of 8 to 12 Hz: rms force in each direction."),
        F::real("hand.wander", &T::wander, "N", 0, 100, 0.1,
                "Slow unrest of 0.2 to 1 Hz: rms force in each direction."),
        F::path("hand.path", &T::path,
                "CSV file with the columns t,x,y,z (s, m, device frame), for hand.script: path."),
        F::array("hand.pressed", &T::pressed, "s, s", 2, 0, 200, 0, 1e9, "[]",
                 "Times in which the hand holds the arm's button down: rows of begin and end. "
                 "Without a row the arm has no button."),
        F::array("hand.unplugged", &T::unplugged, "s, s", 2, 0, 200, 0, 1e9, "[]",
                 "Times in which the arm is unplugged: rows of begin and end. So a program can be tried on an arm that "
                 "is lost and comes back.")};
  }
};

}  // namespace hapticd::simulated
