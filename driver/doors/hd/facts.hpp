// SPDX-License-Identifier: MIT
/// Properties of an arm that do not change while a daemon runs, in the units of the HDAPI.
#pragma once
#include <string>
#include <vector>

#include "HD/hdDefines.h"

namespace hapticd::hd {

struct DeviceFacts {
  std::string name, model, vendor = "hapticd", serial, driver;  ///< `name` is the name that the daemon uses
  std::string firmware_text;
  double firmware = 0;  ///< the first number in the text of the firmware version
  double rate = 1000;   ///< [Hz] rate of the servo
  int joints = 3, input_dof = 3, output_dof = 3;
  double max_force = 0, continuous_force = 0;  ///< [N]
  double max_stiffness = 0, max_damping = 0;   ///< [N/mm], [N s/mm]
  /// [mm] least x, y, z, then greatest x, y, z, in the axes of the programs.
  double workspace[6] = {}, usable[6] = {};
  double tabletop = 0;     ///< [mm] height of the workspace's middle above the table
  int enable_button = -1;  ///< number of the button that must be pressed for any force; -1 if the arm has none
  bool pushable = false;   ///< true if the scene allows programs to push on this arm
  struct Motor {
    double hottest, ambient;  ///< [degC]
  };
  std::vector<Motor> motors;  ///< one entry for each joint whose motor has a thermal model
  /// One joint as programs see it: sign times the device's joint, plus an offset.
  struct Joint {
    size_t joint;
    double sign, offset;
  };
  std::vector<Joint> joint_of;  ///< turret, thigh, shin, and up to three of the gimbal
  /// Number of the device's button for each button of the programs; empty if the numbers are equal.
  std::vector<unsigned> button_of;
  double max_torque = 0;          ///< [N m] largest torque on the hand; 0 if programs cannot turn the hand
  bool is_world = true;           ///< true if the programs' coordinates are those of the world
  double origin[3] = {};          ///< [m] origin of the programs' coordinates, in the world
  double turn[4] = {1, 0, 0, 0};  ///< w x y z: rotation from the programs' axes to the world's
};

/// [main] Reads the facts of one device. @param about the daemon's description of its devices, as JSON @return false if
/// the description is not as expected
bool readFacts(const char* about, int device, DeviceFacts& facts);

/// [any] Returns a copy of the text that lives as long as the process, because programs may keep strings of the HDAPI.
HDstring keptForever(const std::string& text);

}  // namespace hapticd::hd
