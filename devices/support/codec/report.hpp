// SPDX-License-Identifier: MIT
/// Reports of an arm as data: which bytes mean what. Decoding and encoding are pure, allocation-free and bounded; every
/// byte sequence has an answer, and nothing that is not a finite number leaves a decoder.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/checksum.hpp"

namespace hapticd::codec {

inline constexpr size_t kMaxJoints = 16;
inline constexpr size_t kMaxReportBytes = 1024;
inline constexpr size_t kMaxButtons = 32;

enum class Type : uint8_t {
  kUnsigned,  ///< of 1 to 64 bits
  kSigned,    ///< two's complement of 2 to 64 bits
  kFloat,     ///< IEEE 754 of 32 or 64 bits
  kNibble,    ///< one character: 0x41 + four bits (Novint Falcon)
  kNibbles,   ///< four such characters, lowest four bits first: a signed 16-bit number
};

/// [any] Characters, not bits.
constexpr bool isText(Type type) noexcept {
  return type == Type::kNibble || type == Type::kNibbles;
}

enum class Role : uint8_t {
  kPosition,    ///< in: rad or m of joint `index`
  kVelocity,    ///< in: rad/s or m/s
  kTorque,      ///< in: measured; out: wanted [N m or N]
  kButton,      ///< in: bit of button `index`
  kSequence,    ///< in and out: counts reports; a second one, at the end, tells a half-written report
  kFault,       ///< in: bit, or any value but zero: the hardware reports a fault
  kCalibrated,  ///< in: positions are absolute
  kFirmware,    ///< in: must be `value`, the version that this description fits
  kConstant,    ///< in: must be `value`; out: is `value`
  kChecksum,    ///< over the bytes from `from` up to, but without, `to`
  kEnable,      ///< out: motors on
  kCalibrate,   ///< out: tells the arm to find its zero
  kReference,   ///< out: wanted position of joint `index` [rad or m]
  kFollow,      ///< out: tells the joints to go to their references
  kStarts,      ///< in: counts how often the device started; a new number means that it forgot everything
  kTime,        ///< in: clock of the arm [s], which wraps
};

/// One field of a report. SI value = raw * scale + offset, in both directions.
struct Field {
  Role role = Role::kConstant;
  Type type = Type::kUnsigned;
  uint8_t bits = 8;      ///< of a number; of text 8 a character
  uint8_t bit_skip = 0;  ///< bits of its first byte that come before it, see bits.hpp
  bool big_endian = false, wraps = false;
  int8_t bit = -1;  ///< of an integer; -1: the whole number
  uint8_t index = 0;
  uint16_t at = 0;  ///< number of the first byte, counted after the report id
  uint16_t from = 0, to = 0;
  double scale = 1, offset = 0;
  double least = 0, most = 0;  ///< raw limits of an output
  double value = 0;
  uint64_t code = 0;      ///< the bits of an integer constant
  uint64_t modulo = 0;    ///< a sequence counts from 0 to modulo - 1; 0: it uses all of its bits
  bool inverted = false;  ///< 0 in this bit means yes
  Check check;            ///< of a checksum
  /// How many bytes it touches, counted from `at`.
  size_t bytes() const noexcept { return (size_t{bit_skip} + bits + 7) / 8; }
};

/// All fields of one kind of report.
struct Report {
  int id = -1;      ///< HID report id, in front of the bytes; -1: unnumbered
  size_t size = 0;  ///< bytes without the id
  std::vector<Field> fields;
  size_t bytes() const noexcept { return size + (id >= 0 ? 1 : 0); }
};

/// What a report from the arm says.
struct State {
  std::array<double, kMaxJoints> position{}, velocity{}, torque{};
  uint32_t buttons = 0, sequence = 0, starts = 0;
  double clock = 0;  ///< [s] of the arm, which wraps
  bool has_sequence = false, has_starts = false, has_clock = false, fault = false, calibrated = false;
};

/// What a report to the arm says.
struct Order {
  std::array<double, kMaxJoints> torque{};    ///< [N m or N]; left out of the report while `enable` is false
  std::array<double, kMaxJoints> position{};  ///< [rad or m] references, obeyed while `follow` and `enable`
  bool enable = false, calibrate = false, follow = false;
  uint32_t sequence = 0;
};

enum class Verdict : uint8_t { kGood, kWrongSize, kWrongId, kWrongFirmware, kCorrupt, kTorn };

/// Smallest and greatest raw number of an integer type; of a floating one, of its finite numbers. Of more than 53 bits
/// the greatest is rounded up.
std::pair<double, double> rangeOf(Type type, unsigned bits) noexcept;

/// [any] Reads one report, with its id in front if it has one. Anything but kGood leaves `state` undefined.
/// @param wrong the field that caused a bad verdict; nullptr: the report as a whole did
Verdict decode(const Report& report, std::span<const uint8_t> bytes, State& state,
               const Field** wrong = nullptr) noexcept;

/// [any] The bits of a field of a report, given without its id; a checksum in the form of the bytes that it covers.
uint64_t codeAt(const Field& field, std::span<const uint8_t> body) noexcept;
uint64_t checksumAt(const Field& field, std::span<const uint8_t> body) noexcept;

/// [any] Writes one report, with its id in front if it has one; numbers beyond the limits of their field are clamped, a
/// torque that is not a number becomes zero. @param bytes at least report.bytes() @return bytes written
size_t encode(const Report& report, const Order& order, std::span<uint8_t> bytes) noexcept;

/// [any] Writes a report as the arm would: the opposite of decode(), for tests that make captures.
size_t encode(const Report& report, const State& state, std::span<uint8_t> bytes) noexcept;

}  // namespace hapticd::codec
