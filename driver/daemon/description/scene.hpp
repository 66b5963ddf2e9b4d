// SPDX-License-Identifier: MIT
/// A validated scene as plain data: what the files say, with every default filled in. Written by the loader (load.hpp),
/// read by whoever sets up the daemon. Nothing here is used in the servo thread.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "document/problem.hpp"

namespace hapticd::scene {

using document::Place;

/// Position [m] and orientation of a frame in its parent.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// One parameter that the file gives, ready for set(): checked against the table of the plugin or module.
struct Value {
  std::string id;
  uint32_t index = 0;  ///< in the table
  uint32_t kind = 0;   ///< HSP_REAL, ...
  double number = 0;
  std::string text;  ///< paths are absolute
  std::vector<double> numbers;
  Place place;
};

/// One point of a kinematic path; poses between two points are interpolated (linear, and slerp).
struct PathPoint {
  double t = 0;
  Pose pose;
};

struct Model {
  std::string name, plugin;
  std::filesystem::path library;  ///< the .so that contains the plugin
  Pose pose;                      ///< pose of the model in the world at the start
  bool kinematic = false;         ///< moved by `path`, not by its plugin
  std::vector<PathPoint> path;
  std::vector<Value> parameters;
  Place place;
};

/// What lets forces through: a button of the device, which is held (dead-man switch), or toggles.
enum class EnableMode { kHold, kToggle };
struct Enable {
  std::optional<int> button;  ///< none: forces are always let through
  EnableMode mode = EnableMode::kHold;
};

/// One motor for the model of its heat; numbers as data sheets give them.
struct Motor {
  double ratio = 1;                              ///< joint torque divided by motor torque
  double torque_constant = 0, resistance = 0;    ///< [N m/A], [ohm] at 25 degC
  double winding_housing = 1, housing_air = 10;  ///< [K/W]
  double winding_time = 10, housing_time = 600;  ///< [s]
  double max_temperature = 100, ambient = 25;    ///< [degC]
};

/// Limits of one device, applied between contact and motors, whatever the plugins say.
struct Limits {
  double force = 0;                ///< [N] 0: the device's own maximum
  double torque = 0;               ///< [N m] on the hand; 0: the motors are the only limit
  double slew = 2000;              ///< [N/s] fastest growth of force; 0: none
  double torque_slew = 200;        ///< [N m/s] fastest growth of torque; 0: none. As `slew`, at 0.1 m from the tip
  double power = 0;                ///< [W] most power that the arm gives to the hand; 0: no limit
  double impulse = 0;              ///< [N s] largest impulse within any tenth of a second; 0: no limit
  std::optional<double> velocity;  ///< [m/s] a faster tip latches a fault; 0: no limit; none: 5, for real hardware
  double workspace = 0;            ///< [m] radius about the world's origin of the device; outside forces fade; 0: none
  std::optional<double> weight;    ///< [N] at the tip, most that carries the arm's weight; none: as large as `force`
  double ramp_in = 0.25;           ///< [s] from zero to full force at the start and after a fault
  double ramp_out = 0.02;          ///< [s] from full force to zero at a planned end; after a fault 2 ms at most
  std::optional<bool> passivity;   ///< observer and controller; none: for arms never tried on hardware
  Enable enable;
  std::vector<Motor> motors;  ///< in the order of the joints; none: their heat is not modelled
};

/// Compliance control: measured joint torque drives a virtual mass and damper, rendered as positions.
struct Admittance {
  double mass = 1, damping = 10;  ///< [kg], [N s/m]
};

/// A joint as programs of the HDAPI know it: sign times the device's joint, and an offset.
struct HdJoint {
  uint32_t joint = 0;  ///< of the device, counted from 0
  double sign = 1;     ///< 1 or -1
  double offset = 0;   ///< [rad]
};

/// How programs of the HDAPI see an arm. Empty: as the device says of itself.
struct HdArm {
  std::string model, vendor, serial;
  std::vector<HdJoint> joints;    ///< turret, thigh, shin, and the three of the gimbal
  std::vector<uint32_t> buttons;  ///< the device's joints, in the order of the programs' joints
};

struct Device {
  std::string name, module;
  std::filesystem::path file, library;
  Pose mount;  ///< the device frame in the world
  Limits limits;
  std::optional<Admittance> admittance;
  std::optional<HdArm> hd;
  std::vector<Value> parameters;
  bool chosen_by_default = false;  ///< the scene named none
  Place place;
};

enum class Pace { kClock, kDevice };

/// Which processor instructions the inner loops of shapes use. The last bits of results depend on it.
enum class Instructions {
  kAuto,     ///< the fastest instructions that the processor has
  kPortable  ///< instructions that every processor has: the same bits on all machines
};

struct Velocity {
  std::string estimator = "window";  ///< window, butterworth, foaw, least_squares, kalman
  double parameter = 3;              ///< what the estimator takes: samples, cut-off in Hz, or process noise
};

struct Servo {
  double rate = 1000;                    ///< [Hz]
  double activation_radius = 0.10;       ///< [m] surfaces nearer than this are traced
  double hysteresis = 0.05;              ///< [m] beyond that radius, at which they are dropped again
  Eigen::Vector3d gravity{0, -9.81, 0};  ///< [m/s^2] world
  Pace pace = Pace::kClock;
  Velocity velocity;
  std::optional<double> spin_us;  ///< [us] busy wait before the deadline; none: chosen for the machine
  Instructions instructions = Instructions::kAuto;
  double budget_us = 0;  ///< [us] per tick for all shapes together; 0: four fifths of the period
};

/// Whether programs may push on the arms with forces of their own.
enum class ClientMode {
  kOff,     ///< they may not
  kAdd,     ///< their forces are added to those of the models
  kInstead  ///< the models fade out while a program pushes
};
/// In whose axes the coordinates of HDAPI programs are.
enum class ClientFrame { kWorld, kDevice };
struct Clients {
  ClientMode mode = ClientMode::kOff;
  double max_force = 0;    ///< [N] of one program; 0: as much as the device's limit allows
  bool exclusive = false;  ///< one program an arm; otherwise their forces add up
  double answer_time = 0;  ///< [s] after a tick began during which the servo waits for answers; 0: it does not wait
  bool push = true;        ///< false: programs see what pushing programs see, but may not push
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m] origin of the HDAPI's coordinates, in the axes of `frame`
  ClientFrame frame = ClientFrame::kWorld;           ///< whose axes those are: the world's, or the arm's mount
};

struct Scene {
  std::filesystem::path file;
  Servo servo;
  Clients clients;
  std::vector<Model> models;
  std::vector<Device> devices;  ///< at least one
};

}  // namespace hapticd::scene
