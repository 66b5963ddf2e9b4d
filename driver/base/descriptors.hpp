// SPDX-License-Identifier: MIT
/// Open files that are handed to another process over a Unix socket (SCM_RIGHTS): the receiver may use what the sender
/// was allowed to open, without a right of its own to the name.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace hapticd {

/// An open file that is closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) noexcept : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor();

  int get() const noexcept { return fd_; }
  int release() noexcept { return std::exchange(fd_, -1); }
  explicit operator bool() const noexcept { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

constexpr size_t kMostDescriptors = 250;  ///< most in one message; the kernel takes 253

/// [any] Sends bytes and, with the first of them, descriptors; they stay open here. Blocks if the socket does.
/// @return bytes that were sent, which on a stream may be fewer; -1 with errno
std::ptrdiff_t sendWith(int socket, std::string_view bytes, std::span<const int> descriptors) noexcept;

/// [any] Receives bytes and appends the descriptors that came with them, closed on exec.
/// @return bytes, 0: the other end has closed; -1 with errno, EMSGSIZE: there were more descriptors than one message
/// may bring, and all of them were closed
std::ptrdiff_t receiveWith(int socket, std::span<char> to, std::vector<Descriptor>& descriptors);

}  // namespace hapticd
