// SPDX-License-Identifier: MIT
/// Memory without a name that is shared with another process by its descriptor. Seals keep the other side from making
/// it shorter, which would end this process with a bus error at the next access.
#pragma once
#include <cstddef>
#include <memory>
#include <utility>

#include "base/descriptors.hpp"
#include "base/result.hpp"

namespace hapticd {

class SealedMemory {
 public:
  /// All of it is allocated at once, so a size given by mistake must not take the machine's memory.
  static constexpr size_t kMostBytes = size_t{1} << 30;

  /// Who may write apart from this process.
  enum class Writers {
    kAll,  ///< everybody who gets the descriptor
    kOne   ///< nobody: no further writable mapping can be made, and write() is refused
  };

  /// [main] The memory is zeroed, touched, and locked if possible. @param name for /proc, at most 200 bytes
  static Result<std::unique_ptr<SealedMemory>> create(const char* name, size_t bytes, Writers writers);
  ~SealedMemory();
  SealedMemory(const SealedMemory&) = delete;
  SealedMemory& operator=(const SealedMemory&) = delete;

  std::byte* data() const noexcept { return data_; }  ///< page-aligned
  size_t bytes() const noexcept { return bytes_; }    ///< in whole pages, at least as much as was asked for
  /// A descriptor to be passed on, which may outlive the object.
  Result<Descriptor> share() const;

 private:
  SealedMemory(Descriptor fd, std::byte* data, size_t bytes) : fd_(std::move(fd)), data_(data), bytes_(bytes) {}
  Descriptor fd_;
  std::byte* data_;
  size_t bytes_;
};

}  // namespace hapticd
