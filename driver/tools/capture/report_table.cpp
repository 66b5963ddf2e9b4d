// SPDX-License-Identifier: MIT
#include "capture/report_table.hpp"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "base/counted.hpp"
#include "capture/layout_hint.hpp"
#include "capture/resync.hpp"
#include "codec/framer.hpp"

namespace hapticd::capture {
namespace {

using codec::Field;
using codec::Role;
using codec::Verdict;

const char* wordOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGood:
      return "good";
    case Verdict::kWrongSize:
      return "size";
    case Verdict::kWrongId:
      return "id";
    case Verdict::kWrongFirmware:
      return "firmware";
    case Verdict::kCorrupt:
      return "corrupt";
    case Verdict::kTorn:
      return "torn";
  }
  return "?";
}

/// Returns the value in hexadecimal with all digits of the field, as in a dump of its bytes.
std::string hex(uint64_t value, const Field& field) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%0*" PRIx64, (field.bits + 3) / 4, value);
  return text;
}

/// Returns why one field made a report bad.
std::string whyWrong(const Field& field, std::span<const uint8_t> body) {
  const std::string at = " at byte " + std::to_string(field.at);
  const std::string is = hex(codec::codeAt(field, body), field);
  switch (field.role) {
    case Role::kChecksum:
      return "checksum" + at + " is " + is + ", of the bytes " + std::to_string(field.from) + " to " +
             std::to_string(field.to - 1) + " it is " + hex(codec::checksumAt(field, body), field);
    case Role::kFirmware:
    case Role::kConstant:
      return (field.role == Role::kFirmware ? "firmware" : "constant") + at + " is " + is + ", expected " +
             hex(field.code, field);
    case Role::kSequence:
      return "counter" + at + " is " + is + ", which differs from the counter before it, or is beyond its modulo";
    default:
      return "the field" + at + " is not a number";
  }
}

class Reader {
 public:
  explicit Reader(const codec::Wire& wire) : wire_(wire), framer_(wire.framing, wire.input.bytes()) {}

  void take(const Transfer& transfer, bool text, size_t index) {
    const std::span<const uint8_t> bytes(transfer.bytes);
    if (wire_.framing.used) return stream(transfer, text, index);
    if (text) return report(bytes, transfer.time, index + 1);
    // Raw bytes without marks: one report follows the other.
    const size_t size = wire_.input.bytes();
    for (size_t at = 0; at < bytes.size(); at += size) {
      at = skipOddBytes(wire_, bytes, at, [&](std::span<const uint8_t> odd) { oddBytes(odd, transfer.time, at); });
      report(bytes.subspan(at, std::min(size, bytes.size() - at)), transfer.time, at + size);
    }
  }

  Decoded decoded;

 private:
  /// Takes bytes that are not a whole report. If they begin with the id, they are a bad report; at the beginning of the
  /// capture, they are the rest of a cut report.
  void oddBytes(std::span<const uint8_t> bytes, double time, size_t at) {
    if (bytes[0] == wire_.input.id && bytes.size() < 2 * wire_.input.bytes())
      return report(bytes, time, at + bytes.size());
    (decoded.reports.empty() && decoded.others == 0 ? decoded.head : decoded.lost) += bytes.size();
  }

  void stream(const Transfer& transfer, bool text, size_t index) {
    const size_t packet = text ? transfer.bytes.size() : wire_.framing.packet;
    const std::span<const uint8_t> bytes(transfer.bytes);
    for (size_t at = 0; at < bytes.size(); at += packet) {
      const size_t end = std::min(at + packet, bytes.size());
      framed(bytes.subspan(at, end - at), transfer.time, text ? index + 1 : end);
    }
  }

  /// Gives a packet to the framer. Until the first report is found, packets without a header are given byte by byte,
  /// because bytes lost until then are the rest of a report whose beginning the capture lacks.
  void framed(std::span<const uint8_t> packet, double time, size_t offset) {
    const size_t step = wire_.framing.header == 0 && decoded.reports.empty() ? 1 : packet.size();
    for (size_t at = 0; at < packet.size(); at += step) {
      const bool first = decoded.reports.empty();
      const size_t lost =
          framer_.take(packet.subspan(at, step), [&](std::span<const uint8_t> whole) { report(whole, time, offset); });
      (first ? decoded.head : decoded.lost) += lost;
    }
  }

  /// Counts turns of positions that wrap as the device module does, from the first report on.
  void unwrap(codec::State& state) {
    for (const Field& field : wire_.input.fields) {
      if (field.role != Role::kPosition || !field.wraps) continue;
      const auto [least, most] = codec::rangeOf(field.type, field.bits);
      const double span = (most - least + 1) * std::abs(field.scale);
      double& position = state.position[field.index];
      if (placed_) position += std::nearbyint((before_[field.index] - position) / span) * span;
    }
    before_ = state.position;
    placed_ = true;
  }

  void report(std::span<const uint8_t> bytes, double time, size_t offset) {
    DecodedReport one;
    one.time = time, one.offset = offset;
    const Field* wrong = nullptr;
    one.verdict = codec::decode(wire_.input, bytes, one.state, &wrong);
    if (one.verdict == Verdict::kWrongId) {
      ++decoded.others;
      decoded.other_ids.insert(bytes[0]);
      return;
    }
    if (one.verdict == Verdict::kWrongSize)
      one.wrong = std::to_string(bytes.size()) + " bytes, expected " + std::to_string(wire_.input.bytes());
    const auto body = bytes.subspan(wrong != nullptr && wire_.input.id >= 0 ? 1 : 0);
    if (wrong != nullptr) one.wrong = whyWrong(*wrong, body);
    constexpr size_t kLooked = 64;
    if (one.verdict != Verdict::kGood && !body.empty() && decoded.bad.size() < kLooked)
      decoded.bad.push_back({wrong, {body.begin(), body.end()}});
    if (one.verdict == Verdict::kGood) unwrap(one.state);
    if (one.verdict == Verdict::kGood && one.state.has_sequence) count(one.state.sequence);
    decoded.reports.push_back(std::move(one));
  }

  void count(uint32_t sequence) {
    if (known_ && sequence == last_) ++decoded.repeats;
    if (known_ && sequence > last_ && sequence - last_ > 1) ++decoded.gaps;
    known_ = true, last_ = sequence;
  }

  const codec::Wire& wire_;
  codec::Framer framer_;
  bool known_ = false, placed_ = false;
  uint32_t last_ = 0;
  std::array<double, codec::kMaxJoints> before_{};  ///< positions of the last good report, including turns
};

struct Column {
  std::string name;
  Role role;
  size_t index = 0;
};

/// Returns the columns of a report, in the order of the table.
std::vector<Column> columnsOf(const codec::Report& report, size_t joints) {
  std::vector<Column> columns;
  const std::pair<Role, const char*> each[] = {{Role::kPosition, "position"},
                                               {Role::kVelocity, "velocity"},
                                               {Role::kTorque, "torque"},
                                               {Role::kReference, "reference"}};
  for (const auto& [role, name] : each)
    for (size_t i = 0; report.has(role) && i < joints; ++i) columns.push_back({name + std::to_string(i + 1), role, i});
  const std::pair<Role, const char*> once[] = {
      {Role::kButton, "buttons"}, {Role::kSequence, "sequence"},   {Role::kStarts, "starts"},
      {Role::kTime, "clock"},     {Role::kFault, "fault"},         {Role::kCalibrated, "calibrated"},
      {Role::kEnable, "enable"},  {Role::kCalibrate, "calibrate"}, {Role::kFollow, "follow"}};
  for (const auto& [role, name] : once)
    if (report.has(role)) columns.push_back({name, role, 0});
  return columns;
}

double valueOf(const codec::State& state, const Column& column) {
  switch (column.role) {
    case Role::kPosition:
      return state.position[column.index];
    case Role::kVelocity:
      return state.velocity[column.index];
    case Role::kTorque:
      return state.torque[column.index];
    case Role::kButton:
      return state.buttons;
    case Role::kSequence:
      return state.sequence;
    case Role::kStarts:
      return state.starts;
    case Role::kTime:
      return state.clock;
    case Role::kFault:
      return state.fault ? 1 : 0;
    default:
      return state.calibrated ? 1 : 0;
  }
}

void put(codec::State& state, const Column& column, double value) {
  switch (column.role) {
    case Role::kPosition:
      state.position[column.index] = value;
      break;
    case Role::kVelocity:
      state.velocity[column.index] = value;
      break;
    case Role::kTorque:
      state.torque[column.index] = value;
      break;
    case Role::kButton:
      state.buttons = static_cast<uint32_t>(std::clamp(value, 0.0, 4294967295.0));
      break;
    case Role::kSequence:
      state.sequence = static_cast<uint32_t>(std::clamp(value, 0.0, 4294967295.0));
      break;
    case Role::kStarts:
      state.starts = static_cast<uint32_t>(std::clamp(value, 0.0, 4294967295.0));
      break;
    case Role::kTime:
      state.clock = value;
      break;
    case Role::kFault:
      state.fault = value != 0;
      break;
    default:
      state.calibrated = value != 0;
      break;
  }
}

void put(codec::Order& order, const Column& column, double value) {
  switch (column.role) {
    case Role::kTorque:
      order.torque[column.index] = value;
      break;
    case Role::kReference:
      order.position[column.index] = value;
      break;
    case Role::kSequence:
      order.sequence = static_cast<uint32_t>(std::clamp(value, 0.0, 4294967295.0));
      break;
    case Role::kEnable:
      order.enable = value != 0;
      break;
    case Role::kCalibrate:
      order.calibrate = value != 0;
      break;
    default:
      order.follow = value != 0;
      break;
  }
}

}  // namespace

size_t Decoded::good() const {
  return static_cast<size_t>(std::count_if(reports.begin(), reports.end(),
                                           [](const DecodedReport& r) { return r.verdict == Verdict::kGood; }));
}

Decoded decodeCapture(const codec::Wire& wire, const Capture& capture) {
  Reader reader(wire);
  for (size_t i = 0; i < capture.transfers.size(); ++i) reader.take(capture.transfers[i], capture.text, i);
  Decoded& decoded = reader.decoded;
  // If these bytes are more than a cut report can have, or if no report was found, they count as lost.
  if (decoded.head >= 2 * wire.input.bytes() || decoded.reports.empty()) decoded.lost += std::exchange(decoded.head, 0);
  return std::move(decoded);
}

/// Returns the number with the fewest digits that read back as the same number.
static std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string csvOf(const codec::Wire& wire, size_t joints, const Decoded& decoded) {
  const std::vector<Column> columns = columnsOf(wire.input, joints);
  std::string text = "report,time,verdict";
  for (const Column& column : columns) text += "," + column.name;
  text += ",why\n";
  for (size_t i = 0; i < decoded.reports.size(); ++i) {
    const DecodedReport& one = decoded.reports[i];
    char number[40];
    text += std::to_string(i + 1) + ",";
    if (one.time >= 0) std::snprintf(number, sizeof number, "%.6f", one.time), text += number;
    text += std::string(",") + wordOf(one.verdict);
    for (const Column& column : columns) {
      text += ',';
      if (one.verdict == Verdict::kGood) text += shortest(valueOf(one.state, column));
    }
    text += one.wrong.empty() ? ",\n" : ",\"" + one.wrong + "\"\n";
  }
  return text;
}

/// Returns ids such as " (0x01, 0x04)"; "" if there are many, because then the bytes are cut at wrong places.
static std::string idsOf(const std::set<int>& ids) {
  constexpr size_t kFew = 4;
  std::string text;
  for (const int id : ids) text += (text.empty() ? " (" : ", ") + hexByte(id);
  return ids.size() > kFew ? "" : text + ")";
}

std::string summaryOf(const Decoded& decoded) {
  std::map<std::string, size_t> verdicts;
  for (const DecodedReport& one : decoded.reports)
    if (one.verdict != Verdict::kGood)
      ++verdicts[one.verdict == Verdict::kWrongSize ? "of a wrong size" : wordOf(one.verdict)];
  std::string text = counted(decoded.reports.size(), "report") + ", " + std::to_string(decoded.good()) + " good";
  for (const auto& [word, count] : verdicts) text += ", " + std::to_string(count) + " " + word;
  if (decoded.others > 0)
    text += "; besides " + counted(decoded.others, "report") + " with another id" + idsOf(decoded.other_ids);
  if (decoded.head > 0) text += "; the capture begins with the last " + counted(decoded.head, "byte") + " of a report";
  if (decoded.lost > 0) text += "; besides " + counted(decoded.lost, "byte") + " outside of any report";
  if (decoded.repeats > 0) text += "; the counter stands still " + counted(decoded.repeats, "time");
  if (decoded.gaps > 0)
    text += "; numbers of the counter are missing " + counted(decoded.gaps, "time") +
            (decoded.good() < decoded.reports.size() ? ", bad reports among them" : "");
  for (size_t i = 0; i < decoded.reports.size(); ++i)
    if (!decoded.reports[i].wrong.empty())
      return text + "\nreport " + std::to_string(i + 1) + " is the first bad one: " + decoded.reports[i].wrong;
  return text;
}

std::vector<std::string> columnsOf(const codec::Wire& wire, size_t joints, bool to_arm) {
  std::vector<std::string> names;
  for (const Column& column : columnsOf(to_arm ? wire.output : wire.input, joints)) names.push_back(column.name);
  return names;
}

Result<std::vector<uint8_t>> encodeRow(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns,
                                       const double* values, uint32_t sequence) {
  const codec::Report& report = to_arm ? wire.output : wire.input;
  const std::vector<Column> known = columnsOf(report, codec::kMaxJoints);
  codec::Order order;
  codec::State state;
  order.sequence = state.sequence = sequence;
  state.clock = sequence / wire.rate;
  order.enable = true;
  for (size_t i = 0; i < columns.size(); ++i) {
    const auto column = std::find_if(known.begin(), known.end(), [&](const Column& c) { return c.name == columns[i]; });
    if (column == known.end()) return Error{"column " + columns[i] + ": the report has no such field"};
    if (to_arm)
      put(order, *column, values[i]);
    else
      put(state, *column, values[i]);
  }
  std::vector<uint8_t> bytes(2 * report.bytes());
  const size_t size = to_arm ? codec::encode(report, order, bytes) : codec::encode(report, state, bytes);
  bytes.resize(codec::addEscapes(wire.framing, bytes, size));
  return bytes;
}

}  // namespace hapticd::capture
