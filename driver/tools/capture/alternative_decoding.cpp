// SPDX-License-Identifier: MIT
#include "capture/alternative_decoding.hpp"

#include <algorithm>
#include <cmath>

#include "base/short_number.hpp"

namespace hapticd::capture {
namespace {

using codec::Field;
using codec::Type;

constexpr double kWholeRange = 0.75;  ///< share of the field's range: only a wrong sign or a wrap makes such a step

/// One reading of the raw numbers of a field: each is changed to another number, and then scaled.
struct Decoding {
  enum class Code { kSame, kOtherSign, kAmount } code = Code::kSame;
  double turn = 1;    ///< -1 reverses the direction
  double offset = 0;  ///< [codes] added before the scale
};

double spanOf(const Field& field) {
  return std::ldexp(1.0, field.bits);
}

double readAs(const Field& field, const Decoding& reading, double position) {
  const double range = spanOf(field), code = std::round((position - field.offset) / field.scale);
  const double bits = code < 0 ? code + range : code;
  double number = code;
  if (reading.code == Decoding::Code::kOtherSign)
    number = field.type == Type::kSigned ? bits : code >= range / 2 ? code - range : code;
  if (reading.code == Decoding::Code::kAmount) number = bits >= range / 2 ? range / 2 - bits : bits;
  return reading.turn * (number + reading.offset) * field.scale + field.offset;
}

std::vector<double> allAs(const Field& field, const Decoding& reading, const std::vector<double>& positions) {
  std::vector<double> all;
  for (const double position : positions) all.push_back(readAs(field, reading, position));
  return all;
}

/// Returns how often the position steps by more than this share of the field's range.
size_t jumpsOf(const Field& field, const std::vector<double>& positions, double part) {
  const double most = part * spanOf(field) * std::abs(field.scale);
  size_t count = 0;
  for (size_t i = 1; i < positions.size(); ++i) count += std::abs(positions[i] - positions[i - 1]) > most ? 1 : 0;
  return count;
}

std::string typeOf(const Field& field, bool other) {
  const bool whole = (field.type == Type::kSigned) != other;
  return (whole ? "i" : "u") + std::to_string(field.bits);
}

/// Returns the keys and values that the file must contain for a reading, such as "type: i16, scale: 0.1".
std::string wordsOf(const Field& field, const Decoding& reading) {
  std::string words;
  const auto add = [&words](const std::string& more) { words += (words.empty() ? "" : ", ") + more; };
  if (reading.code == Decoding::Code::kOtherSign) add("type: " + typeOf(field, true));
  if (reading.turn < 0) add("scale: " + withDigits(-field.scale, 6));
  if (reading.offset != 0) add("offset: " + withDigits(field.offset + reading.turn * reading.offset * field.scale, 6));
  return words;
}

/// Returns the readings to try, the likeliest first. A number that is reversed about the middle of its range has all
/// its bits inverted.
std::vector<Decoding> readingsOf(const Field& field) {
  using Code = Decoding::Code;
  const double range = spanOf(field);
  std::vector<Decoding> all{{Code::kOtherSign, 1, 0}, {Code::kSame, -1, 0}, {Code::kOtherSign, -1, 0}};
  if (field.type == Type::kUnsigned) {
    all.push_back({Code::kSame, 1, -range / 2});
    all.push_back({Code::kSame, -1, -range / 2});
    all.push_back({Code::kSame, -1, -(range - 1)});
  } else if (field.offset == 0) {
    for (const double turn : {1.0, -1.0}) all.push_back({Code::kOtherSign, turn, -range / 2});
  }
  return all;
}

std::string wholeRange(const Field& field, const std::vector<double>& positions, const Stops& stops, size_t count) {
  const std::string what = "jumps by nearly the whole range of its " + typeOf(field, false) +
                           " from one report to the next, " + std::to_string(count) +
                           (count == 1 ? " time: " : " times: ");
  Decoding other{Decoding::Code::kOtherSign, 1, 0};
  const auto fitsWith = [&](const Decoding& reading) {
    const auto as_other = allAs(field, reading, positions);
    return jumpsOf(field, as_other, kWholeRange / 2) == 0 && !leavesStops(as_other, stops);
  };
  bool fits = fitsWith(other);
  if (!fits && field.type == Type::kSigned && field.offset == 0) {  // counts about the middle of an unsigned range
    other.offset = -spanOf(field) / 2;
    fits = fitsWith(other);
  }
  const std::string wraps = "wraps: true if its numbers start again at the other end of their range, as in a counter";
  return what + (fits ? "give " + wordsOf(field, other) + ", or " : "give ") + wraps;
}

}  // namespace

bool leavesStops(const std::vector<double>& positions, const Stops& stops) {
  if (positions.empty() || !stops.given) return false;
  const auto [least, most] = std::minmax_element(positions.begin(), positions.end());
  const double room = 0.05 * (stops.high - stops.low);  // a joint that is pressed against a stop goes a little farther
  return stops.placed ? *least < stops.low - room || *most > stops.high + room
                      : *most - *least > stops.high - stops.low + 2 * room;
}

std::string alternativeDecoding(const Field& field, const std::vector<double>& positions, const Stops& stops) {
  if ((field.type != Type::kUnsigned && field.type != Type::kSigned) || field.bits > 53 || field.bits < 2) return "";
  const Decoding amount{Decoding::Code::kAmount, 1, 0};
  const size_t whole = jumpsOf(field, positions, kWholeRange), some = jumpsOf(field, positions, kWholeRange / 3);
  if (whole > 0 && some == whole) return wholeRange(field, positions, stops, whole);
  const auto as_amount = allAs(field, amount, positions);
  if (field.type == Type::kSigned && some > 0 && jumpsOf(field, as_amount, 0.02) == 0)
    return "jumps by half the range of its " + typeOf(field, false) +
           ". The jumps disappear if it is read as sign and magnitude, which no type supports; let the board send "
           "two's complement";
  if (some > 0 || !stops.placed || !leavesStops(positions, stops)) return "";
  for (const Decoding& reading : readingsOf(field)) {
    const auto as_other = allAs(field, reading, positions);
    if (leavesStops(as_other, stops) || jumpsOf(field, as_other, kWholeRange / 3) > 0) continue;
    const auto [least, most] = std::minmax_element(positions.begin(), positions.end());
    return "goes from " + withDigits(*least, 6) + " to " + withDigits(*most, 6) +
           ", beyond its arm.limits; it stays within them with " + wordsOf(field, reading);
  }
  return "";
}

}  // namespace hapticd::capture
