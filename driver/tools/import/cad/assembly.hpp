// SPDX-License-Identifier: MIT
/// Reads the assembly tree of an XCAF document.
#pragma once
#include <TDocStd_Document.hxx>

#include "cad_import/cad_file.hpp"

namespace hapticd::cad {

/// [main] Appends the shapes of a document with their names, colours and poses. @throws CadError
void readTree(const Handle(TDocStd_Document) & document, CadFile& file);

/// [main] Appends a shape: one node for each of its solids, for each free shell, and for its loose faces together. If
/// these are several nodes, an assembly holds them.
void addShape(const TopoDS_Shape& shape, Node node, CadFile& file);

}  // namespace hapticd::cad
