// SPDX-License-Identifier: MIT
/// Copies every row of a running servo's black box to a file, in an ordinary thread. The servo never waits for it. The
/// black box keeps each row for some seconds. A row that is overwritten before it is copied is lost. Lost rows are
/// counted.
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

  void discard() { recording_->discard(); }  ///< [main] gives up the file, before start()

  std::error_code start();  ///< [main] starts the thread that copies rows

  /// [main] Copies all rows that are there now. Runs in virtual time call it between ticks, often enough to lose no
  /// rows.
  void drain();

  /// [main] Ends the thread, copies the remaining rows, and closes the file. @return an error if the file could not be
  /// written
  Result<void> finish();

  uint64_t rows(size_t stream) const { return recording_->rows(stream); }  ///< [main] final after finish()
  uint64_t lost() const;                                                   ///< [main] lost rows of all streams
  /// [any] True if the servo must wait, because the black box could overwrite rows that are not yet in the file.
  bool behind() const noexcept HSP_RT;
  /// [any] True if the file cannot be written, so that nothing more is recorded. finish() returns the reason.
  bool failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  Recorder(const FlightRing& ring, std::unique_ptr<RecordingFile> recording);
  void stop();
  void follow(size_t stream, uint64_t end);

  const FlightRing& ring_;
  std::unique_ptr<RecordingFile> recording_;
  std::vector<std::atomic<uint64_t>> next_;  ///< number of the next row to copy, of each stream
  std::vector<std::byte> rows_;
  std::string error_;
  std::atomic<bool> stop_{false}, failed_{false};
  os::Thread thread_;
};

}  // namespace hapticd::record
