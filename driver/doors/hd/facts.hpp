// SPDX-License-Identifier: MIT
/// What does not change of an arm while a daemon runs, in the units of the HDAPI.
#pragma once
#include <string>
#include <vector>

#include "HD/hdDefines.h"

namespace hapticd::hd {

struct Facts {
  std::string name, model, vendor = "hapticd", serial, driver;  ///< `name` in the daemon's form
  std::string firmware_text;
  double firmware = 0;  ///< its first number
  double rate = 1000;   ///< [Hz] of the servo
  int joints = 3, input_dof = 3, output_dof = 3;
  double max_force = 0, continuous_force = 0;  ///< [N]
  double max_stiffness = 0, max_damping = 0;   ///< [N/mm], [N s/mm]
  double workspace[6] = {}, usable[6] = {};    ///< [mm] least x y z, greatest x y z; HD frame
  double tabletop = 0;                         ///< [mm] height of the workspace's middle above the table
  int enable_button = -1;                      ///< enable button, without which no force flows; -1: there is none
  bool pushable = false;                       ///< the scene lets programs push
  struct Motor {
    double hottest, ambient;  ///< [degC]
  };
  std::vector<Motor> motors;  ///< joints with a model of their motors' heat
  /// One of the programs' joints: sign times the device's joint, plus an offset.
  struct Joint {
    size_t joint;
    double sign, offset;
  };
  std::vector<Joint> joint_of;      ///< turret, thigh, shin, and up to three of the gimbal
  std::vector<unsigned> button_of;  ///< the device's joints, in the order of the programs'; none: they are the same
  double max_torque = 0;            ///< [N m] on the hand; 0: programs cannot turn the hand
  bool is_world = true;             ///< the programs' coordinates are the world's
  double origin[3] = {};            ///< [m] origin of the programs' coordinates, in the world
  double turn[4] = {1, 0, 0, 0};    ///< w x y z, from the programs' axes to the world's
};

/// [main] @param about what a daemon says about itself @return false if it cannot be understood
bool readFacts(const char* about, int device, Facts& facts);

/// [any] A copy that stays as long as the process, because a string that the HDAPI gives out is never freed.
HDstring keptForever(const std::string& text);

}  // namespace hapticd::hd
