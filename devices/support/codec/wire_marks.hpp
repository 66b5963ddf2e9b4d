// SPDX-License-Identifier: MIT
/// Gives a report constant fields for its framing marks (the start and the end byte), so that the codec writes them
/// even if the device file has no fields there.
#pragma once
#include <vector>

#include "codec/tree.hpp"
#include "codec/wire.hpp"
#include "codec/wire_overlap.hpp"

namespace hapticd::codec {

/// [main] Adds a constant field for each mark that no field writes. Notes a problem for each other field that uses the
/// byte of a mark, because such a report could not be found in the stream of input, or could not be sent.
/// @param tree the report in the file
/// @param known for each field of the report; a field whose position is unknown is not checked
/// @param sized false if the size of the report is unknown, so that the end mark has no place
/// @param framed true if the report is found by its marks, or is escaped between them; if false, other fields may use
/// the bytes of the marks
void placeMarks(const Tree& tree, const Framing& framing, bool framed, const std::vector<FieldFacts>& known, bool sized,
                Report& report);

}  // namespace hapticd::codec
