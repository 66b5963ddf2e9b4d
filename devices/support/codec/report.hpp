// SPDX-License-Identifier: MIT
/// The layout of an arm's reports as data. Decoding and encoding are pure functions that allocate nothing and take
/// bounded time. Every byte sequence gets a verdict, and only finite numbers are decoded.
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
  kUnsigned,  ///< unsigned integer of 1 to 64 bits
  kSigned,    ///< two's complement of 2 to 64 bits
  kFloat,     ///< IEEE 754 of 32 or 64 bits
  kNibble,    ///< one character: 0x41 + four bits (Novint Falcon)
  kNibbles,   ///< four such characters, lowest four bits first: a signed 16-bit number
};

/// [any] True for types that are written as characters.
constexpr bool isText(Type type) noexcept {
  return type == Type::kNibble || type == Type::kNibbles;
}

enum class Role : uint8_t {
  kPosition,    ///< in: position of joint `index` [rad or m]
  kVelocity,    ///< in: velocity of joint `index` [rad/s or m/s]
  kTorque,      ///< in: measured torque; out: wanted torque [N m or N]
  kButton,      ///< in: bit of button `index`
  kSequence,    ///< in and out: counts reports; a second such field at the end shows a half-written report
  kFault,       ///< in: the hardware reports a fault if the bit is set, or the number is not zero
  kCalibrated,  ///< in: positions are absolute if the bit is set, or the number is not zero
  kFirmware,    ///< in: firmware version, which must be `value`
  kConstant,    ///< in: must be `value`; out: is `value`
  kChecksum,    ///< checksum of the bytes from `from` to `to` - 1
  kEnable,      ///< out: motors on
  kCalibrate,   ///< out: tells the arm to find its zero
  kReference,   ///< out: wanted position of joint `index` [rad or m]
  kFollow,      ///< out: tells the joints to go to their references
  kStarts,      ///< in: counts how often the device started; after a start it has forgotten its zero
  kTime,        ///< in: clock of the arm [s], which wraps at the end of its range
};

/// One field of a report. SI value = raw * scale + offset, in both directions.
struct Field {
  Role role = Role::kConstant;
  Type type = Type::kUnsigned;
  uint8_t bits = 8;      ///< number of bits; a text has 8 per character
  uint8_t bit_skip = 0;  ///< number of bits of the first byte that come before the field, see bits.hpp
  bool big_endian = false, wraps = false;
  int8_t bit = -1;  ///< the one bit of the integer that is used; -1 for the whole number
  uint8_t index = 0;
  uint16_t at = 0;  ///< number of the first byte, counted after the report id
  uint16_t from = 0, to = 0;
  double scale = 1, offset = 0;
  double least = 0, most = 0;  ///< raw limits of an output
  double value = 0;
  uint64_t code = 0;      ///< the bits of an integer constant
  uint64_t modulo = 0;    ///< a sequence counts from 0 to modulo - 1; 0 if it uses all of its bits
  bool inverted = false;  ///< true if a bit of 0 means yes
  bool sound = true;  ///< false if something is wrong with the field in the file, so that others are not compared to it
  Check check;        ///< method of a checksum
  /// Returns how many bytes the field touches, counted from `at`.
  size_t bytes() const noexcept { return (size_t{bit_skip} + bits + 7) / 8; }
  /// True for a field that has a wrong value if the bytes are not this report.
  bool judges() const noexcept { return role == Role::kChecksum || role == Role::kConstant || role == Role::kFirmware; }
};

/// All fields of one kind of report.
struct Report {
  int id = -1;      ///< HID report id, which comes before the other bytes; -1 if there is none
  size_t size = 0;  ///< bytes without the id
  std::vector<Field> fields;
  /// true if every field of the file could be read; only then it is certain which roles the report does not have
  bool whole = false;
  bool placed = false;  ///< true if, moreover, the size of the report and the place of every field are known
  size_t bytes() const noexcept { return size + (id >= 0 ? 1 : 0); }
  /// Returns the first field of a role, or nullptr if there is none.
  const Field* find(Role role) const noexcept {
    for (const Field& field : fields)
      if (field.role == role) return &field;
    return nullptr;
  }
  bool has(Role role) const noexcept { return find(role) != nullptr; }
};

/// The content of a report from the arm.
struct State {
  std::array<double, kMaxJoints> position{}, velocity{}, torque{};
  uint32_t buttons = 0, sequence = 0, starts = 0;
  double clock = 0;  ///< [s] clock of the arm, which wraps
  bool has_sequence = false, has_starts = false, has_clock = false, fault = false, calibrated = false;
};

/// The content of a report to the arm.
struct Order {
  std::array<double, kMaxJoints> torque{};    ///< [N m or N]; left out of the report while `enable` is false
  std::array<double, kMaxJoints> position{};  ///< [rad or m] references, obeyed while `follow` and `enable`
  bool enable = false, calibrate = false, follow = false;
  uint32_t sequence = 0;
};

enum class Verdict : uint8_t { kGood, kWrongSize, kWrongId, kWrongFirmware, kCorrupt, kTorn };

/// Returns the smallest and the greatest raw number of an integer type, or the smallest and the greatest finite number
/// of a floating type. The greatest number of more than 53 bits is rounded up.
std::pair<double, double> rangeOf(Type type, unsigned bits) noexcept;

/// [any] Reads one report, with its id in front if it has one. If the verdict is not kGood, `state` is undefined.
/// @param wrong becomes the field that caused a bad verdict, or nullptr if the report as a whole caused it
Verdict decode(const Report& report, std::span<const uint8_t> bytes, State& state,
               const Field** wrong = nullptr) noexcept;

/// [any] codeAt() returns the bits of a field, and checksumAt() computes the checksum that the field should hold.
/// @param body the report without its id
uint64_t codeAt(const Field& field, std::span<const uint8_t> body) noexcept;
uint64_t checksumAt(const Field& field, std::span<const uint8_t> body) noexcept;

/// [any] Writes one report, with its id in front if it has one. A number beyond the limits of its field is clamped, and
/// a torque that is NaN becomes zero. @param bytes room for at least report.bytes() @return number of bytes written
size_t encode(const Report& report, const Order& order, std::span<uint8_t> bytes) noexcept;

/// [any] Writes a report as the arm would send it. This is the inverse of decode(), for tests and made-up captures.
size_t encode(const Report& report, const State& state, std::span<uint8_t> bytes) noexcept;

}  // namespace hapticd::codec
