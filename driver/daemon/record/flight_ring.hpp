// SPDX-License-Identifier: MIT
/// The black box: the newest rows of every stream in memory. The servo thread writes it without a lock, and any other
/// thread or process may read it. Its memory can be a mapped file, which outlives the process: after a crash, this file
/// is a valid recording.
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
  /// [main] Allocates and touches all memory. @param file path in a memory file system (/run, /dev/shm), so that no
  /// write waits for a disk; if it is empty, the memory belongs to this process only
  static Result<std::unique_ptr<FlightRing>> create(const std::vector<StreamSpec>& streams, const About& about,
                                                    const std::string& file = "");
  ~FlightRing();
  FlightRing(const FlightRing&) = delete;
  FlightRing& operator=(const FlightRing&) = delete;

  /// [rt] Returns the row to fill next. Only one thread may write a stream.
  std::byte* next(size_t stream) noexcept HSP_RT {
    return reinterpret_cast<std::byte*>(streams_[stream].filled.data());
  }
  /// [rt] Returns the address to which commit() will copy the row of next(), so that the caller can prefetch this
  /// memory into the cache.
  const std::byte* place(size_t stream) const noexcept HSP_RT {
    return streams_[stream].rows + streams_[stream].position * streams_[stream].row_bytes;
  }
  /// [rt] Called when the row is complete: makes it visible to readers.
  void commit(size_t stream) noexcept HSP_RT {
    Stream& s = streams_[stream];
    // Release on each word: a reader that sees a word of the new row also sees the count before it, and so knows that
    // the old row in this place is being overwritten.
    std::byte* row = s.rows + s.position * s.row_bytes;
    for (size_t i = 0; i < s.filled.size(); ++i)
      std::atomic_ref<uint64_t>(reinterpret_cast<uint64_t*>(row)[i]).store(s.filled[i], std::memory_order_release);
    s.position = s.position + 1 == s.capacity ? 0 : s.position + 1;
    std::atomic_ref<uint64_t>(s.header->rows).store(++s.written, std::memory_order_release);
  }

  /// [any] Returns the number of rows written since the start.
  uint64_t written(size_t stream) const noexcept {
    return std::atomic_ref<uint64_t>(streams_[stream].header->rows).load(std::memory_order_acquire);
  }
  uint64_t capacity(size_t stream) const noexcept { return streams_[stream].capacity; }
  uint32_t rowBytes(size_t stream) const noexcept { return streams_[stream].row_bytes; }

  /// [any] Copies up to `count` rows, beginning at row number `first`. @return how many were copied completely; 0 if
  /// row `first` has been overwritten
  uint64_t copy(size_t stream, uint64_t first, uint64_t count, std::byte* rows) const noexcept;

  const std::vector<StreamSpec>& specs() const { return specs_; }
  const About& about() const { return about_; }

  /// [main] Writes the rows that are in the ring now to a recording, oldest first. The servo continues meanwhile.
  Result<void> dump(const std::string& file) const;

  /// [any] Returns the memory of the ring. It is a valid recording at any time, so a signal handler can write it to a
  /// file with write(2).
  const std::byte* image() const noexcept { return memory_; }
  size_t imageBytes() const noexcept { return bytes_; }

  /// [main] Tells programs that have mapped the file that the run ended in order. It stays in their memory, even if
  /// another run takes the name.
  void noteEnd() noexcept;
  void removeFile();  ///< [main] removes the file; called if the run ended well

 private:
  struct Stream {
    StreamHeader* header = nullptr;
    std::byte* rows = nullptr;
    uint32_t row_bytes = 0;
    uint64_t capacity = 0, position = 0, written = 0;
    std::vector<uint64_t> filled;  ///< words of the row that is being filled
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
