// SPDX-License-Identifier: MIT
/// A device file to start from: what is known of an arm that nobody has described yet, and the commented file for it.
#pragma once
#include <string>
#include <vector>

namespace hapticd::device_draft {

/// What a user knows of an arm on USB. Every number is a guess until it is measured.
struct DeviceDraft {
  std::string name, bus = "hid", kind = "phantom", id = "1234:0006";
  std::string checksum = "none";        ///< of the arm's reports; a name as in a device file
  std::vector<double> lengths, twists;  ///< [m] links; [rad] from each joint's axis to the next
  std::vector<double> counts{2000}, gear{10},
      torque{0.5};  ///< one number for all joints, or one per joint; torque [N m]
  int joints = 3, bits = 16, buttons = 1, report_id = 0;
  double force = 2;  ///< [N] limit at the tip

  /// [any] Returns the number for a joint, counted from 0, from a list of one number or of one per joint.
  static double ofJoint(const std::vector<double>& list, int joint);
  /// [any] True if the arm is a chain whose axes are all parallel. The tip of such a chain stays in a plane, and no
  /// force across the plane can be felt.
  bool isPlanar() const;
  bool hasChecksum() const { return checksum != "none"; }  ///< [any]
  /// [any] True if the name has only letters, digits, _ and -, at most 40.
  bool isNameUsable() const;
};

/// [main] Returns what is wrong with a draft, with the option that gives it, or "".
std::string wrongIn(const DeviceDraft& draft);

/// [main] Returns the text of the device file (YAML, with comments). The draft must be right.
std::string deviceFileOf(const DeviceDraft& draft);

}  // namespace hapticd::device_draft
