// SPDX-License-Identifier: MIT
/// The Falcon's electronics as its USB chip shows them: an FTDI serial converter, and behind it a processor that
/// forgets its firmware with its power. Published by the libnifalcon project.
#pragma once
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace hapticd::emulator {

/// What the emulated Falcon takes for its firmware; the real image is Novint's.
std::vector<uint8_t> falconImage();

class FtdiChip {
 public:
  enum class State { kAsleep, kGreeted, kLoading, kRunning };

  /// A vendor request; false: the chip stalls it.
  bool control(uint8_t request, uint16_t value);
  /// Bytes of the host. @return complete commands of 16 bytes, once the firmware runs
  std::vector<std::vector<uint8_t>> take(std::span<const uint8_t> bytes);
  /// Bytes of the firmware's report, to be sent to the host.
  void say(std::span<const uint8_t> bytes);
  /// Time goes by: the latency timer runs.
  void advance(double seconds);
  /// A packet for the host: two bytes of modem status, then data. False: nothing to send yet.
  bool packet(std::vector<uint8_t>& to);

  State state() const { return state_; }
  int uploads() const { return uploads_; }  ///< begun so far
  /// The next greetings stay unanswered, the next uploads are echoed with an error.
  void beDifficult(int deaf, int wrong_echoes) { deaf_ = deaf, wrong_echoes_ = wrong_echoes; }

 private:
  void hear(uint8_t byte);
  void load(uint8_t byte);

  State state_ = State::kAsleep;
  std::vector<uint8_t> line_, loaded_;
  std::deque<uint8_t> to_host_;
  double since_packet_ = 0, latency_ = 0.016;
  uint16_t divisor_ = 0, lines_ = 0;
  int deaf_ = 0, wrong_echoes_ = 0, uploads_ = 0;
};

}  // namespace hapticd::emulator
