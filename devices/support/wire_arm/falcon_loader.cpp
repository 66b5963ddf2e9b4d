// SPDX-License-Identifier: MIT
#include "wire_arm/falcon_loader.hpp"

#include <algorithm>
#include <array>

#include "base/regular_file.hpp"
#include "codec/framer.hpp"

namespace hapticd::wire_arm {
namespace {

constexpr size_t kLargestFirmware = 1u << 20;  ///< [bytes]
constexpr size_t kPacket = 64, kHeader = 2;  ///< [bytes] FTDI's chips begin each packet with two bytes of modem status
constexpr Nanoseconds kAnswer = 20'000'000, kRunning = 50'000'000;  ///< longest waits for an answer, for a report
constexpr int kHelloTries = 100;                                    ///< most tries of the first two messages

/// Requests of FTDI's chips: 0 resets, 1 sets the modem lines, 3 sets the baud rate, 4 sets the format of a byte, 9
/// sets the latency timer.
enum : uint8_t { kReset = 0, kLines = 1, kBaud = 3, kDataFormat = 4, kLatency = 9 };
constexpr uint8_t kVendorOut = 0x40;

class Loader {
 public:
  Loader(Transport& transport, const std::vector<uint8_t>& firmware) : transport_(transport), firmware_(firmware) {}

  bool upload() {
    return setSlowRate() && handshake() && setFastRate() && answers({0x41}, {0x41}, kHelloTries) && chunks();
  }

  /// Sets the serial line up for reports: 1 ms latency, full speed.
  bool run() { return set(kLatency, 1) && set(kBaud, 0x2) && set(kLines, 0x0101); }

  void forget() {
    size_t size = 0;
    std::array<uint8_t, 512> scrap;
    for (int i = 0; i < 64 && transport_.receive(scrap, size, 0) == Status::kOk; ++i) {
    }
  }

 private:
  bool set(uint8_t request, uint16_t value) {
    codec::StartStep step;
    step.is_control = true;
    step.request_type = kVendorOut, step.request = request, step.value = value;
    return transport_.control(step) == Status::kOk;
  }
  bool setSlowRate() {  // resets the chip, then sets 9600 8N1 (divisor 0x4138), RTS low, DTR low and then high
    return set(kReset, 0) && set(kReset, 1) && set(kReset, 2) && set(kLatency, 16) && set(kBaud, 0x4138) &&
           set(kDataFormat, 8) && set(kLines, 0x0200) && set(kLines, 0x0100) && set(kLines, 0x0101);
  }
  bool handshake() { return answers({0x0a, 0x43, 0x0d}, {0x0a, 0x44, 0x2c, 0x0d}, kHelloTries); }
  bool setFastRate() { return set(kLines, 0x0100) && set(kBaud, 0x15); }  // sets 140000 baud

  /// Sends the bytes again and again until the expected answer comes.
  bool answers(const std::vector<uint8_t>& bytes, const std::vector<uint8_t>& expected, int tries) {
    for (int i = 0; i < tries; ++i) {
      if (transport_.send(bytes) != Status::kOk) return false;
      if (receiveExpected(expected)) return true;
    }
    return false;
  }

  bool receiveExpected(const std::vector<uint8_t>& expected) {
    const Nanoseconds until = monotonicNow() + kAnswer;
    size_t matched = 0;
    while (matched < expected.size() && monotonicNow() < until) {
      size_t size = 0;
      std::array<uint8_t, 512> got;
      const Status status = transport_.receive(got, size, 1'000'000);
      if (status != Status::kOk && status != Status::kNothing) return false;
      for (size_t i = 0; i < size && matched < expected.size(); ++i) {
        if (i % kPacket < kHeader) continue;
        if (got[i] != expected[matched]) return false;
        ++matched;
      }
    }
    return matched == expected.size();
  }

  bool chunks() {
    for (size_t at = 0; at < firmware_.size(); at += kFalconChunk) {
      const size_t end = std::min(firmware_.size(), at + kFalconChunk);
      const std::vector<uint8_t> chunk(firmware_.begin() + static_cast<std::ptrdiff_t>(at),
                                       firmware_.begin() + static_cast<std::ptrdiff_t>(end));
      if (transport_.send(chunk) != Status::kOk || !receiveExpected(chunk)) return false;
    }
    return true;
  }

  Transport& transport_;
  const std::vector<uint8_t>& firmware_;
};

/// Returns whether firmware runs in the Falcon: it then answers commands with reports.
bool alreadyRuns(Transport& transport, const codec::Wire& wire) {
  std::array<uint8_t, codec::kMaxReportBytes> command{}, got{};
  const size_t bytes = codec::encode(wire.output, codec::Order{}, command);
  codec::Framer framer(wire.framing, wire.input.bytes());
  const Nanoseconds until = monotonicNow() + kRunning;
  bool runs = false;
  while (!runs && monotonicNow() < until) {
    if (transport.send({command.data(), bytes}) != Status::kOk) return false;
    size_t size = 0;
    if (transport.receive(got, size, 5'000'000) != Status::kOk) continue;
    framer.take({got.data(), size}, [&](std::span<const uint8_t> report) {
      codec::State state;
      runs = runs || codec::decode(wire.input, report, state) == codec::Verdict::kGood;
    });
  }
  return runs;
}

}  // namespace

Result<std::vector<uint8_t>> readFalconFirmware(const std::string& file) {
  const auto image = readRegular(file, kLargestFirmware);  // no device either: /dev/zero never ends
  if (!image) return Error{file + ": " + image.error() + "; expected the Falcon's firmware image"};
  if (image->empty()) return Error{file + ": is empty, expected the Falcon's firmware image"};
  return std::vector<uint8_t>(image->begin(), image->end());
}

Result<void> loadFalcon(Transport& transport, const codec::Wire& wire, const std::vector<uint8_t>& firmware) {
  Loader loader(transport, firmware);
  if (loader.run() && alreadyRuns(transport, wire)) return {};
  if (firmware.empty())
    return Error{
        "the Falcon has no firmware in its memory\n  it forgets its firmware without power, and hapticd does not "
        "include the firmware\n"
        "  fix: name the image of the maker's driver as `firmware: FILE` in the device file"};
  for (int i = 0; i < kFalconTries; ++i) {
    loader.forget();
    if (loader.upload() && loader.run() && alreadyRuns(transport, wire)) return {};
  }
  return Error{"the Falcon did not accept the firmware in " + std::to_string(kFalconTries) +
               " tries\n  the arm stays off\n  fix: unplug its power and USB, plug both in again; check the image"};
}

}  // namespace hapticd::wire_arm
