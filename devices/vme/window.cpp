// SPDX-License-Identifier: MIT
#include "vme/window.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "vme/vme_user.hpp"

namespace hapticd::vme {
namespace {

std::string hex(uint64_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%llx", static_cast<unsigned long long>(number));
  return text;
}

constexpr const char* kFolder = "/dev/bus/vme/";

/// Returns whether a device node is one of the four windows to the bus that vme_user has.
bool isMaster(const std::string& node) {
  const std::string name = node.substr(std::strlen(kFolder));
  return name.size() == 2 && name[0] == 'm' && name[1] >= '0' && name[1] <= '3';
}

int bitsOf(uint32_t space) {
  return space == kA16 ? 16 : space == kA24 ? 24 : 32;
}

/// Sets a window with the driver, and reads back the window that the driver has set. @return 0, or an errno
template <class Master>
int setAndGet(int fd, unsigned long set, unsigned long get, const Place& place, Master& got) {
  Master wanted{};
  wanted.enable = 1;
  wanted.address = place.address, wanted.size = place.size;
  wanted.space = place.space, wanted.cycle = place.cycle, wanted.width = place.width;
  if (ioctl(fd, set, &wanted) != 0) return errno;
  return ioctl(fd, get, &got) == 0 ? 0 : errno;
}

std::string reasonOf(int error) {
  if (error == EINVAL)
    return "the bridge does not know this space, cycle or width, or the base is not a multiple of 64 KiB";
  if (error == EFAULT) return "the window ends beyond the address space";
  if (error == EBUSY || error == ENOMEM)
    return "the bridge has no room for the window: another window may already use these addresses";
  return std::strerror(error);
}

}  // namespace

std::string describe(const Place& place) {
  return "A" + std::to_string(bitsOf(place.space)) + " " + hex(place.address) + " (" +
         std::to_string(place.size / 1024) + " KiB, D" + std::to_string(8 * place.width) + ")";
}

Result<void> check(const Place& place) {
  std::string wrong;  // one problem a line
  const auto add = [&](const std::string& what) { wrong += (wrong.empty() ? "" : "\n") + what; };
  if (place.node.starts_with(kFolder) && !isMaster(place.node))
    add("vme.window: " + place.node + ", expected /dev/bus/vme/m0 to m3: vme_user has four windows to the bus");
  if (place.address % kGranule != 0)
    add("vme.address: " + hex(place.address) + ", expected a multiple of 64 KiB, as the bridge needs it");
  if (place.size == 0 || place.size % kGranule != 0)
    add("vme.size: " + hex(place.size) + ", expected a multiple of 64 KiB, and 64 KiB at least");
  if (!wrong.empty()) return Error{wrong};
  const uint64_t end = uint64_t{1} << bitsOf(place.space);
  if (place.address >= end || place.size > end - place.address)
    return Error{"vme.address: the window of " + hex(place.size) + " bytes at " + hex(place.address) +
                 " ends beyond A" + std::to_string(bitsOf(place.space)) + ", expected it to end at " + hex(end) +
                 " or below"};
  return {};
}

Result<void> Window::open(const Place& place) {
  close();
  fd_ = ::open(place.node.c_str(), O_RDWR | O_CLOEXEC);
  if (fd_ < 0)
    return Error{place.node + ": " + std::strerror(errno) + "\n  the arm stays off\n  fix: " +
                 (errno == ENOENT ? "modprobe vme_user bus=0, with the bridge's own driver (vme_tsi148) before it"
                                  : "install the udev rules (udev/70-hapticd.rules) and join the group haptic") +
                 "; hapticd doctor says what is missing"};
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close();  // two programs must not write torques to one arm
    return Error{place.node +
                 ": in use by another program\n  the arm stays off\n  fix: end that program, or name "
                 "another window in vme.window"};
  }
  auto pointed = point(place);
  if (!pointed) close();
  return pointed;
}

Result<void> Window::point(const Place& place) {
  PackedMaster got{};
  int error = setAndGet(fd_, kSetMaster, kGetMaster, place, got);
  bool same = got.enable != 0 && got.address == place.address && got.size == place.size;
  if (error == ENOTTY) {
    OldMaster old{};
    error = setAndGet(fd_, kSetOldMaster, kGetOldMaster, place, old);
    same = old.enable != 0 && old.address == place.address && old.size == place.size;
  }
  struct stat about{};
  file_ = error == ENOTTY && ::fstat(fd_, &about) == 0 && S_ISREG(about.st_mode);
  if (file_) return {};
  const std::string who = place.node + ": cannot be set to " + describe(place) + ": ";
  const char* fix = "\n  the arm stays off\n  fix: correct the vme keys of the device file";
  if (error == ENOTTY) return Error{who + "it is not a window of vme_user" + fix};
  if (error != 0) return Error{who + reasonOf(error) + fix};
  if (!same) return Error{who + "the bridge set it to " + hex(got.address) + ", size " + hex(got.size) + fix};
  return {};
}

void Window::close() noexcept {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

long Window::read(uint64_t offset, std::span<uint8_t> to) noexcept {
  return ::pread(fd_, to.data(), to.size(), static_cast<off_t>(offset));
}

long Window::write(uint64_t offset, std::span<const uint8_t> bytes) noexcept {
  return ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
}

}  // namespace hapticd::vme
