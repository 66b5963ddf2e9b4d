// SPDX-License-Identifier: MIT
/// Gives a report constant fields for its framing marks (the start and the end byte), so that the codec writes them
/// even if the device file has no fields there.
#pragma once
#include "codec/tree.hpp"
#include "codec/wire.hpp"

namespace hapticd::codec {

/// [main] Adds a constant field for each mark that no field writes. Notes a problem for each other field that uses the
/// byte of a mark, because such a report could not be found in the stream of input, or could not be sent. Call it when
/// all fields are known.
/// @param tree the report in the file
/// @param framed true if the report is found by its marks, or is escaped between them; if false, other fields may use
/// the bytes of the marks
void placeMarks(const Tree& tree, const Framing& framing, bool framed, Report& report);

}  // namespace hapticd::codec
