// SPDX-License-Identifier: MIT
#include "emulators/usb_arm.hpp"

#include <algorithm>

namespace hapticd::emulator {
namespace {

constexpr uint8_t kPacket = 64;
constexpr size_t kMostWaiting = 4;  ///< reports that a board keeps for a host that does not fetch them
constexpr double kPeriod = 0.001;   ///< [s] between reports of a board that sends by itself

uint8_t low(size_t word) {
  return static_cast<uint8_t>(word & 0xff);
}
uint8_t high(size_t word) {
  return static_cast<uint8_t>(word >> 8 & 0xff);
}

int give(const Bytes& bytes, size_t most, Bytes& data) {
  data.assign(bytes.begin(), bytes.begin() + static_cast<long>(std::min(most, bytes.size())));
  return static_cast<int>(data.size());
}

}  // namespace

Bytes hidDescriptor(const About& about) {
  return {0x06, 0x00,
          0xff, 0x09,
          0x01, 0xa1,
          0x01,  // vendor page, collection
          0x15, 0x00,
          0x26, 0xff,
          0x00, 0x75,
          0x08,  // 0 to 255, 8 bits
          0x95, low(about.input_bytes),
          0x09, 0x01,
          0x81, 0x02,  // input
          0x95, low(about.output_bytes),
          0x09, 0x02,
          0x91, 0x02,
          0xc0};  // output
}

UsbArm::UsbArm(const std::string& kind, const simulated::Parameters& hand, std::string serial)
    : arm_(kind, hand), serial_(std::move(serial)) {}

Bytes UsbArm::deviceDescriptor() const {
  const About& a = arm_.about();
  const uint8_t device_class = a.bus == Bus::kBulk ? 0xff : 0;
  return {18,
          1,
          0x00,
          0x02,
          device_class,
          0,
          0,
          kPacket,
          low(a.vendor),
          high(a.vendor),
          low(a.product),
          high(a.product),
          0x00,
          0x01,
          1,
          2,
          3,
          1};
}

Bytes UsbArm::configuration() const {
  const bool hid = arm_.about().bus == Bus::kHid;
  const uint8_t type = hid ? 3 : 2, interval = hid ? 1 : 0;
  Bytes out{9, 2, 0, 0, 1, 1, 0, 0x80, 50, 9, 4, 0, 0, 2, static_cast<uint8_t>(hid ? 3 : 0xff), 0, 0, 0};
  if (hid) {
    const size_t size = hidDescriptor(arm_.about()).size();
    out.insert(out.end(), {9, 0x21, 0x11, 0x01, 0, 1, 0x22, low(size), high(size)});
  }
  out.insert(out.end(), {7, 5, kIn, type, kPacket, 0, interval, 7, 5, kOut, type, kPacket, 0, interval});
  out[2] = low(out.size());
  return out;
}

Bytes UsbArm::stringDescriptor(int index) const {
  if (index == 0) return {4, 3, 0x09, 0x04};
  const std::string text = index == 1 ? "hapticd" : index == 2 ? arm_.about().name : serial_;
  Bytes out{static_cast<uint8_t>(2 + 2 * text.size()), 3};
  for (const char c : text) out.insert(out.end(), {static_cast<uint8_t>(c), 0});
  return out;
}

int UsbArm::descriptor(uint16_t value, size_t most, Bytes& data) const {
  switch (value >> 8) {
    case 1:
      return give(deviceDescriptor(), most, data);
    case 2:
      return give(configuration(), most, data);
    case 3:
      return (value & 0xff) > 3 ? -EPIPE : give(stringDescriptor(value & 0xff), most, data);
    case 0x22:
      return arm_.about().bus == Bus::kHid ? give(hidDescriptor(arm_.about()), most, data) : -EPIPE;
    default:
      return -EPIPE;
  }
}

int UsbArm::control(const uint8_t* setup, Bytes& data) {
  const auto value = static_cast<uint16_t>(setup[2] | setup[3] << 8);
  const size_t length = static_cast<size_t>(setup[6] | setup[7] << 8);
  switch (setup[0] << 8 | setup[1]) {
    case 0x8006:  // GET_DESCRIPTOR of the device and of an interface
    case 0x8106:
      return descriptor(value, length, data);
    case 0x8000:  // GET_STATUS
    case 0x8100:
    case 0x8200:
      return give({0, 0}, length, data);
    case 0x8008:  // GET_CONFIGURATION
      return give({1}, length, data);
    case 0x0201:  // CLEAR_FEATURE of an endpoint: the only cure of a halt
      halted_ = stalls_;
      return 0;
    case 0x0009:  // SET_CONFIGURATION, SET_INTERFACE, CLEAR_FEATURE
    case 0x010b:
    case 0x0001:
      return 0;
    case 0x210a:  // HID: SET_IDLE, SET_PROTOCOL
    case 0x210b:
      return arm_.about().bus == Bus::kHid ? 0 : -EPIPE;
    default:
      break;
  }
  if (setup[0] == 0x40 && arm_.about().bus == Bus::kFtdi && chip_.control(setup[1], value)) return 0;
  return -EPIPE;
}

void UsbArm::queue(Bytes report) {
  if (report.empty()) return;
  if (arm_.about().bus == Bus::kFtdi) return chip_.say(report);
  if (packets_.size() == kMostWaiting) packets_.pop_front();
  packets_.push_back(std::move(report));
}

void UsbArm::out(std::span<const uint8_t> bytes) {
  if (arm_.about().bus == Bus::kFtdi) {
    for (const Bytes& command : chip_.take(bytes)) {
      arm_.command(command);
      queue(arm_.report());
    }
    return;
  }
  arm_.command(bytes);
  if (!arm_.about().streams) queue(arm_.report());
}

bool UsbArm::in(Bytes& packet) {
  if (arm_.about().bus == Bus::kFtdi) return chip_.packet(packet);
  if (packets_.empty()) return false;
  packet = std::move(packets_.front());
  packets_.pop_front();
  return true;
}

void UsbArm::spoil(Fault fault) {
  stalls_ = fault == Fault::kStalled;
  halted_ = halted_ || stalls_;
  arm_.spoil(fault);
}

void UsbArm::advance(double seconds) {
  arm_.advance(seconds);
  chip_.advance(seconds);
  since_report_ += seconds;
  for (; arm_.about().streams && since_report_ >= kPeriod - 1e-9; since_report_ -= kPeriod) queue(arm_.report());
}

}  // namespace hapticd::emulator
