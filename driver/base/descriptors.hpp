// SPDX-License-Identifier: MIT
/// Open files that are passed to another process over a Unix socket (SCM_RIGHTS). The receiver may use a file that the
/// sender could open, even if the receiver itself has no right to open it by name.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace hapticd {

/// An open file; the destructor closes it.
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

constexpr size_t kMostDescriptors = 250;  ///< largest number in one message; the kernel's limit is 253

/// [any] Sends bytes and, with the first byte, descriptors, which stay open in this process. It blocks if the socket is
/// a blocking one.
/// @return how many bytes were sent; on a stream socket, they may be fewer than given; -1 on failure, with errno
std::ptrdiff_t sendWith(int socket, std::string_view bytes, std::span<const int> descriptors) noexcept;

/// [any] Receives bytes and appends the descriptors that came with them, closed on exec.
/// @return how many bytes came; 0 if the other process has closed the connection; -1 on failure, with errno. EMSGSIZE
/// means that there were more descriptors than one message may bring, and that all of them were closed
std::ptrdiff_t receiveWith(int socket, std::span<char> to, std::vector<Descriptor>& descriptors);

}  // namespace hapticd
