// SPDX-License-Identifier: MIT
#include "usb_hid/hid_transport.hpp"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>

namespace hapticd::wire_arm {
namespace {

/// hidapi has process-wide variables (its initialisation, its last error text), so only one thread at a time may call
/// it.
std::mutex& libraryMutex() {
  static std::mutex mutex;
  return mutex;
}

std::string narrow(const wchar_t* text) {
  std::string out;
  for (; text != nullptr && *text != 0; ++text) out += *text < 128 ? static_cast<char>(*text) : '?';
  return out;
}

/// Returns the kernel's number of a HID device, such as "0003:1234:0006.0007". Its last part is new each time the
/// device is plugged in.
std::string epochOf(const std::string& node) {
  std::error_code error;
  const auto link = std::filesystem::read_symlink(
      "/sys/class/hidraw/" + std::filesystem::path(node).filename().string() + "/device", error);
  return error ? node : link.filename().string();
}

/// Returns the USB port of a HID device, such as "1-2.3"; "" for one that is not on USB.
std::string portOf(const std::string& node) {
  std::error_code error;
  const auto link =
      std::filesystem::read_symlink("/sys/class/hidraw/" + std::filesystem::path(node).filename().string(), error);
  return error ? "" : usbPortOf(link.string());
}

class HidTransport final : public Transport {
 public:
  HidTransport() {
    const std::lock_guard lock(libraryMutex());
    hid_init();
  }
  ~HidTransport() override { HidTransport::close(); }

  Result<Identity> open(const Address& address, const codec::Wire& wire) override {
    const std::lock_guard lock(libraryMutex());
    numbered_ = wire.output.id >= 0;
    hid_device_info* all = hid_enumerate(address.vendor, address.product);
    std::string refused, others;
    Identity identity;
    for (hid_device_info* at = all; at != nullptr && handle_ == nullptr; at = at->next) {
      const std::string serial = narrow(at->serial_number);
      const std::string port = portOf(at->path);
      others += (others.empty() ? "" : ", ") + factsOf(serial, port);
      if (!address.serial.empty() && address.serial != serial) continue;
      if (!address.port.empty() && address.port != port) continue;
      if (address.interface >= 0 && at->interface_number >= 0 && at->interface_number != address.interface) continue;
      if (!takeAlone(at->path, refused)) continue;
      node_ = at->path;
      handle_ = hid_open_path(at->path);
      if (handle_ == nullptr) {
        refused = "cannot be opened: " + std::string(at->path) + ": " + std::strerror(errno);
        release();
        continue;
      }
      char release_text[16];
      std::snprintf(release_text, sizeof release_text, "%x.%02x", at->release_number >> 8, at->release_number & 0xff);
      identity = {serial, narrow(at->product_string), release_text, epochOf(at->path)};
    }
    hid_free_enumeration(all);
    if (handle_ != nullptr) return identity;
    return Error{notOpened("HID", address, refused, others)};
  }

  void close() noexcept override {
    if (handle_ != nullptr) hid_close(handle_);
    handle_ = nullptr;
    release();
  }

  Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept override {
    constexpr Nanoseconds kMillisecond = 1'000'000;
    const int got =
        hid_read_timeout(handle_, to.data(), to.size(), static_cast<int>((wait + kMillisecond - 1) / kMillisecond));
    size = got > 0 ? static_cast<size_t>(got) : 0;
    if (got > 0) return Status::kOk;
    return got == 0 ? Status::kNothing : Status::kGone;  // for hidapi, any error means that the device is gone
  }

  Status send(std::span<const uint8_t> bytes) noexcept override {
    const size_t shift = numbered_ ? 0 : 1;  // hidapi needs a report id in front of each report
    if (bytes.size() + shift > out_.size()) return Status::kFailed;
    out_[0] = 0;
    std::memcpy(out_.data() + shift, bytes.data(), bytes.size());
    errno = 0;
    if (hid_write(handle_, out_.data(), bytes.size() + shift) >= 0) return Status::kOk;
    return errno == EPIPE ? Status::kStalled : Status::kGone;
  }

  Status control(const codec::StartStep&) noexcept override { return Status::kFailed; }

  /// Opens the node again without the lock. A process that held the lock would keep this program from opening the
  /// device.
  Descriptor openForSilence(hdv_silence& how) noexcept override {
    how.kind = HDV_BY_WRITE;
    how.size = numbered_ ? 0 : 1;  // hidraw needs a report id in front of each report
    return Descriptor(::open(node_.c_str(), O_RDWR | O_CLOEXEC | O_NOCTTY));
  }

 private:
  /// Opens the node and takes an advisory lock, so that a second hapticd cannot write torques to the same arm.
  bool takeAlone(const char* node, std::string& refused) {
    lock_ = ::open(node, O_RDWR | O_CLOEXEC | O_NOCTTY);
    const bool mine = lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) == 0;
    if (mine || (lock_ >= 0 && errno != EWOULDBLOCK)) return true;
    refused = lock_ >= 0 ? "is in use by another program: " + std::string(node)
                         : "cannot be opened: " + std::string(node) + ": " + std::strerror(errno);
    release();
    return false;
  }
  void release() noexcept {
    if (lock_ >= 0) ::close(lock_);
    lock_ = -1;
  }

  hid_device* handle_ = nullptr;
  std::string node_;
  int lock_ = -1;
  bool numbered_ = false;
  std::array<uint8_t, codec::kMaxReportBytes + 2> out_{};
};

}  // namespace

std::unique_ptr<Transport> makeHidTransport() {
  return std::make_unique<HidTransport>();
}

}  // namespace hapticd::wire_arm
