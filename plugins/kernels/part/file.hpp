// SPDX-License-Identifier: MIT
/// Converts parts to and from the bytes of a part file (hapticd-part/1, described in driver/docs/part_file.md). No file
/// is opened here.
#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "kernels/part/check.hpp"
#include "kernels/part/part.hpp"

namespace hapticd::brep {

/// First line of a part file.
inline constexpr char kPartMagic[] = "hapticd-part/1\n";

/// [any] True if the bytes begin like a part file of any version.
bool looksLikePart(std::span<const std::byte> bytes) noexcept;

/// [main] Reads and checks a part. The bytes may be anything. Messages begin with `name`.
/// @throws PartError that says where the file is wrong and what was expected.
Part readPart(std::span<const std::byte> bytes, const std::string& name);

/// [main] Returns the bytes of a part file. Equal parts give equal bytes.
/// @throws PartError if the part breaks a rule of checkPart().
std::string writePart(const Part& part);

}  // namespace hapticd::brep
