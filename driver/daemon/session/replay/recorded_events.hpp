// SPDX-License-Identifier: MIT
/// The events of a recording in words, as the log of the run had them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "record/recording.hpp"
#include "session/replay/about.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::servo {

struct RecordedMessage {
  double t = 0;           ///< [s] since the first tick
  uint32_t kind = 0;      ///< HAPTICD_TOUCH, ...
  int level = 0;          ///< HSP_LOG_DEBUG, ...
  std::string who, text;  ///< the model or the arm; empty if the text names it
};

/// [main] Returns the events that have words, in order. @param models those of this recording
std::vector<RecordedMessage> messagesOf(const record::Recording& recording, const RecordedRun& run,
                                        const RunModels& models);

}  // namespace hapticd::servo
