// SPDX-License-Identifier: MIT
/// Fields of a report that stand on each other's bits.
#pragma once
#include <vector>

#include "codec/report.hpp"
#include "codec/tree.hpp"

namespace hapticd::codec {

/// True if each joint has a field of this role.
constexpr bool ofJoint(Role role) noexcept {
  return role == Role::kPosition || role == Role::kVelocity || role == Role::kTorque || role == Role::kReference;
}

/// The bits of a report that a field reads or writes, as one byte per byte of the report, without the id. For a flag (a
/// button, a fault) it is the one bit that the flag reads.
std::vector<uint8_t> bitsTaken(const Field& field, size_t report_bytes);

/// [main] Joints whose numbers have a byte that no checksum of the report covers; none where there is no checksum.
std::vector<const Field*> outsideChecksum(const Report& report);

/// [main] Notes each field that shares a bit with a joint's number, and each joint's number that shares one with
/// another field. Bits of one status byte may stand side by side.
/// @param placed of each field: its place is known, so that its bits mean something
void checkOverlaps(const Tree& fields, const Report& report, const std::vector<bool>& placed);

}  // namespace hapticd::codec
