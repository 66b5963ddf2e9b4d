// SPDX-License-Identifier: MIT
#include "codec/report.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "codec/bits.hpp"

namespace hapticd::codec {
namespace {

constexpr uint8_t kNibbleBase = 0x41;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kTwoTo64 = 18446744073709551616.0;

bool isNibble(uint8_t c) noexcept {
  return c >= kNibbleBase && c < kNibbleBase + 16;
}

/// The content of a field: its bits, and the number that they encode, which is NaN if they encode no number.
struct Raw {
  uint64_t code = 0;
  double number = kNotANumber;
};

/// Returns how many bits the number of a field has. Text has fewer bits than its characters.
unsigned digitsOf(const Field& field) noexcept {
  return field.type == Type::kNibble ? 4 : field.type == Type::kNibbles ? 16 : field.bits;
}

double numberOf(Type type, unsigned bits, uint64_t code) noexcept {
  switch (type) {
    case Type::kUnsigned:
    case Type::kNibble:
      return static_cast<double>(code);
    case Type::kSigned:
    case Type::kNibbles:
      return static_cast<double>(static_cast<int64_t>(code << (64 - bits)) >> (64 - bits));
    case Type::kFloat:
      return bits == 32 ? static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(code)))
                        : std::bit_cast<double>(code);
  }
  return kNotANumber;
}

/// Returns the bits of a number that is in range. For an integer type the number is rounded towards zero.
uint64_t codeOf(const Field& field, double number) noexcept {
  const unsigned bits = digitsOf(field);
  if (field.type == Type::kFloat)
    return bits == 32 ? std::bit_cast<uint32_t>(static_cast<float>(number)) : std::bit_cast<uint64_t>(number);
  const bool is_signed = field.type == Type::kSigned || field.type == Type::kNibbles;
  if (!is_signed)
    return number >= std::ldexp(1, static_cast<int>(bits)) ? onesOf(bits)
           : number <= 0                                   ? 0
                                                           : static_cast<uint64_t>(number);
  // A double rounds up the greatest number of more than 53 bits, and the result would wrap to the least number.
  const double half = std::ldexp(1, static_cast<int>(bits) - 1);
  const auto most = static_cast<int64_t>(onesOf(bits - 1));
  const int64_t whole = number >= half ? most : number <= -half ? -most - 1 : static_cast<int64_t>(number);
  return static_cast<uint64_t>(whole) & onesOf(bits);
}

Raw rawOf(const Field& field, const uint8_t* bytes) noexcept {
  const uint8_t* at = bytes + field.at;
  Raw raw;
  if (!isText(field.type)) {
    raw.code = getBits(at, field.bit_skip, field.bits, field.big_endian);
  } else {
    const unsigned letters = digitsOf(field) / 4;
    for (unsigned i = 0; i < letters; ++i) {
      if (!isNibble(at[i])) return raw;
      raw.code |= static_cast<uint64_t>(at[i] - kNibbleBase) << (4 * i);
    }
  }
  raw.number = numberOf(field.type, digitsOf(field), raw.code);
  return raw;
}

void putCode(const Field& field, uint64_t code, uint8_t* bytes) noexcept {
  uint8_t* at = bytes + field.at;
  if (!isText(field.type)) return putBits(code, at, field.bit_skip, field.bits, field.big_endian);
  const unsigned letters = digitsOf(field) / 4;
  for (unsigned i = 0; i < letters; ++i) at[i] = static_cast<uint8_t>(kNibbleBase + (code >> (4 * i) & 15));
}

void putNumber(const Field& field, double number, uint8_t* bytes) noexcept {
  putCode(field, codeOf(field, number), bytes);
}

/// Sets one bit and keeps the other bits, because several fields may share the bytes.
void putBit(const Field& field, bool on, uint8_t* bytes) noexcept {
  if (isText(field.type) && bytes[field.at] == 0) putCode(field, 0, bytes);  // as text, zero is a letter
  if (on != field.inverted) putCode(field, rawOf(field, bytes).code | uint64_t{1} << field.bit, bytes);
}

/// Writes yes or no, as one bit or as the whole number of the field.
void putFlag(const Field& field, bool on, uint8_t* bytes) noexcept {
  return field.bit >= 0 ? putBit(field, on, bytes) : putNumber(field, on != field.inverted ? field.value : 0, bytes);
}

uint64_t sumOf(const Field& field, const uint8_t* bytes) noexcept {
  return checksumOf(field.check, {bytes + field.from, static_cast<size_t>(field.to - field.from)});
}

/// True if the bit of a field is set, or its number is not zero. The opposite if the field is inverted.
bool isSet(const Field& field, const Raw& raw) noexcept {
  return (field.bit < 0 ? raw.number != 0 : (raw.code >> field.bit & 1) != 0) != field.inverted;
}

bool isValue(const Field& field, const Raw& raw) noexcept {
  return field.type == Type::kFloat ? raw.number == field.value : raw.code == field.code;
}

/// Takes the flag of a button, of a fault or of calibration. If any fault field is set, the report has a fault.
void takeFlag(const Field& field, bool set, State& state) noexcept {
  if (field.role == Role::kButton && set) state.buttons |= 1u << field.index;
  if (field.role == Role::kFault && set) state.fault = true;
  if (field.role == Role::kCalibrated) state.calibrated = set;
}

/// Takes a sequence number. If two sequence numbers of one report differ, the report is torn (half-written).
Verdict takeSequence(const Field& field, uint64_t code, State& state) noexcept {
  const auto sequence = static_cast<uint32_t>(code);
  if (field.modulo != 0 && code >= field.modulo) return Verdict::kCorrupt;
  if (state.has_sequence && sequence != state.sequence) return Verdict::kTorn;
  state.sequence = sequence;
  state.has_sequence = true;
  return Verdict::kGood;
}

/// Checks a field whose content is known in advance: a firmware version, a constant or a checksum.
Verdict judge(const Field& field, const Raw& raw, const uint8_t* bytes) noexcept {
  const bool good = field.role == Role::kChecksum ? raw.code == sumOf(field, bytes) : isValue(field, raw);
  if (good) return Verdict::kGood;
  return field.role == Role::kFirmware ? Verdict::kWrongFirmware : Verdict::kCorrupt;
}

Verdict take(const Field& field, const uint8_t* bytes, State& state) noexcept {
  const Raw raw = rawOf(field, bytes);
  const double value = raw.number * field.scale + field.offset;
  if (!std::isfinite(value)) return Verdict::kCorrupt;
  switch (field.role) {
    case Role::kPosition:
      state.position[field.index] = value;
      break;
    case Role::kVelocity:
      state.velocity[field.index] = value;
      break;
    case Role::kTorque:
      state.torque[field.index] = value;
      break;
    case Role::kSequence:
      return takeSequence(field, raw.code, state);
    case Role::kStarts:
      state.starts = static_cast<uint32_t>(raw.code);
      state.has_starts = true;
      break;
    case Role::kTime:
      state.clock = value;
      state.has_clock = true;
      break;
    case Role::kButton:
    case Role::kFault:
    case Role::kCalibrated:
      takeFlag(field, isSet(field, raw), state);
      break;
    case Role::kFirmware:
    case Role::kConstant:
    case Role::kChecksum:
      return judge(field, raw, bytes);
    case Role::kEnable:
    case Role::kCalibrate:
    case Role::kReference:
    case Role::kFollow:
      break;
  }
  return Verdict::kGood;
}

double clampRaw(const Field& field, double value) noexcept {
  const double raw = (value - field.offset) / field.scale;
  if (!std::isfinite(raw))
    return std::clamp(std::isfinite(value) ? 0.0 : -field.offset / field.scale, field.least, field.most);
  return std::clamp(field.type == Type::kFloat ? raw : std::nearbyint(raw), field.least, field.most);
}

/// An integer position that overflows continues at the other end of its type.
double wrapRaw(const Field& field, double value) noexcept {
  const double raw = std::nearbyint((value - field.offset) / field.scale);
  const auto [least, most] = rangeOf(field.type, field.bits);
  const double turns = std::floor((raw - least) / (most - least + 1));
  return std::isfinite(turns) ? std::clamp(raw - turns * (most - least + 1), least, most) : clampRaw(field, value);
}

void putConstant(const Field& field, uint8_t* bytes) noexcept {
  return field.type == Type::kFloat ? putNumber(field, field.value, bytes) : putCode(field, field.code, bytes);
}

void putSequence(const Field& field, uint32_t sequence, uint8_t* bytes) noexcept {
  putCode(field, field.modulo != 0 ? sequence % field.modulo : sequence, bytes);
}

/// A clock restarts at zero when its bits are full.
void putClock(const Field& field, double clock, uint8_t* bytes) noexcept {
  const double raw = field.type == Type::kFloat ? clock / field.scale : std::nearbyint(clock / field.scale);
  const double turn = std::ldexp(1, static_cast<int>(digitsOf(field)));
  putNumber(field, field.type == Type::kFloat ? raw : std::fmod(std::max(raw, 0.0), turn), bytes);
}

/// Writes one field as the arm would send it.
void put(const Field& field, const State& state, uint8_t* bytes) noexcept {
  const auto flag = [&](bool on) {
    field.bit >= 0 ? putBit(field, on, bytes) : putNumber(field, on != field.inverted ? 1 : 0, bytes);
  };
  switch (field.role) {
    case Role::kPosition: {
      const double q = state.position[field.index];
      return putNumber(field, field.wraps ? wrapRaw(field, q) : clampRaw(field, q), bytes);
    }
    case Role::kVelocity:
      return putNumber(field, clampRaw(field, state.velocity[field.index]), bytes);
    case Role::kTorque:
      return putNumber(field, clampRaw(field, state.torque[field.index]), bytes);
    case Role::kButton:
      return flag((state.buttons >> field.index & 1) != 0);
    case Role::kFault:
      return flag(state.fault);
    case Role::kCalibrated:
      return flag(state.calibrated);
    case Role::kSequence:
      return putSequence(field, state.sequence, bytes);
    case Role::kStarts:
      return putCode(field, state.starts, bytes);
    case Role::kTime:
      return putClock(field, state.clock, bytes);
    case Role::kConstant:
    case Role::kFirmware:
      return putConstant(field, bytes);
    default:
      return;
  }
}

void put(const Field& field, const Order& order, uint8_t* bytes) noexcept {
  const double torque = order.enable ? order.torque[field.index] : 0;
  switch (field.role) {
    case Role::kTorque:
      return putNumber(field, clampRaw(field, torque), bytes);
    case Role::kSequence:
      return putSequence(field, order.sequence, bytes);
    case Role::kConstant:
    case Role::kFirmware:
      return putConstant(field, bytes);
    case Role::kReference:
      return putNumber(field, clampRaw(field, order.position[field.index]), bytes);
    case Role::kFollow:
      return putFlag(field, order.enable && order.follow, bytes);
    case Role::kEnable:
      return putFlag(field, order.enable, bytes);
    case Role::kCalibrate:
      return putFlag(field, order.calibrate, bytes);
    default:
      return;
  }
}

}  // namespace

std::pair<double, double> rangeOf(Type type, unsigned bits) noexcept {
  switch (type) {
    case Type::kUnsigned:
      return {0, bits >= 64 ? kTwoTo64 : static_cast<double>(onesOf(bits))};
    case Type::kSigned:
      return {-std::ldexp(1, static_cast<int>(bits) - 1),
              bits >= 64 ? kTwoTo64 / 2 : static_cast<double>(onesOf(bits - 1))};
    case Type::kNibble:
      return {0, 15};
    case Type::kNibbles:
      return {-32768, 32767};
    case Type::kFloat: {
      const double most =
          bits == 32 ? static_cast<double>(std::numeric_limits<float>::max()) : std::numeric_limits<double>::max();
      return {-most, most};
    }
  }
  return {0, 0};
}

Verdict decode(const Report& report, std::span<const uint8_t> bytes, State& state, const Field** wrong) noexcept {
  if (wrong != nullptr) *wrong = nullptr;
  if (report.id >= 0) {
    if (bytes.empty()) return Verdict::kWrongSize;
    if (bytes[0] != report.id) return Verdict::kWrongId;
    bytes = bytes.subspan(1);
  }
  if (bytes.size() != report.size) return Verdict::kWrongSize;
  state = State{};
  for (const Field& field : report.fields) {
    const Verdict verdict = take(field, bytes.data(), state);
    if (verdict == Verdict::kGood) continue;
    if (wrong != nullptr) *wrong = &field;
    return verdict;
  }
  return Verdict::kGood;
}

uint64_t codeAt(const Field& field, std::span<const uint8_t> body) noexcept {
  return rawOf(field, body.data()).code;
}

uint64_t checksumAt(const Field& field, std::span<const uint8_t> body) noexcept {
  return sumOf(field, body.data());
}

namespace {

template <class Put>
size_t write(const Report& report, std::span<uint8_t> bytes, const Put& put) noexcept {
  const size_t total = report.bytes();
  if (bytes.size() < total) return 0;
  std::memset(bytes.data(), 0, total);
  uint8_t* body = bytes.data();
  if (report.id >= 0) *body++ = static_cast<uint8_t>(report.id);
  for (const Field& field : report.fields)
    if (field.role != Role::kChecksum) put(field, body);
  for (const Field& field : report.fields)  // checksums last, because they cover the other fields
    if (field.role == Role::kChecksum) putCode(field, sumOf(field, body), body);
  return total;
}

}  // namespace

size_t encode(const Report& report, const Order& order, std::span<uint8_t> bytes) noexcept {
  return write(report, bytes, [&](const Field& field, uint8_t* body) { put(field, order, body); });
}

size_t encode(const Report& report, const State& state, std::span<uint8_t> bytes) noexcept {
  return write(report, bytes, [&](const Field& field, uint8_t* body) { put(field, state, body); });
}

}  // namespace hapticd::codec
