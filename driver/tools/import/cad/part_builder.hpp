// SPDX-License-Identifier: MIT
/// Builds a part from a CAD file. Each body is stored once, with an instance for each place where it is used.
#pragma once
#include "cad_import/cad_file.hpp"
#include "cad_import/report.hpp"

namespace hapticd::cad {

/// [main] Heals and converts every body of a file. The caller fills in Source::file and sha256. @throws CadError if
/// nothing of the file can be kept.
brep::Part buildPart(CadFile& file, Report& report);

}  // namespace hapticd::cad
