// SPDX-License-Identifier: MIT
#include "usb_bulk/bulk_transport.hpp"

#include <fcntl.h>
#include <libusb.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>

namespace hapticd::wire_arm {
namespace {

constexpr size_t kReads = 4;                     ///< number of read transfers that wait for the device at any time
constexpr size_t kBuffer = 512;                  ///< [bytes] size of a transfer: one high-speed packet
constexpr Nanoseconds kWriteHangs = 15'000'000;  ///< [ns] a device that takes no command in this time has stalled
constexpr unsigned kControlTimeout = 1000;       ///< [ms] longest time of a control transfer
constexpr Nanoseconds kCancelled = 500'000'000;  ///< [ns] longest wait; the kernel returns cancelled transfers earlier

/// Returns the port of a device, such as "1-2.3".
std::string portOf(libusb_device* device) {
  constexpr int kDeepest = 7;  // ports of hubs behind each other, by the USB 3 specification
  std::array<uint8_t, kDeepest> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), kDeepest);
  std::string text;
  for (int i = 0; i < count; ++i) text += (i == 0 ? "-" : ".") + std::to_string(ports[static_cast<size_t>(i)]);
  return text.empty() ? "" : std::to_string(libusb_get_bus_number(device)) + text;
}

Status statusOf(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return Status::kOk;
    case LIBUSB_TRANSFER_STALL:
      return Status::kStalled;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return Status::kGone;
    default:
      return Status::kFailed;
  }
}

Status statusOf(int error) {
  if (error >= 0) return Status::kOk;
  if (error == LIBUSB_ERROR_NO_DEVICE) return Status::kGone;
  return error == LIBUSB_ERROR_PIPE ? Status::kStalled : Status::kFailed;
}

/// The libusb transport of one device. Each device has its own context and event loop, because libusb's locks have no
/// priority inheritance.
class BulkTransport final : public Transport {
 public:
  BulkTransport() {
    if (libusb_init(&context_) != 0) context_ = nullptr;
    for (libusb_transfer*& read : reads_) read = libusb_alloc_transfer(0);
    write_ = libusb_alloc_transfer(0);
  }
  ~BulkTransport() override {
    BulkTransport::close();
    for (libusb_transfer* read : reads_) libusb_free_transfer(read);
    libusb_free_transfer(write_);
    if (context_ != nullptr) libusb_exit(context_);
  }

  Result<Identity> open(const Address& address, const codec::Wire& wire) override {
    if (context_ == nullptr)
      return Error{
          "libusb cannot be started\n  the arm stays off\n  fix: run hapticd doctor, which says what is missing"};
    Identity identity;
    std::string refused, others;
    libusb_device** all = nullptr;
    const ssize_t count = libusb_get_device_list(context_, &all);
    for (ssize_t i = 0; i < count && handle_ == nullptr; ++i) tryOne(all[i], address, identity, refused, others);
    if (count >= 0) libusb_free_device_list(all, 1);
    if (handle_ == nullptr) return Error{notOpened("USB", address, refused, others)};
    // A halted endpoint stays halted after close(), so the host must clear the halt. It does so only after a halt,
    // because clearing also resets the data toggles.
    for (const uint8_t endpoint : {wire.endpoint_in, wire.endpoint_out})
      if (halted_) (void)libusb_clear_halt(handle_, endpoint);
    halted_ = false;
    if (const Status status = submitReads(wire); status != Status::kOk) {
      close();
      return Error{"USB device " + textOf(address) + " accepts no transfers; unplug it and plug it in again"};
    }
    endpoint_out_ = wire.endpoint_out;
    return identity;
  }

  void close() noexcept override {
    if (handle_ == nullptr) return;
    // The last command switches the motors off. It must not be cancelled while the device is busy with the one before.
    while (writing_ && broken_ == Status::kOk && monotonicNow() < written_at_ + kWriteHangs) handleEvents(1'000'000);
    closing_ = true;  // a transfer that completes from now on is not submitted again
    waiting_ = false;
    for (libusb_transfer* read : reads_) (void)libusb_cancel_transfer(read);
    if (writing_) (void)libusb_cancel_transfer(write_);
    const Nanoseconds until = monotonicNow() + kCancelled;
    while ((in_flight_ > 0 || writing_) && monotonicNow() < until) handleEvents(1'000'000);
    (void)libusb_release_interface(handle_, interface_);
    if (in_flight_ == 0 && !writing_)
      libusb_close(handle_);
    else
      orphan();
    handle_ = nullptr;
    in_flight_ = 0;
    writing_ = closing_ = false;
    first_ = filled_ = 0;
    halted_ = halted_ || broken_ == Status::kStalled;
    broken_ = Status::kOk;
  }

  Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept override {
    size = 0;
    if (filled_ == 0) handleEvents(wait);
    if (filled_ > 0) {
      const Packet& packet = packets_[first_];
      size = std::min(packet.size, to.size());
      std::memcpy(to.data(), packet.bytes.data(), size);
      first_ = (first_ + 1) % packets_.size();
      --filled_;
      return Status::kOk;
    }
    if (broken_ != Status::kOk) return broken_;
    if (writing_ && monotonicNow() > written_at_ + kWriteHangs) return Status::kStalled;
    return Status::kNothing;
  }

  /// The newest command wins: while a command is being sent, at most one waits, and a newer one replaces it.
  Status send(std::span<const uint8_t> bytes) noexcept override {
    if (bytes.size() > out_.size()) return Status::kFailed;
    if (broken_ != Status::kOk) return broken_;
    if (writing_) handleEvents(0);
    std::memcpy(next_.data(), bytes.data(), bytes.size());
    next_size_ = bytes.size();
    waiting_ = true;
    return writing_ ? Status::kOk : submitWrite();
  }

  Status control(const codec::StartStep& step) noexcept override {
    return statusOf(libusb_control_transfer(handle_, step.request_type, step.request, step.value, step.index, nullptr,
                                            0, kControlTimeout));
  }

  /// Opens the same usbfs node again: another process can claim the interface after this process has ended.
  Descriptor openForSilence(hdv_silence& how) noexcept override {
    libusb_device* device = libusb_get_device(handle_);
    char node[40];
    std::snprintf(node, sizeof node, "/dev/bus/usb/%03d/%03d", libusb_get_bus_number(device),
                  libusb_get_device_address(device));
    how.kind = HDV_BY_USB;
    how.interface = static_cast<uint32_t>(interface_);
    how.endpoint = endpoint_out_;
    return Descriptor(::open(node, O_RDWR | O_CLOEXEC));
  }

 private:
  struct Packet {
    size_t size = 0;
    std::array<uint8_t, kBuffer> bytes;
  };

  void tryOne(libusb_device* device, const Address& address, Identity& identity, std::string& refused,
              std::string& others) {
    libusb_device_descriptor about{};
    if (libusb_get_device_descriptor(device, &about) != 0) return;
    if (about.idVendor != address.vendor || about.idProduct != address.product) return;
    const std::string port = portOf(device);
    if (const int error = libusb_open(device, &handle_); error != 0) {
      handle_ = nullptr;
      const std::string why = std::string("cannot be opened: ") + libusb_strerror(static_cast<libusb_error>(error));
      others += (others.empty() ? "one at port " : ", one at port ") + port + " that " + why;
      if (address.port.empty() || address.port == port) refused = why;
      return;
    }
    const std::string serial = text(about.iSerialNumber);
    others += (others.empty() ? "" : ", ") + factsOf(serial, port);
    if ((!address.serial.empty() && serial != address.serial) || (!address.port.empty() && port != address.port)) {
      libusb_close(handle_);
      handle_ = nullptr;
      return;
    }
    (void)libusb_set_auto_detach_kernel_driver(handle_, 1);
    interface_ = std::max(0, address.interface);
    if (const int error = libusb_claim_interface(handle_, interface_); error != 0) {
      refused = (error == LIBUSB_ERROR_BUSY ? std::string("is in use: ")
                                            : "does not give its interface " + std::to_string(interface_) + ": ") +
                libusb_strerror(static_cast<libusb_error>(error));
      libusb_close(handle_);
      handle_ = nullptr;
      return;
    }
    char release[16], epoch[32];
    std::snprintf(release, sizeof release, "%x.%02x", about.bcdDevice >> 8, about.bcdDevice & 0xff);
    std::snprintf(epoch, sizeof epoch, "usb %d-%d", libusb_get_bus_number(device), libusb_get_device_address(device));
    identity = {serial, text(about.iProduct), release, epoch};
  }

  std::string text(uint8_t index) {
    std::array<unsigned char, 128> bytes{};
    if (index == 0) return "";
    const int count = libusb_get_string_descriptor_ascii(handle_, index, bytes.data(), static_cast<int>(bytes.size()));
    return count > 0 ? std::string(bytes.begin(), bytes.begin() + count) : "";
  }

  /// Returns whether the descriptors of the device describe this endpoint as an interrupt endpoint.
  bool isInterrupt(uint8_t endpoint) {
    libusb_config_descriptor* config = nullptr;
    bool interrupt = false;
    if (libusb_get_active_config_descriptor(libusb_get_device(handle_), &config) != 0) return false;
    for (int i = 0; i < config->bNumInterfaces; ++i)
      for (int j = 0; j < config->interface[i].num_altsetting; ++j)
        for (int k = 0; k < config->interface[i].altsetting[j].bNumEndpoints; ++k) {
          const libusb_endpoint_descriptor& at = config->interface[i].altsetting[j].endpoint[k];
          if (at.bEndpointAddress == endpoint) interrupt = (at.bmAttributes & 3) == LIBUSB_TRANSFER_TYPE_INTERRUPT;
        }
    libusb_free_config_descriptor(config);
    return interrupt;
  }

  Status submitReads(const codec::Wire& wire) {
    const bool in_interrupt = isInterrupt(wire.endpoint_in);
    out_interrupt_ = isInterrupt(wire.endpoint_out);
    // A packet of exactly the largest size does not end a transfer, so each transfer is one packet.
    const int packet = libusb_get_max_packet_size(libusb_get_device(handle_), wire.endpoint_in);
    const int length = packet > 0 ? std::min(packet, static_cast<int>(kBuffer)) : 64;
    for (size_t i = 0; i < kReads; ++i) {
      const auto fill = in_interrupt ? &libusb_fill_interrupt_transfer : &libusb_fill_bulk_transfer;
      fill(reads_[i], handle_, wire.endpoint_in, buffers_[i].data(), length, &onRead, this, 0);
      if (libusb_submit_transfer(reads_[i]) != 0) return Status::kFailed;
      ++in_flight_;
    }
    return Status::kOk;
  }

  Status submitWrite() noexcept {
    out_ = next_;
    waiting_ = false;
    const auto fill = out_interrupt_ ? &libusb_fill_interrupt_transfer : &libusb_fill_bulk_transfer;
    fill(write_, handle_, endpoint_out_, out_.data(), static_cast<int>(next_size_), &onWrite, this, 0);
    const int error = libusb_submit_transfer(write_);
    if (error == 0) writing_ = true, written_at_ = monotonicNow();
    return statusOf(error);
  }

  void handleEvents(Nanoseconds wait) noexcept {
    timeval time{static_cast<time_t>(wait / kNanosecondsPerSecond),
                 static_cast<suseconds_t>(wait % kNanosecondsPerSecond / 1000)};
    (void)libusb_handle_events_timeout_completed(context_, &time, nullptr);
  }

  /// If the kernel does not return a transfer, neither the transfer nor its handle is used or freed again.
  void orphan() noexcept {
    for (libusb_transfer*& read : reads_) {
      read->user_data = nullptr;
      read = libusb_alloc_transfer(0);
    }
    write_->user_data = nullptr;
    write_ = libusb_alloc_transfer(0);
  }

  static void LIBUSB_CALL onRead(libusb_transfer* transfer) {
    if (transfer->user_data == nullptr) return;
    auto& self = *static_cast<BulkTransport*>(transfer->user_data);
    --self.in_flight_;
    if (self.closing_ || transfer->status == LIBUSB_TRANSFER_CANCELLED) return;
    if (transfer->status != LIBUSB_TRANSFER_COMPLETED) {
      self.broken_ = statusOf(transfer->status);
      return;
    }
    self.keep(transfer);
    if (libusb_submit_transfer(transfer) == 0)
      ++self.in_flight_;
    else
      self.broken_ = Status::kGone;
  }

  static void LIBUSB_CALL onWrite(libusb_transfer* transfer) {
    if (transfer->user_data == nullptr) return;
    auto& self = *static_cast<BulkTransport*>(transfer->user_data);
    self.writing_ = false;
    if (self.closing_ || transfer->status == LIBUSB_TRANSFER_CANCELLED) return;
    if (transfer->status != LIBUSB_TRANSFER_COMPLETED)
      self.broken_ = statusOf(transfer->status);
    else if (self.waiting_)
      (void)self.submitWrite();
  }

  void keep(const libusb_transfer* transfer) noexcept {
    if (transfer->actual_length <= 0) return;
    if (filled_ == packets_.size()) first_ = (first_ + 1) % packets_.size(), --filled_;  // full: drops the oldest
    Packet& packet = packets_[(first_ + filled_) % packets_.size()];
    packet.size = std::min(static_cast<size_t>(transfer->actual_length), packet.bytes.size());
    std::memcpy(packet.bytes.data(), transfer->buffer, packet.size);
    ++filled_;
  }

  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  std::array<libusb_transfer*, kReads> reads_{};
  libusb_transfer* write_ = nullptr;
  std::array<std::array<uint8_t, kBuffer>, kReads> buffers_{};
  std::array<uint8_t, codec::kMaxReportBytes> out_{}, next_{};
  std::array<Packet, 16> packets_{};
  size_t first_ = 0, filled_ = 0, in_flight_ = 0, next_size_ = 0;
  Nanoseconds written_at_ = 0;
  int interface_ = 0;
  uint8_t endpoint_out_ = 0;
  bool halted_ = false;  ///< an endpoint had stalled when the device was closed
  bool writing_ = false, waiting_ = false, closing_ = false, out_interrupt_ = false;
  Status broken_ = Status::kOk;
};

}  // namespace

std::unique_ptr<Transport> makeBulkTransport() {
  return std::make_unique<BulkTransport>();
}

}  // namespace hapticd::wire_arm
