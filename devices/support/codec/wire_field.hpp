// SPDX-License-Identifier: MIT
/// One field of a report as a device file describes it.
#pragma once
#include <span>

#include "codec/report.hpp"
#include "codec/tree.hpp"

namespace hapticd::codec {

/// Every key that a field may have.
std::span<const char* const> fieldKeys();

/// Whether a field is known well enough to count it: its role, and its joint.
struct ReadField {
  Field field;
  bool target_known = false;
  bool placed = false;  ///< whether its place and its number of bits are known
};

/// [main] Reads and checks one field; what is wrong is noted in the tree.
/// @param joints of the arm; 0: not known
ReadField readField(const Tree& tree, const Report& report, size_t joints, bool input);

}  // namespace hapticd::codec
