// SPDX-License-Identifier: MIT
/// The playback of a recording for one page: present time, speed and loop.
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "daemon.hpp"
#include "row_source.hpp"

namespace hapticd::view {

class Playback {
 public:
  /// [main] Starts at the beginning and plays. @param rows must outlive this object @param about describes the
  /// recording
  Playback(const RowSource& rows, const Json& about);

  static bool knows(const std::string& word);  ///< [any] true for play, pause and seek
  /// [main] Executes a request: {"do": "play", "speed": 1, "loop": true}, {"do": "pause"} or {"do": "seek", "t":
  /// seconds}. @return an error, or ""
  std::string execute(const Json& request);

  void advance();                     ///< [main] advances by the time since the last call
  double time() const { return t_; }  ///< [s] [main] present time of the playback
  /// [main] number of rows of each stream up to the present time
  const std::vector<uint64_t>& ends() const { return ends_; }
  /// [main] Returns for each stream the number of its first row in the last `seconds` [s] before the present time.
  std::vector<uint64_t> rowsFrom(double seconds) const;

  bool takeJumped();   ///< [main] true if the time has jumped since the last call: the page must drop earlier rows
  bool takeChanged();  ///< [main] true if the state has changed since the last call, so that the page must get it
  std::string stateJson() const;  ///< [main] {"type": "playback", ...}

 private:
  using Clock = std::chrono::steady_clock;
  double timeOf(uint64_t row) const;
  uint64_t tickAt(double t) const;
  void place();

  const RowSource& rows_;
  size_t ticks_;
  uint32_t t_offset_ = 0;
  double from_ = 0, to_ = 0, t_ = 0, speed_ = 1;
  bool playing_ = true, loop_ = true, jumped_ = false, changed_ = false;
  Clock::time_point last_;
  std::vector<uint64_t> ends_;
};

}  // namespace hapticd::view
