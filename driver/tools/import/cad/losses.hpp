// SPDX-License-Identifier: MIT
/// Finds faces of a STEP or IGES file that the reader could not convert.
#pragma once
#include <XSControl_WorkSession.hxx>

#include "cad_import/cad_file.hpp"

namespace hapticd::cad {

/// [main] Appends a loss for each face of the file without a shape, with the reader's reason.
/// @param to_mm millimetres per unit of the coordinates in the file
void findLostFaces(const Handle(XSControl_WorkSession) & session, double to_mm, std::vector<brep::Loss>& losses);

/// [main] Appends a loss for each entity that other entities of a STEP file refer to, but that the file does not
/// contain.
void findMissingEntities(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses);

}  // namespace hapticd::cad
