// SPDX-License-Identifier: MIT
/// Memory without a file name that is shared with another process by its descriptor. Seals keep the other process from
/// making the memory shorter; otherwise the next access would end this process with a bus error.
#pragma once
#include <cstddef>
#include <memory>
#include <utility>

#include "base/descriptors.hpp"
#include "base/result.hpp"

namespace hapticd {

class SealedMemory {
 public:
  /// Largest size [bytes]. All of the memory is allocated at once, so a size that is wrong must not use up the
  /// machine's memory.
  static constexpr size_t kMostBytes = size_t{1} << 30;

  /// Which processes may write, besides this one.
  enum class Writers {
    kAll,  ///< every process that gets the descriptor
    kOne   ///< no other process: no further writable mapping can be made, and write() is refused
  };

  /// [main] Makes memory that is zeroed, present, and locked if possible. @param name the name that /proc shows, at
  /// most 200 bytes
  static Result<std::unique_ptr<SealedMemory>> create(const char* name, size_t bytes, Writers writers);
  ~SealedMemory();
  SealedMemory(const SealedMemory&) = delete;
  SealedMemory& operator=(const SealedMemory&) = delete;

  std::byte* data() const noexcept { return data_; }  ///< page-aligned
  size_t bytes() const noexcept { return bytes_; }    ///< whole pages, at least the size asked for
  /// Returns a new descriptor for another process; it may outlive the object.
  Result<Descriptor> share() const;

 private:
  SealedMemory(Descriptor fd, std::byte* data, size_t bytes) : fd_(std::move(fd)), data_(data), bytes_(bytes) {}
  Descriptor fd_;
  std::byte* data_;
  size_t bytes_;
};

}  // namespace hapticd
