// SPDX-License-Identifier: MIT
/// The table of `hapticd replay --csv`: what was felt in the recording, beside what the replay gives.
#pragma once
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/recording.hpp"

namespace hapticd::cli {

class ReplayedForces {
 public:
  /// A file of this kind is recognised by these columns.
  static constexpr const char* kFirstColumns = "tick,t,depth_recorded,depth_replayed,";

  /// [main] Opens `file` and writes the header. @param ticks those of the recording
  static Result<std::unique_ptr<ReplayedForces>> open(const std::string& file, const record::RecordedStream& ticks);
  ~ReplayedForces();
  ReplayedForces(const ReplayedForces&) = delete;
  ReplayedForces& operator=(const ReplayedForces&) = delete;

  /// [main] Writes one tick. @param recorded, replayed rows of the stream
  void write(const std::byte* recorded, const std::byte* replayed);

  /// [main] Closes the file. Call it once, at the end; a file that is not complete is removed.
  Result<void> close();

 private:
  ReplayedForces(std::FILE* out, std::string file, const record::RecordedStream& ticks);

  std::FILE* out_;
  std::string file_;
  const record::Column *tick_, *t_;
  std::vector<const record::Column*> compared_;
};

}  // namespace hapticd::cli
