// SPDX-License-Identifier: MIT
/// Converts recordings to formats of other tools.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/recording.hpp"

namespace hapticd::record {

/// What was written.
struct Exported {
  uint64_t rows = 0, bytes = 0;
};

/// A text that an MCAP file carries beside the messages.
struct Attachment {
  std::string name, media_type, text;
};

/// [main] Writes an MCAP file. Every row of every stream becomes a message of the channel /hapticd/STREAM, in the order
/// of the ticks; the description of the run becomes an attachment, before the further ones. The time of a message is
/// the start of the run plus the time of its tick.
Result<Exported> exportMcap(const Recording& recording, const std::string& file,
                            const std::vector<Attachment>& further = {});

/// [main] Writes one stream as a table with a header. Each number has as many digits as are needed to read it back
/// exactly.
Result<Exported> exportCsv(const RecordedStream& stream, const std::string& file);

}  // namespace hapticd::record
