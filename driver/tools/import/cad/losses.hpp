// SPDX-License-Identifier: MIT
/// Faces that stand in a STEP or IGES file and that its reader could not make.
#pragma once
#include <XSControl_WorkSession.hxx>

#include "cad_import/cad_file.hpp"

namespace hapticd::cad {

/// [main] Appends a loss for each face of the file without a shape, with the reader's reason.
/// @param to_mm millimetres per unit of the coordinates that the file states
void findLostFaces(const Handle(XSControl_WorkSession) & session, double to_mm, std::vector<brep::Loss>& losses);

/// [main] Appends a loss for each entity to which others of a STEP file refer, but which is missing from it.
void findMissingEntities(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses);

}  // namespace hapticd::cad
