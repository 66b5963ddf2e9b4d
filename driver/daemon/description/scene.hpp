// SPDX-License-Identifier: MIT
/// A validated scene as plain data: the contents of its files, with every default filled in. The loader (load.hpp)
/// writes it, and the set-up of the daemon reads it. The servo thread does not read it.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.hpp"

namespace hapticd::scene {

using document::Place;

/// Position [m] and orientation of a frame in its parent frame.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// One parameter that the file gives. It is checked against the table of the plugin or module, and ready for set().
struct Value {
  std::string id;
  uint32_t index = 0;  ///< index in the table
  uint32_t kind = 0;   ///< HSP_REAL, ...
  double number = 0;
  std::string text;  ///< text or absolute path
  std::vector<double> numbers;
  Place place;
};

/// [any] Returns the value that the files give for a parameter, or nullptr if they give none.
inline const Value* givenIn(const std::vector<Value>& values, std::string_view id) {
  for (const Value& value : values)
    if (value.id == id) return &value;
  return nullptr;
}

/// [any] Returns the number that the files give for a parameter, or `otherwise` if they give none.
inline double numberIn(const std::vector<Value>& values, std::string_view id, double otherwise = 0) {
  const Value* value = givenIn(values, id);
  return value != nullptr ? value->number : otherwise;
}

/// One point of a kinematic path; poses between two points are interpolated (linear, and slerp).
struct PathPoint {
  double t = 0;
  Pose pose;
};

struct Model {
  std::string name, plugin;
  std::filesystem::path library;  ///< the .so that contains the plugin
  Pose pose;                      ///< pose of the model in the world at the start
  bool kinematic = false;         ///< true: a path, a request or a leader moves the model, not its plugin
  bool enabled = true;            ///< false: it is neither felt nor traced until a request enables it
  std::vector<PathPoint> path;
  std::vector<Value> parameters;
  Place place;
};

/// How a button enables the forces. kHold: while the button is held (dead-man switch). kToggle: each press of the
/// button switches the forces on or off.
enum class EnableMode { kHold, kToggle };
struct Enable {
  std::optional<int> button;  ///< if there is none, forces are always enabled
  EnableMode mode = EnableMode::kHold;
};

/// The properties of one motor, for the model of its heat. The numbers are those of its data sheet.
struct Motor {
  double ratio = 1;                              ///< joint torque divided by motor torque
  double torque_constant = 0, resistance = 0;    ///< [N m/A], [ohm] at 25 degC
  double winding_housing = 1, housing_air = 10;  ///< [K/W] thermal resistances
  double winding_time = 10, housing_time = 600;  ///< [s] thermal time constants
  double max_temperature = 100, ambient = 25;    ///< [degC]
};

/// Limits of one device. They are applied between the contact forces and the motors, whatever the plugins compute.
struct Limits {
  double force = 0;                ///< [N] largest force; 0: the device's own maximum
  double torque = 0;               ///< [N m] largest torque on the hand; 0: only the motors limit it
  double slew = 2000;              ///< [N/s] fastest growth of force; 0: no limit
  double torque_slew = 200;        ///< [N m/s] fastest growth of torque; 0: no limit. 200 is `slew` at a lever of 0.1 m
  double power = 0;                ///< [W] most power that the arm gives to the hand; 0: no limit
  double impulse = 0;              ///< [N s] largest impulse within any tenth of a second; 0: no limit
  std::optional<double> velocity;  ///< [m/s] a faster tip latches a fault; 0: no limit; default on hardware: 5
  double workspace = 0;          ///< [m] radius about the origin of the device frame; outside, forces fade; 0: no limit
  std::optional<double> weight;  ///< [N] largest force at the tip that carries the arm's weight; default: `force`
  double ramp_in = 0.25;         ///< [s] time from zero to full force, at the start and after a fault
  double ramp_out = 0.02;        ///< [s] time from full force to zero at a planned end; after a fault at most 2 ms
  std::optional<bool> passivity;  ///< passivity control; default: on for arms never tried on hardware
  Enable enable;
  std::vector<Motor> motors;  ///< in the order of the joints; if empty, the heat of the motors is not modelled
};

/// Compliance control: the measured joint torques move a virtual mass with a damper, and the arm's position loop
/// follows it.
struct Admittance {
  double mass = 1, damping = 10;  ///< [kg], [N s/m] of the virtual mass and damper
};

/// A joint as HDAPI programs see it: its angle is sign * (angle of the device's joint) + offset.
struct HdJoint {
  uint32_t joint = 0;  ///< number of the device's joint, counted from 0
  double sign = 1;     ///< 1 or -1
  double offset = 0;   ///< [rad]
};

/// How HDAPI programs see an arm. A value that is empty here is taken from the device's own description.
struct HdArm {
  std::string model, vendor, serial;
  std::vector<HdJoint> joints;    ///< turret, thigh, shin, and the three joints of the gimbal
  std::vector<uint32_t> buttons;  ///< numbers of the device's buttons, in the order of the programs' buttons
};

struct Device {
  std::string name, module;
  std::filesystem::path file, library;
  Pose mount;  ///< pose of the device frame in the world
  Limits limits;
  std::optional<Admittance> admittance;
  std::optional<HdArm> hd;
  std::vector<Value> parameters;
  bool chosen_by_default = false;  ///< true if the scene names no device
  Place place;
};

enum class Pace { kClock, kDevice };

/// Which processor instructions the inner loops of shapes use. The last bits of the results depend on them.
enum class Instructions {
  kAuto,     ///< the fastest instructions that the processor has
  kPortable  ///< instructions that every processor has: the same bits on all machines
};

struct Velocity {
  std::string estimator = "window";  ///< window, butterworth, foaw, least_squares, kalman
  double parameter = 3;  ///< its meaning depends on the estimator: number of samples, cut-off in Hz, or process noise
};

struct Servo {
  double rate = 1000;               ///< [Hz]
  double activation_radius = 0.10;  ///< [m] surfaces nearer than this are traced
  /// [m] tracing of a surface stops when it is farther away than activation_radius plus this distance
  double hysteresis = 0.05;
  Eigen::Vector3d gravity{0, -9.81, 0};  ///< [m/s^2] world frame
  Pace pace = Pace::kClock;
  Velocity velocity;
  std::optional<double> spin_us;  ///< [us] busy wait before the deadline; default: chosen for the machine
  Instructions instructions = Instructions::kAuto;
  double budget_us = 0;  ///< [us] time per tick for all shapes together; 0: four fifths of the period
};

/// Whether programs (clients) may push on the arms with their own forces.
enum class ClientMode {
  kOff,     ///< they may not
  kAdd,     ///< their forces are added to the forces of the models
  kInstead  ///< the models fade out while a program pushes
};
/// Frame whose axes the coordinates of HDAPI programs use.
enum class ClientFrame { kWorld, kDevice };
struct Clients {
  ClientMode mode = ClientMode::kOff;
  double max_force = 0;    ///< [N] largest force of one program; 0: only the device's limit counts
  bool exclusive = false;  ///< true: one program per arm; false: the forces of several programs add up
  double answer_time = 0;  ///< [s] time after the start of a tick for which the servo waits for answers; 0: none
  bool push = true;        ///< false: programs may read the state of the arms, but may not push
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m] origin of the HDAPI's coordinates, in the axes of `frame`
  ClientFrame frame = ClientFrame::kWorld;           ///< the world's axes, or the axes of the arm's mount
};

struct Scene {
  std::filesystem::path file;
  Servo servo;
  Clients clients;
  std::vector<Model> models;
  std::vector<Device> devices;  ///< at least one
};

}  // namespace hapticd::scene
