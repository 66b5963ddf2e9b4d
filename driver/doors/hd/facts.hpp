// SPDX-License-Identifier: MIT
/// What does not change of an arm while a daemon runs, in the units of the HDAPI.
#pragma once
#include <string>
#include <vector>

#include "HD/hdDefines.h"

namespace hapticd::hd {

struct Facts {
  std::string name, model, vendor = "hapticd", serial, driver;  ///< `name` as the daemon has it
  std::string firmware_text;
  double firmware = 0;  ///< its first number
  double rate = 1000;   ///< [Hz] of the servo
  int joints = 3, input_dof = 3, output_dof = 3;
  double max_force = 0, continuous_force = 0;  ///< [N]
  double max_stiffness = 0, max_damping = 0;   ///< [N/mm], [N s/mm]
  double workspace[6] = {}, usable[6] = {};    ///< [mm] least x y z, greatest x y z; HD frame
  double tabletop = 0;                         ///< [mm] of the workspace's middle above the table
  int enable_button = -1;                      ///< without which no force flows; -1: there is none
  bool pushable = false;                       ///< the scene lets programs push
  struct Motor {
    double hottest, ambient;  ///< [degC]
  };
  std::vector<Motor> motors;  ///< with a model of their heat
  /// A joint of theirs: sign times the device's, and an offset.
  struct Joint {
    size_t joint;
    double sign, offset;
  };
  std::vector<Joint> joint_of;      ///< turret, thigh, shin, and up to three of the gimbal
  std::vector<unsigned> button_of;  ///< of the device, in the order of theirs; none: as they are
  double max_torque = 0;            ///< [N m] on the hand; 0: programs turn nothing
  bool is_world = true;             ///< their coordinates are the world's
  double origin[3] = {};            ///< [m] of their coordinates, world
  double turn[4] = {1, 0, 0, 0};    ///< w x y z, from their axes to the world's
};

/// [main] @param about what a daemon says of itself @return false: it cannot be understood
bool readFacts(const char* about, int device, Facts& facts);

/// [any] A copy that stays for as long as the process: what the HDAPI gives out as a string is never freed.
HDstring keptForever(const std::string& text);

}  // namespace hapticd::hd
