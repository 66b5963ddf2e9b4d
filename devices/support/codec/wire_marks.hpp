// SPDX-License-Identifier: MIT
/// The marks of framing as bytes of a report: the codec writes them, whether or not the file has a constant there.
#pragma once
#include "codec/tree.hpp"
#include "codec/wire.hpp"

namespace hapticd::codec {

/// [main] Adds a constant for each mark that no field has written, and notes fields that stand on a mark as something
/// else: no such report could be found in the stream, or sent. Call it when all fields are known.
/// @param tree of the report
/// @param framed the report is found by its marks or escaped between them; otherwise its own first and last fields
/// count
void placeMarks(const Tree& tree, const Framing& framing, bool framed, Report& report);

}  // namespace hapticd::codec
