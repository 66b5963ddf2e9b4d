// SPDX-License-Identifier: MIT
/// Finds fields of a report that use the same bits.
#pragma once
#include <vector>

#include "codec/report.hpp"
#include "codec/tree.hpp"

namespace hapticd::codec {

/// True for roles that belong to one joint, such as its position.
constexpr bool ofJoint(Role role) noexcept {
  return role == Role::kPosition || role == Role::kVelocity || role == Role::kTorque || role == Role::kReference;
}

/// Which facts about a field are known. The others are missing because of problems in the file.
struct FieldFacts {
  bool role = false;    ///< what the field is, and that such a field may be in this report
  bool target = false;  ///< also the number of its joint or button
  bool type = false;    ///< its type
  bool placed = false;  ///< its type and its position in the report
  bool all = false;     ///< everything: the file has no problem in this field
};

/// Returns a mask of the bits of a report that a field reads or writes: one byte for each byte of the report, without
/// the id. For a flag (a button, a fault) only the bit that the flag reads is set.
std::vector<uint8_t> bitsTaken(const Field& field, size_t report_bytes);

/// [main] Returns the fields of joints with a byte that no checksum of the report covers. Returns none if the report
/// has no checksum.
std::vector<const Field*> outsideChecksum(const Report& report);

/// [main] Notes a problem for each field of a joint that shares a bit with another field: at its place, or at the type
/// of a field that is so wide that others begin in it. Flags may share a status byte.
/// @param known for each field of the report; a field whose role or position is unknown is not checked
void checkOverlaps(const Tree& fields, const Report& report, const std::vector<FieldFacts>& known);

}  // namespace hapticd::codec
