// SPDX-License-Identifier: MIT
/// Follows the black box of a running servo and writes every row to a file, in an ordinary thread. The servo never
/// waits for it: it has as long as the black box keeps a row, seconds, and what it misses is counted.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "base/os.hpp"
#include "base/result.hpp"
#include "record/flight_ring.hpp"
#include "record/recording_file.hpp"

namespace hapticd::record {

class Recorder {
 public:
  /// [main] Creates the file.
  static Result<std::unique_ptr<Recorder>> create(const FlightRing& ring, const std::string& file);
  ~Recorder() { stop(); }

  std::error_code start();  ///< [main] starts to follow the black box in a thread of its own

  /// [main] Copies what is there now. Runs in virtual time call it between ticks, often enough to lose nothing.
  void drain();

  /// [main] Ends the thread, copies the rest, closes the file. @return what went wrong with the file
  Result<void> finish();

  uint64_t rows(size_t stream) const { return recording_->rows(stream); }  ///< [main] after finish()
  uint64_t lost() const;                                                   ///< [main] rows of all streams together
  /// [any] True if the black box may overwrite rows that are not yet in the file, unless the servo waits.
  bool behind() const noexcept HSP_RT;
  /// [any] True if the file cannot be written, so that nothing more is recorded; finish() says why.
  bool failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  Recorder(const FlightRing& ring, std::unique_ptr<RecordingFile> recording);
  void stop();
  void follow(size_t stream, uint64_t end);

  const FlightRing& ring_;
  std::unique_ptr<RecordingFile> recording_;
  std::vector<std::atomic<uint64_t>> next_;  ///< row of each stream
  std::vector<std::byte> rows_;
  std::string error_;
  std::atomic<bool> stop_{false}, failed_{false};
  os::Thread thread_;
};

}  // namespace hapticd::record
