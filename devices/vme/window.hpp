// SPDX-License-Identifier: MIT
/// One master window of a VME bridge: a part of the bus that a program reads and writes through a file. A plain file
/// can replace it, so that all other code runs without a bus.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "base/result.hpp"

namespace hapticd::vme {

/// The place of a window on the bus, and the kind of access to it.
struct Place {
  std::string node;  ///< /dev/bus/vme/m0 to m3, or a plain file
  uint64_t address = 0, size = 0x10000;
  uint32_t space = 2, width = 2, cycle = 0xA001;  ///< vme_user's numbers; by default A24, D16, single user data cycles
};

/// [main] Returns an error text if the bridge or the bus would refuse this place.
Result<void> check(const Place& place);
/// [any] Describes a place for messages, such as "A24 0x100000 (64 KiB, D16)".
std::string describe(const Place& place);

/// A window that a program has opened. [main] or one I/O thread may call its functions, but never both at once. The
/// servo thread may not, because each function makes a system call.
class Window {
 public:
  Window() = default;
  ~Window() { close(); }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Opens the node for this process only, and sets the window to its place on the bus.
  Result<void> open(const Place& place);
  void close() noexcept;
  bool isOpen() const noexcept { return fd_ >= 0; }
  /// Returns whether a plain file is used instead of a bus.
  bool isFile() const noexcept { return file_; }

  /// Returns the number of transferred bytes, which is smaller than wanted at the end of the window, 0 if no window is
  /// set, or -1 with errno.
  long read(uint64_t offset, std::span<uint8_t> to) noexcept;
  long write(uint64_t offset, std::span<const uint8_t> bytes) noexcept;

 private:
  Result<void> point(const Place& place);
  int fd_ = -1;
  bool file_ = false;
};

}  // namespace hapticd::vme
