// SPDX-License-Identifier: MIT
#include "session/replay/replayable.hpp"

#include <algorithm>
#include <string_view>

namespace hapticd::servo {

namespace {

using record::Column;
using record::RecordedStream;

/// True for streams that recordings of version 0.1 do not have.
bool isLater(const std::string& stream) {
  static constexpr std::string_view kLater[] = {"leads", "events", "pushes", "links", "motors"};
  return std::find(std::begin(kLater), std::end(kLater), stream) != std::end(kLater);
}

}  // namespace

std::string missingIn(const record::Recording& recording, const RecordedRun& run,
                      const std::vector<record::StreamSpec>& wanted) {
  for (const record::StreamSpec& spec : wanted) {
    if (spec.name == "marks") continue;  // they are neither repeated nor compared, and once had fewer columns
    const RecordedStream* stream = recording.stream(spec.name);
    if (stream == nullptr && isLater(spec.name)) continue;  // the recording is older than this stream
    if (stream == nullptr) return "has no " + spec.name;
    if (stream->lost() > 0)
      return "lacks " + std::to_string(stream->lost()) + " rows of " + spec.name +
             (recording.blackBox() ? ": a black box keeps only the newest rows; record with --record" : "");
    if (stream->rowBytes() != spec.layout.rowBytes())
      return "has rows of " + spec.name + " with " + std::to_string(stream->rowBytes()) + " bytes, expected " +
             std::to_string(spec.layout.rowBytes()) + ": replay it with the hapticd that recorded it";
    for (const Column& column : spec.layout.columns()) {
      const Column* found = stream->find(column.name);
      if (found == nullptr || found->offset != column.offset || found->type != column.type)
        return "has no column " + column.name + " of " + spec.name +
               " at the place where this hapticd expects it: replay it with the hapticd that recorded it";
    }
  }
  const RecordedStream& ticks = *recording.stream("ticks");
  if (ticks.rows() == 0) return "has no ticks";
  if (ticks.number(0, *ticks.find("tick")) != 0)
    return "begins in the middle of a run; record from the start with --record";
  return run.devices.empty() ? "names no device" : "";
}

}  // namespace hapticd::servo
