// SPDX-License-Identifier: MIT
/// The black box: the newest rows of every stream in memory, written by the servo thread without a lock and read by any
/// other thread or process. Kept in a mapped file, it outlives the process: what a crash leaves is itself a
/// recording that needs no more writing.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "hapticd/abi.h"
#include "record/layout.hpp"

namespace hapticd::record {

class FlightRing {
 public:
  /// [main] Allocates and touches everything. @param file in a memory file system (/run, /dev/shm), so that it never
  /// waits for a disk; empty: memory of this process alone
  static Result<std::unique_ptr<FlightRing>> create(const std::vector<StreamSpec>& streams, const About& about,
                                                    const std::string& file = "");
  ~FlightRing();
  FlightRing(const FlightRing&) = delete;
  FlightRing& operator=(const FlightRing&) = delete;

  /// [rt] The row to fill next. Only one thread writes a stream.
  std::byte* next(size_t stream) noexcept HSP_RT {
    return reinterpret_cast<std::byte*>(streams_[stream].filled.data());
  }
  /// [rt] Where that row will be, so that it can be fetched into the cache before it is written.
  const std::byte* place(size_t stream) const noexcept HSP_RT {
    return streams_[stream].rows + streams_[stream].position * streams_[stream].row_bytes;
  }
  /// [rt] The row is complete, so readers may have it.
  void commit(size_t stream) noexcept HSP_RT {
    Stream& s = streams_[stream];
    // Release on each word: a reader that sees a word also sees the count before it, and knows whose place it took.
    std::byte* row = s.rows + s.position * s.row_bytes;
    for (size_t i = 0; i < s.filled.size(); ++i)
      std::atomic_ref<uint64_t>(reinterpret_cast<uint64_t*>(row)[i]).store(s.filled[i], std::memory_order_release);
    s.position = s.position + 1 == s.capacity ? 0 : s.position + 1;
    std::atomic_ref<uint64_t>(s.header->rows).store(++s.written, std::memory_order_release);
  }

  /// [any] Rows ever written.
  uint64_t written(size_t stream) const noexcept {
    return std::atomic_ref<uint64_t>(streams_[stream].header->rows).load(std::memory_order_acquire);
  }
  uint64_t capacity(size_t stream) const noexcept { return streams_[stream].capacity; }
  uint32_t rowBytes(size_t stream) const noexcept { return streams_[stream].row_bytes; }

  /// [any] Copies up to `count` rows from number `first` on. @return how many are complete; 0: `first` was overwritten
  uint64_t copy(size_t stream, uint64_t first, uint64_t count, std::byte* rows) const noexcept;

  const std::vector<StreamSpec>& specs() const { return specs_; }
  const About& about() const { return about_; }

  /// [main] Writes the rows that are kept now as a recording file, oldest first. The servo continues meanwhile.
  Result<void> dump(const std::string& file) const;

  /// [any] The memory of the ring, which is a valid recording at any time. A signal handler can write(2) it to a file.
  const std::byte* image() const noexcept { return memory_; }
  size_t imageBytes() const noexcept { return bytes_; }

  void removeFile();  ///< [main] a run that ended well leaves nothing behind

 private:
  struct Stream {
    StreamHeader* header = nullptr;
    std::byte* rows = nullptr;
    uint32_t row_bytes = 0;
    uint64_t capacity = 0, position = 0, written = 0;
    std::vector<uint64_t> filled;  ///< number of the row that is being written
  };
  FlightRing() = default;
  std::vector<StreamSpec> specs_;
  About about_;
  std::string file_;
  std::byte* memory_ = nullptr;
  size_t bytes_ = 0;
  std::vector<Stream> streams_;
};

}  // namespace hapticd::record
