// SPDX-License-Identifier: MIT
/// The bytes of a recording: those of a file, or memory. A file is read and not mapped, because the kernel kills a
/// program whose mapped file another program cuts.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/result.hpp"

namespace hapticd::record {

class RecordedBytes {
 public:
  /// [main] Opens a regular file. The errors are meant to follow its name.
  static Result<std::unique_ptr<RecordedBytes>> open(const std::string& file);
  /// [main] @param memory must outlive the object
  explicit RecordedBytes(std::span<const std::byte> memory) : memory_(memory), size_(memory.size()) {}
  ~RecordedBytes();
  RecordedBytes(const RecordedBytes&) = delete;
  RecordedBytes& operator=(const RecordedBytes&) = delete;

  uint64_t size() const { return size_; }  ///< [bytes] when the file was opened
  /// Returns the id of the process that was still writing the file when it was opened, see writerOf().
  std::optional<int> writer() const { return writer_; }

  /// [main] Reads bytes. Returns false, and fills the rest with zeros, if they are no longer there.
  bool read(uint64_t address, void* to, size_t bytes) const;

  /// [main] Reads a value; nothing if it is not there.
  template <class T>
  std::optional<T> at(uint64_t address) const {
    T value;
    if (address > size_ || size_ - address < sizeof value || !read(address, &value, sizeof value)) return std::nullopt;
    return value;
  }

  /// [main] Fails if the file was cut, or changed by another program than its writer, since it was opened: what was
  /// read of it since then may be wrong. The error is meant to follow the file's name.
  Result<void> unchanged() const;

 private:
  RecordedBytes() = default;

  std::span<const std::byte> memory_;
  uint64_t size_ = 0;
  int fd_ = -1;
  int64_t changed_ns_ = 0;  ///< when the file was changed last
  std::optional<int> writer_;
  mutable bool cut_ = false;
};

}  // namespace hapticd::record
