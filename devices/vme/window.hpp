// SPDX-License-Identifier: MIT
/// One master window of a VME bridge: a part of the bus that read and write at an offset reach. A plain file may stand
/// in for it, so that everything above runs without a bus.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "base/result.hpp"

namespace hapticd::vme {

/// Where on the bus, and how it is addressed.
struct Place {
  std::string node;  ///< /dev/bus/vme/m0 to m3, or a plain file
  uint64_t address = 0, size = 0x10000;
  uint32_t space = 2, width = 2, cycle = 0xA001;  ///< A24, D16, single user data cycles: numbers of vme_user
};

/// [main] Nothing, or in words what the bridge or the bus would refuse.
Result<void> check(const Place& place);
/// [any] Describes it: "A24 0x100000 (64 KiB, D16)".
std::string describe(const Place& place);

/// [main] or one I/O thread at a time, since every function is a system call.
class Window {
 public:
  Window() = default;
  ~Window() { close(); }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Opens the node for this process alone and points the window at its place on the bus.
  Result<void> open(const Place& place);
  void close() noexcept;
  bool isOpen() const noexcept { return fd_ >= 0; }
  /// There is no bus: a plain file stands in for it.
  bool isFile() const noexcept { return file_; }

  /// Bytes that were transferred; fewer than asked for at the window's end, 0 where no window is set, -1 with errno.
  long read(uint64_t offset, std::span<uint8_t> to) noexcept;
  long write(uint64_t offset, std::span<const uint8_t> bytes) noexcept;

 private:
  Result<void> point(const Place& place);
  int fd_ = -1;
  bool file_ = false;
};

}  // namespace hapticd::vme
