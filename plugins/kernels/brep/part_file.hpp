// SPDX-License-Identifier: MIT
/// Part files (hapticd-part/1) from and to bytes. driver/docs/part_file.md describes the format. No file is opened
/// here.
#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "kernels/brep/part.hpp"
#include "kernels/brep/part_check.hpp"

namespace hapticd::brep {

/// First line of a part file.
inline constexpr char kPartMagic[] = "hapticd-part/1\n";

/// [any] True if bytes begin as those of a part file of any version do.
bool looksLikePart(std::span<const std::byte> bytes) noexcept;

/// [main] Reads and checks a part, whatever the bytes are. Messages begin with `name`.
/// @throws PartError that says where the file is wrong and what was expected.
Part readPart(std::span<const std::byte> bytes, const std::string& name);

/// [main] The bytes of a part file. The same part gives the same bytes.
/// @throws PartError if the part breaks a rule of checkPart().
std::string writePart(const Part& part);

}  // namespace hapticd::brep
