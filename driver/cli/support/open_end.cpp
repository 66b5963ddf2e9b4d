// SPDX-License-Identifier: MIT
#include "cli/support/open_end.hpp"

#include <cstdio>

namespace hapticd::cli {

void noteOpenEnd(const std::string& file, const record::Recording& recording, const char* doing) {
  if (recording.closed()) return;
  std::string why = "the recording ends early because its writer was killed, or its disk was full";
  if (recording.blackBox()) why = "a black box: the last seconds of a run that was killed, or that still runs";
  if (const auto writer = recording.writer())
    why = "is still being written by " + (*writer > 0 ? "process " + std::to_string(*writer) : "another process");
  std::fprintf(stderr, "note: %s: %s; %s what is there\n", file.c_str(), why.c_str(), doing);
}

}  // namespace hapticd::cli
