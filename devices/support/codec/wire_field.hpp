// SPDX-License-Identifier: MIT
/// Reads one field of a report from a device file.
#pragma once
#include "codec/report.hpp"
#include "codec/tree.hpp"
#include "codec/wire_overlap.hpp"

namespace hapticd::codec {

/// A field that was read. Some of its values may be missing because of problems in the file, and have their defaults.
struct ReadField {
  Field field;
  FieldFacts known;
};

/// [main] Reads and checks one field, and notes each problem in the tree.
/// @param joints number of joints of the arm, 0 if unknown @param input true for a report from the arm
ReadField readField(const Tree& tree, const Report& report, size_t joints, bool input);

}  // namespace hapticd::codec
