// SPDX-License-Identifier: MIT
/// Writes a recording that grows, in an ordinary thread. If the process is killed at any time, the file contains all
/// rows up to the last publish().
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/hdf5.hpp"
#include "record/layout.hpp"

namespace hapticd::record {

class RecordingFile {
 public:
  static constexpr uint64_t kChunkBytes = 256 * 1024;

  /// [main] Creates the file. A recording that is there already is locked, and stays as it is until the first rows are
  /// on the disk: a run that cannot start, is killed or finds no space loses no former recording. Until then the new
  /// one has the name with ".part" behind it. @param chunk_bytes approximate size of the chunks in which rows are
  /// stored
  static Result<std::unique_ptr<RecordingFile>> create(const std::string& file, const std::vector<StreamSpec>& streams,
                                                       const About& about, uint64_t chunk_bytes = kChunkBytes);
  ~RecordingFile();  ///< [main] closes the file without marking it as complete; one without rows takes nothing's place
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  /// [main] Appends rows. The next publish() makes them part of the file. After an error nothing more is written.
  Result<void> append(size_t stream, const std::byte* rows, uint64_t count);

  /// [main] Notes that rows are missing between the last appended row and the next.
  void lost(size_t stream, uint64_t count) { streams_[stream].lost += count; }

  void discard();          ///< [main] gives up a file without rows: what was there before stays, and an empty file goes
  Result<void> publish();  ///< [main] makes the appended rows part of the file
  Result<void> close();    ///< [main] publishes, marks the file as complete and closes it; fails if it is not there
                           ///< any more

  uint64_t rows(size_t stream) const { return streams_[stream].rows; }
  uint64_t lostRows(size_t stream) const { return streams_[stream].lost; }

 private:
  struct Stream {
    uint32_t row_bytes, chunk_rows;
    hdf5::ChunkIndex index;
    uint64_t rows = 0, published = 0, lost = 0, chunk_address = 0;
  };
  RecordingFile(std::string file, int fd) : file_(std::move(file)), fd_(fd) {}
  void writeBeside();
  void begin();
  void takePlace();
  Result<void> isThere() const;
  Result<void> beginChunk(Stream& stream, uint32_t number);
  uint64_t newBlock(uint32_t stream, uint64_t bytes);
  void write(uint64_t address, const void* bytes, size_t size);
  void write(uint64_t address, const std::string& bytes) { write(address, bytes.data(), bytes.size()); }
  Result<void> state() const;

  std::string file_;
  std::string part_;    ///< where the recording is until it has rows; empty if it is in its place
  std::string target_;  ///< file_ without links, if part_ is not empty
  int fd_;
  int former_fd_ = -1;  ///< holds the lock of the former recording while there is a part_
  int error_ = 0;
  bool begun_ = false;  ///< the file has the skeleton, and nothing of what was there before
  uint64_t end_ = 0;
  Skeleton skeleton_;
  std::vector<Stream> streams_;
};

}  // namespace hapticd::record
