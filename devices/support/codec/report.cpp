// SPDX-License-Identifier: MIT
#include "codec/report.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace hapticd::codec {
namespace {

constexpr uint8_t kNibbleBase = 0x41;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// `count` bytes as one unsigned number.
uint64_t gather(const uint8_t* bytes, size_t count, bool big_endian) noexcept {
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[big_endian ? i : count - 1 - i];
  return value;
}

void scatter(uint64_t value, uint8_t* bytes, size_t count, bool big_endian) noexcept {
  for (size_t i = 0; i < count; ++i) {
    bytes[big_endian ? count - 1 - i : i] = static_cast<uint8_t>(value);
    value >>= 8;
  }
}

bool isNibble(uint8_t c) noexcept {
  return c >= kNibbleBase && c < kNibbleBase + 16;
}

double nibbles(const uint8_t* text) noexcept {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) {
    if (!isNibble(text[i])) return kNotANumber;
    value |= static_cast<uint32_t>(text[i] - kNibbleBase) << (4 * i);
  }
  return static_cast<int16_t>(static_cast<uint16_t>(value));
}

/// The raw number of a field; not a number where the bytes cannot be one.
double rawOf(const Field& field, const uint8_t* bytes) noexcept {
  const uint8_t* at = bytes + field.at;
  const uint64_t raw = field.type < Type::kNibble ? gather(at, sizeOf(field.type), field.big_endian) : 0;
  switch (field.type) {
    case Type::kI8:
      return static_cast<int8_t>(static_cast<uint8_t>(raw));
    case Type::kI16:
      return static_cast<int16_t>(static_cast<uint16_t>(raw));
    case Type::kI32:
      return static_cast<int32_t>(static_cast<uint32_t>(raw));
    case Type::kU8:
    case Type::kU16:
    case Type::kU32:
      return static_cast<double>(raw);
    case Type::kF32:
      return static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(raw)));
    case Type::kF64:
      return std::bit_cast<double>(raw);
    case Type::kNibble:
      return isNibble(*at) ? *at - kNibbleBase : kNotANumber;
    case Type::kNibbles:
      return nibbles(at);
  }
  return kNotANumber;
}

void putRaw(const Field& field, double raw, uint8_t* bytes) noexcept {
  uint8_t* at = bytes + field.at;
  if (field.type == Type::kF32)
    return scatter(std::bit_cast<uint32_t>(static_cast<float>(raw)), at, 4, field.big_endian);
  if (field.type == Type::kF64) return scatter(std::bit_cast<uint64_t>(raw), at, 8, field.big_endian);
  const auto whole = static_cast<uint64_t>(static_cast<int64_t>(raw));
  if (field.type == Type::kNibble) {
    *at = static_cast<uint8_t>(kNibbleBase + (whole & 15));
  } else if (field.type == Type::kNibbles) {
    for (size_t i = 0; i < 4; ++i) at[i] = static_cast<uint8_t>(kNibbleBase + (whole >> (4 * i) & 15));
  } else {
    scatter(whole, at, sizeOf(field.type), field.big_endian);
  }
}

/// Sets one bit of what the bytes of a field hold already; several fields share the bytes.
void putBit(const Field& field, bool on, uint8_t* bytes) noexcept {
  if (field.type == Type::kNibble && bytes[field.at] == 0)
    putRaw(field, 0, bytes);  // a nibble of no bits is a letter too
  if (on == field.inverted) return;
  const auto whole = static_cast<uint64_t>(static_cast<int64_t>(rawOf(field, bytes)));
  putRaw(field, static_cast<double>(whole | uint64_t{1} << field.bit), bytes);
}

/// Yes or no, as a bit or as the field's value.
void putFlag(const Field& field, bool on, uint8_t* bytes) noexcept {
  return field.bit >= 0 ? putBit(field, on, bytes) : putRaw(field, on ? field.value : 0, bytes);
}

uint32_t checksumOf(const Field& field, const uint8_t* bytes) noexcept {
  uint32_t sum = field.method == Checksum::kCrc16 ? 0xffff : 0;
  for (size_t i = field.from; i < field.to; ++i) {
    if (field.method == Checksum::kSum8) sum = (sum + bytes[i]) & 0xff;
    if (field.method == Checksum::kXor8) sum ^= bytes[i];
    if (field.method != Checksum::kCrc16) continue;
    sum ^= static_cast<uint32_t>(bytes[i]) << 8;  // CRC-16/CCITT-FALSE
    for (int bit = 0; bit < 8; ++bit) sum = ((sum & 0x8000) != 0 ? sum << 1 ^ 0x1021 : sum << 1) & 0xffff;
  }
  return sum;
}

/// A bit of a field, or whether its number is something else than zero.
bool isSet(const Field& field, double raw) noexcept {
  if (field.bit < 0) return raw != 0;
  const auto whole = static_cast<uint64_t>(static_cast<int64_t>(raw));
  return ((whole >> field.bit & 1) != 0) != field.inverted;
}

Verdict take(const Field& field, const uint8_t* bytes, State& state) noexcept {
  const double raw = rawOf(field, bytes);
  const double value = raw * field.scale + field.offset;
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
    case Role::kButton:
      if (isSet(field, raw)) state.buttons |= 1u << field.index;
      break;
    case Role::kSequence: {
      const auto sequence = static_cast<uint32_t>(static_cast<int64_t>(raw));
      if (state.has_sequence && sequence != state.sequence) return Verdict::kTorn;
      state.sequence = sequence;
      state.has_sequence = true;
      break;
    }
    case Role::kStarts:
      state.starts = static_cast<uint32_t>(static_cast<int64_t>(raw));
      state.has_starts = true;
      break;
    case Role::kFault:
      state.fault = state.fault || isSet(field, raw);
      break;
    case Role::kCalibrated:
      state.calibrated = isSet(field, raw);
      break;
    case Role::kFirmware:
      return raw == field.value ? Verdict::kGood : Verdict::kWrongFirmware;
    case Role::kConstant:
      return raw == field.value ? Verdict::kGood : Verdict::kCorrupt;
    case Role::kChecksum:
      return raw == static_cast<double>(checksumOf(field, bytes)) ? Verdict::kGood : Verdict::kCorrupt;
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
  const bool floating = field.type == Type::kF32 || field.type == Type::kF64;
  return std::clamp(floating ? raw : std::nearbyint(raw), field.least, field.most);
}

void put(const Field& field, const Order& order, uint8_t* bytes) noexcept {
  const double torque = order.enable ? order.torque[field.index] : 0;
  switch (field.role) {
    case Role::kTorque:
      return putRaw(field, clampRaw(field, torque), bytes);
    case Role::kSequence: {
      const auto [least, most] = rangeOf(field.type);
      return putRaw(field, std::fmod(order.sequence, most + 1), bytes);
    }
    case Role::kConstant:
    case Role::kFirmware:
      return putRaw(field, field.value, bytes);
    case Role::kReference:
      return putRaw(field, clampRaw(field, order.position[field.index]), bytes);
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

size_t sizeOf(Type type) noexcept {
  switch (type) {
    case Type::kI8:
    case Type::kU8:
    case Type::kNibble:
      return 1;
    case Type::kI16:
    case Type::kU16:
      return 2;
    case Type::kI32:
    case Type::kU32:
    case Type::kF32:
    case Type::kNibbles:
      return 4;
    case Type::kF64:
      return 8;
  }
  return 0;
}

std::pair<double, double> rangeOf(Type type) noexcept {
  switch (type) {
    case Type::kI8:
      return {-128, 127};
    case Type::kU8:
      return {0, 255};
    case Type::kI16:
    case Type::kNibbles:
      return {-32768, 32767};
    case Type::kU16:
      return {0, 65535};
    case Type::kI32:
      return {-2147483648.0, 2147483647.0};
    case Type::kU32:
      return {0, 4294967295.0};
    case Type::kNibble:
      return {0, 15};
    case Type::kF32:
      return {-static_cast<double>(std::numeric_limits<float>::max()),
              static_cast<double>(std::numeric_limits<float>::max())};
    case Type::kF64:
      return {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  }
  return {0, 0};
}

Verdict decode(const Report& report, std::span<const uint8_t> bytes, State& state) noexcept {
  if (report.id >= 0) {
    if (bytes.empty()) return Verdict::kWrongSize;
    if (bytes[0] != report.id) return Verdict::kWrongId;
    bytes = bytes.subspan(1);
  }
  if (bytes.size() != report.size) return Verdict::kWrongSize;
  state = State{};
  for (const Field& field : report.fields)
    if (const Verdict verdict = take(field, bytes.data(), state); verdict != Verdict::kGood) return verdict;
  return Verdict::kGood;
}

size_t encode(const Report& report, const Order& order, std::span<uint8_t> bytes) noexcept {
  const size_t total = report.bytes();
  if (bytes.size() < total) return 0;
  std::memset(bytes.data(), 0, total);
  uint8_t* body = bytes.data();
  if (report.id >= 0) *body++ = static_cast<uint8_t>(report.id);
  for (const Field& field : report.fields)
    if (field.role != Role::kChecksum) put(field, order, body);
  for (const Field& field : report.fields)  // over what the others wrote
    if (field.role == Role::kChecksum) putRaw(field, checksumOf(field, body), body);
  return total;
}

}  // namespace hapticd::codec
