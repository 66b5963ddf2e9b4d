// SPDX-License-Identifier: MIT
/// Finds what the reader of a STEP file could not make, and what it had to assume.
#pragma once
#include <STEPCAFControl_Reader.hxx>
#include <XSControl_WorkSession.hxx>

#include "cad_import/cad_file.hpp"

namespace hapticd::cad {

inline constexpr const char* kNoUnit =
    "the file states no unit of length that can be read: millimetres were assumed; is the size right? If not, import "
    "it with --scale: 25.4 for inches, 10 for centimetres, 1000 for metres";

/// [main] Appends a loss for each face of a STEP file without a shape, with the reader's reason.
/// @param to_mm millimetres per unit of the coordinates in the file
void findLostFaces(const Handle(XSControl_WorkSession) & session, double to_mm, std::vector<brep::Loss>& losses);

/// [main] Appends a loss for each solid of a STEP file that is no boundary: extruded, turned, or made of primitives.
void findMadeSolids(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses);

/// [main] Appends a loss for each copy (mapped item) of a STEP file that is mirrored or scaled. Open CASCADE turns and
/// moves it only.
void findChangedCopies(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses);

/// [main] Appends a loss for each entity that other entities of a STEP file refer to, but that the file does not
/// contain.
void findMissingEntities(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses);

/// [main] Appends a loss for each file that a STEP file names as the place of a part, and that cannot be read.
void findMissingFiles(const STEPCAFControl_Reader& reader, std::vector<brep::Loss>& losses);

/// [main] Appends a remark for each unit of a STEP file that Open CASCADE could not read, because it then assumes one,
/// and one for points, curves and surfaces that it could not read in full.
void findOddEntities(const Handle(XSControl_WorkSession) & session, std::vector<std::string>& remarks);

}  // namespace hapticd::cad
