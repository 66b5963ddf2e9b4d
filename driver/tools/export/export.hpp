// SPDX-License-Identifier: MIT
/// Recordings for other tools.
#pragma once
#include <cstdint>
#include <string>

#include "base/result.hpp"
#include "record/recording.hpp"

namespace hapticd::record {

/// What was written.
struct Exported {
  uint64_t rows = 0, bytes = 0;
};

/// [main] Every row of every stream as a message of its channel, /hapticd/STREAM, in the order of their ticks; the
/// description as an attachment. Times are the run's start plus the tick's own time.
Result<Exported> exportMcap(const Recording& recording, const std::string& file);

/// [main] Writes one stream as a table with a header, with 17 digits per number.
Result<Exported> exportCsv(const RecordedStream& stream, const std::string& file);

}  // namespace hapticd::record
