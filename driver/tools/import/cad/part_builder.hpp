// SPDX-License-Identifier: MIT
/// A part of a CAD file: bodies once, instances wherever they stand.
#pragma once
#include "cad_import/cad_file.hpp"
#include "cad_import/report.hpp"

namespace hapticd::cad {

/// [main] Heals and converts every body of a file. The caller fills in Source::file and sha256. @throws CadError if
/// nothing is left of it.
brep::Part buildPart(CadFile& file, Report& report);

}  // namespace hapticd::cad
