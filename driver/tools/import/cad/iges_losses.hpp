// SPDX-License-Identifier: MIT
/// Finds what the reader of an IGES file left out, often without a word of its own.
#pragma once
#include <XSControl_WorkSession.hxx>
#include <vector>

#include "kernels/part/part.hpp"

namespace hapticd::cad {

/// [main] Appends a loss for each surface, solid and subfigure of an IGES file that gave no shape, with the reason.
void findLostIges(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses);

}  // namespace hapticd::cad
