// SPDX-License-Identifier: MIT
#include "diagnostics/device/wire_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagnostics/device/device_wire.hpp"
#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using codec::Field;
using codec::Role;
using document::Node;

/// [N m] Returns arm.max_torque of a joint; 0 if unknown.
double maxTorque(const scene::Device& device, size_t joint) {
  const scene::Value* value = givenIn(device.parameters, "arm.max_torque");
  if (value == nullptr || value->numbers.empty()) return 0;
  return value->numbers.size() == 1 ? value->numbers[0] : joint < value->numbers.size() ? value->numbers[joint] : 0;
}

/// What is wrong with the torque that a field can carry, and the key that causes it; "" if nothing is.
struct TorqueProblem {
  const char* key = "scale";
  std::string what;
};

/// [N m] Returns the torque that the field can express in both directions.
double rangeOf(const Field& field, double least, double most) {
  const double a = least * field.scale + field.offset, b = most * field.scale + field.offset;
  return std::min(std::abs(a), std::abs(b));
}

TorqueProblem tooCoarse(const Field& field, double most, bool scaled) {
  constexpr double kSteps = 8, kFewSteps = 200;  // [steps] with fewer than 8 steps, a hand feels each one; with fewer
                                                 // than 200, N mm may have been meant
  constexpr double kIdle = 50;  // factor: with a range so far above the motor's torque, N mm or counts were meant
  const double range = rangeOf(field, field.least, field.most), step = std::abs(field.scale);
  if (step * kSteps > most)
    return {"scale", fmt::format("{}one raw unit is {:g} N m, but arm.max_torque is {:g} N m: most torques would be "
                                 "sent as 0; expected the torque of one raw unit in N m",
                                 scaled ? "" : "not given, so ", step, most)};
  if (field.bits >= 12 && range > kIdle * most && step * kFewSteps > most)
    return {"scale", fmt::format("one raw unit is {:g} N m: the field then reaches {:.3g} N m, and arm.max_torque "
                                 "({:g} N m) is only {:.0f} steps; scale must be in N m: {:g} N mm is {:g} N m",
                                 step, range, most, most / step, step, step / 1000)};
  return {};
}

TorqueProblem oddTorque(const Field& field, double most, bool scaled) {
  constexpr double kNearly = 0.9;  // share, because data sheets round
  if (field.type != codec::Type::kFloat)
    if (TorqueProblem coarse = tooCoarse(field, most, scaled); !coarse.what.empty()) return coarse;
  const double range = rangeOf(field, field.least, field.most), step = std::abs(field.scale);
  if (range >= kNearly * most) return {};
  const auto [least, greatest] = codec::rangeOf(field.type, field.bits);
  if (rangeOf(field, least, greatest) >= kNearly * most)
    return {"limit", fmt::format("with this limit no more than {:g} N m is sent, which is less than arm.max_torque "
                                 "({:g} N m); expected limit: {:.0f}, no limit, or a smaller max_torque",
                                 range, most, most / step)};
  return {"scale",
          fmt::format("the largest raw number is {:g} N m, which is less than arm.max_torque ({:g} N m): larger "
                      "torques are cut off; expected a scale of {:.3g} or more, or a smaller max_torque",
                      range, most, step * most / std::max(range, 1e-300))};
}

/// Warns once at arm.max_torque if every torque field ends far below it, because N mm were meant there. Returns true if
/// max_torque is wrong in this way, so that the scales must not be judged by it.
bool maxTorqueTooLarge(const Node& root, const codec::Report& report, const scene::Device& device,
                       document::Problems& warnings) {
  constexpr double kTimes = 100;  // factor between N mm and N m is 1000, and fields have room
  size_t beyond = 0, torques = 0;
  double largest = 0;
  for (const Field& field : report.fields) {
    if (field.role != Role::kTorque) continue;
    const double most = maxTorque(device, field.index);
    const double range = rangeOf(field, field.least, field.most);
    ++torques, beyond += range > 0 && range * kTimes <= most ? 1 : 0;
    largest = std::max(largest, most);
  }
  const Node* at = find(root, {"parameters", "arm", "max_torque"});
  if (torques < 2 || beyond != torques || at == nullptr) return false;
  const std::string key = "parameters.arm.max_torque";
  if (std::any_of(warnings.begin(), warnings.end(), [&](const document::Problem& one) { return one.key == key; }))
    return true;
  document::report(
      warnings, device.file.string(), at->line, at->column, key,
      fmt::format("no torque field of wire.output reaches a hundredth of these torques; the values must be "
                  "in N m: {:g} N mm is {:g} N m",
                  largest, largest / 1000));
  return true;
}

void warnOfTorques(const Node& fields, const codec::Report& report, const scene::Device& device,
                   document::Problems& warnings) {
  for (size_t i = 0; i < report.fields.size() && i < fields.items.size(); ++i) {
    const Field& field = report.fields[i];
    const double most = maxTorque(device, field.index);
    if (field.role != Role::kTorque || most <= 0) continue;
    const TorqueProblem odd = oddTorque(field, most, fields.items[i].find("scale") != nullptr);
    if (odd.what.empty()) continue;
    const Node *key = fields.items[i].find(odd.key), *at = key != nullptr ? key : &fields.items[i];
    document::report(warnings, device.file.string(), at->line, at->column,
                     fmt::format("parameters.wire.output.fields[{}].{}", i, odd.key), odd.what);
  }
}

/// Returns the fields that no checksum covers, although a transfer error in them would matter: numbers of joints, and
/// flags. A counter is among them if it is the only one, because two counters may enclose the other bytes.
/// @param counts_too false to leave out counters
std::vector<size_t> uncovered(const codec::Report& report, bool counts_too) {
  std::vector<bool> covered(report.size);
  bool any = false;
  for (const Field& field : report.fields)
    if (field.role == Role::kChecksum && field.from < field.to && field.to <= report.size)
      any = true, std::fill(covered.begin() + field.from, covered.begin() + field.to, true);
  constexpr Role kIdle[] = {Role::kChecksum, Role::kConstant, Role::kFirmware, Role::kStarts, Role::kTime};
  const auto counters = std::count_if(report.fields.begin(), report.fields.end(),
                                      [](const Field& field) { return field.role == Role::kSequence; });
  std::vector<size_t> outside;
  for (size_t i = 0; i < report.fields.size() && any; ++i) {
    const Field& field = report.fields[i];
    if (std::find(std::begin(kIdle), std::end(kIdle), field.role) != std::end(kIdle)) continue;
    if (field.role == Role::kSequence && (counters > 1 || !counts_too)) continue;
    for (size_t byte = field.at; byte < std::min(field.at + field.bytes(), report.size); ++byte)
      if (!covered[byte]) {
        outside.push_back(i);
        break;
      }
  }
  return outside;
}

/// Warns of fields that no checksum covers, because an error of the transfer in them is not noticed.
void warnOfChecksum(const Node& fields, const codec::Report& report, const char* side, const scene::Device& device,
                    document::Problems& warnings) {
  std::string outside;
  const scene::Value* verified = givenIn(device.parameters, "device.verified");
  for (const size_t i : uncovered(report, verified == nullptr || verified->number <= 0)) {
    const Node* is = i < fields.items.size() ? fields.items[i].find("is") : nullptr;
    if (is == nullptr) continue;
    const bool numbered = fields.items[i].find("joint") != nullptr || fields.items[i].find("button") != nullptr;
    outside += (outside.empty() ? "" : ", ") + is->scalar +
               (numbered ? fmt::format(" {}", report.fields[i].index + 1) : std::string());
  }
  for (size_t i = 0; !outside.empty() && i < fields.items.size(); ++i) {
    const Field& field = report.fields[i];
    if (field.role != Role::kChecksum) continue;
    const Node *to = fields.items[i].find("to"), *at = to != nullptr ? to : &fields.items[i];
    document::report(warnings, device.file.string(), at->line, at->column,
                     fmt::format("parameters.wire.{}.fields[{}].to", side, i),
                     fmt::format("the checksum covers the bytes {} to {}, and leaves out {}: a wrong one would be "
                                 "believed; expected from and to around all of them",
                                 field.from, field.to - 1, outside));
    return;
  }
}

/// Warns of a byte between two positions that is in no field: an i16 in the place of an i24 seems right while angles
/// are small.
void warnOfGaps(const Node& fields, const codec::Report& report, const scene::Device& device,
                document::Problems& warnings) {
  for (size_t i = 0; i + 1 < report.fields.size() && i + 1 < fields.items.size(); ++i) {
    const Field &one = report.fields[i], &next = report.fields[i + 1];
    const size_t end = one.at + one.bytes();
    if (one.role != Role::kPosition || next.role != Role::kPosition || next.at <= end) continue;
    const size_t free = next.at - end;
    const bool used = std::any_of(report.fields.begin(), report.fields.end(), [&](const Field& field) {
      return field.at < next.at && field.at + field.bytes() > end;
    });
    if (used || free >= one.bytes()) continue;
    document::report(warnings, device.file.string(), fields.items[i].line, fields.items[i].column,
                     fmt::format("parameters.wire.input.fields[{}].type", i),
                     fmt::format("byte {}, between the positions of joints {} and {}, belongs to no field; expected a "
                                 "type of {} bytes if the number is that wide",
                                 end, one.index + 1, next.index + 1, one.bytes() + free));
    return;
  }
}

/// Warns of torques in the start-up sequence. No limit applies to it, and forces must be off then.
void warnOfStartup(const Node& steps, const codec::Wire& wire, const scene::Device& device,
                   document::Problems& warnings) {
  codec::Report torques = wire.output;
  std::erase_if(torques.fields, [](const Field& field) { return field.role != Role::kTorque; });
  for (size_t i = 0; i < wire.startup.size() && i < steps.items.size(); ++i) {
    codec::State sent;
    const std::vector<uint8_t>& bytes = wire.startup[i].send;
    if (bytes.size() != torques.bytes() || decode(torques, bytes, sent) != codec::Verdict::kGood) continue;
    for (const Field& field : torques.fields) {
      const double torque = sent.torque[field.index];
      if (std::abs(torque) <= std::abs(field.scale)) continue;  // zero, within one raw unit
      document::report(warnings, device.file.string(), steps.items[i].line, steps.items[i].column,
                       fmt::format("parameters.wire.startup[{}].send", i),
                       fmt::format("read as wire.output, these bytes command {:.3g} N m at joint {}, and no limit "
                                   "applies to start-up bytes; send zero torques here",
                                   torque, field.index + 1));
      break;
    }
  }
}

/// Warns of one bit that is read as two buttons.
void warnOfButtons(const Node& fields, const codec::Report& report, const scene::Device& device,
                   document::Problems& warnings) {
  const auto firstBit = [](const Field& field) {
    return 8 * size_t{field.at} + field.bit_skip + static_cast<size_t>(std::max<int>(field.bit, 0));
  };
  for (size_t i = 1; i < report.fields.size() && i < fields.items.size(); ++i)
    for (size_t before = 0; before < i; ++before) {
      const Field &one = report.fields[before], &other = report.fields[i];
      if (one.role != Role::kButton || other.role != Role::kButton) continue;
      if (one.index == other.index || firstBit(one) != firstBit(other)) continue;
      document::report(warnings, device.file.string(), fields.items[i].line, fields.items[i].column,
                       fmt::format("parameters.wire.input.fields[{}].at", i),
                       fmt::format("button {} is read from the same bit as button {} (fields[{}]), so both are always "
                                   "pressed together; expected another at, bit_offset or bit",
                                   other.index + 1, one.index + 1, before));
      break;
    }
}

/// Warns of a report whose id seems to be counted as byte 0: no field touches byte 0, and the last one ends the report.
void warnOfCountedId(const Node& root, const codec::Report& report, const char* side, const scene::Device& device,
                     document::Problems& warnings) {
  if (report.id < 0 || report.fields.empty()) return;
  size_t first = report.size, end = 0;
  for (const Field& field : report.fields) {
    first = std::min<size_t>(first, field.at);
    end = std::max(end, field.at + field.bytes());
  }
  const Node* id = find(root, {"parameters", "wire", side, "id"});
  if (id == nullptr || first != 1 || end != report.size) return;
  document::report(
      warnings, device.file.string(), id->line, id->column, fmt::format("parameters.wire.{}.id", side),
      "no field begins at byte 0, the first byte after the id; `at` and `size` are counted without the id: "
      "if they were counted with it, subtract 1 from each");
}

/// Warns of a size that is eight times as large as the fields need, because it counts bits.
void warnOfSizeInBits(const Node& root, const codec::Report& report, const char* side, const scene::Device& device,
                      document::Problems& warnings) {
  const Node* size = find(root, {"parameters", "wire", side, "size"});
  size_t end = 0;
  for (const Field& field : report.fields) end = std::max(end, field.at + field.bytes());
  const bool full_packet =
      (report.size & (report.size - 1)) == 0;  // some firmware fills packets, of 64 bytes for example
  if (size == nullptr || full_packet || report.size != 8 * end) return;
  document::report(warnings, device.file.string(), size->line, size->column,
                   fmt::format("parameters.wire.{}.size", side),
                   fmt::format("{} bytes, but the fields end after {} bytes, which are {} bits; size must be in bytes",
                               report.size, end, report.size));
}

/// Warns of a pause in the start-up sequence that nobody would wait for, because it was meant in ms.
void warnOfWaits(const Node& root, const scene::Device& device, document::Problems& warnings) {
  constexpr double kLong = 5;  // [s] firmware starts within a few seconds
  const Node* steps = find(root, {"parameters", "wire", "startup"});
  for (size_t i = 0; steps != nullptr && i < steps->items.size(); ++i) {
    const Node* wait = steps->items[i].isMap() ? steps->items[i].find("wait") : nullptr;
    const double given = wait != nullptr ? document::toNumber(wait->scalar).value_or(0) : 0;
    if (wait != nullptr && given >= kLong)
      document::report(warnings, device.file.string(), wait->line, wait->column,
                       fmt::format("parameters.wire.startup[{}].wait", i),
                       fmt::format("the start waits {0:g} s here; the value must be in s: {0:g} ms is {1:g} s", given,
                                   given / 1000));
  }
}

/// Warns of endpoints that are not given: their numbers are those of common boards, and not those of every arm.
void warnOfEndpoints(const Node& wire, const scene::Device& device, document::Problems& warnings) {
  if (wire.find("endpoints") != nullptr) return;
  const codec::Wire defaults;
  document::report(
      warnings, device.file.string(), wire.line, wire.column, "parameters.wire.endpoints",
      fmt::format("not given, so {{in: {:#04x}, out: {:#04x}}} are used; expected the endpoints that lsusb "
                  "-v shows as bEndpointAddress (IN and OUT) for this arm",
                  defaults.endpoint_in, defaults.endpoint_out));
}

/// Warns of keys that only an arm on bulk endpoints (module usb_bulk) can obey.
void warnOfBulkKeys(const Node& root, const scene::Device& device, document::Problems& warnings) {
  const Node* wire = find(root, {"parameters", "wire"});
  if (wire == nullptr) return;
  if (device.module == "usb_bulk") return warnOfEndpoints(*wire, device, warnings);
  const std::string file = device.file.string(), module = device.module;
  if (const Node* endpoints = wire->find("endpoints"))
    document::report(warnings, file, endpoints->line, endpoints->column, "parameters.wire.endpoints",
                     "has no effect: the module " + module +
                         " does not choose endpoints; "
                         "remove this key, or give module: usb_bulk if the arm has bulk endpoints");
  const Node* startup = wire->find("startup");
  for (size_t i = 0; startup != nullptr && i < startup->items.size(); ++i)
    if (const Node* control = startup->items[i].find("control"))
      document::report(warnings, file, control->line, control->column,
                       fmt::format("parameters.wire.startup[{}].control", i),
                       "the module " + module +
                           " cannot send control requests, so the arm could not be started; expected send: [bytes], or "
                           "module: usb_bulk");
}

}  // namespace

void warnOfWire(const Node& root, const scene::Device& device, size_t joints, document::Problems& warnings) {
  const Node* in = find(root, {"parameters", "wire", "input", "fields"});
  const Node* out = find(root, {"parameters", "wire", "output", "fields"});
  warnOfBulkKeys(root, device, warnings);
  warnOfWaits(root, device, warnings);
  const auto wire = wireDraftOf(device, joints);
  if (!wire || in == nullptr || out == nullptr) return;
  if (!maxTorqueTooLarge(root, wire->output, device, warnings)) warnOfTorques(*out, wire->output, device, warnings);
  warnOfGaps(*in, wire->input, device, warnings);
  warnOfButtons(*in, wire->input, device, warnings);
  if (wire->input.placed) warnOfChecksum(*in, wire->input, "input", device, warnings);
  if (wire->output.placed) warnOfChecksum(*out, wire->output, "output", device, warnings);
  if (wire->input.placed) warnOfSizeInBits(root, wire->input, "input", device, warnings);
  if (wire->output.placed) warnOfSizeInBits(root, wire->output, "output", device, warnings);
  if (!wireOf(device, joints)) return;  // if a field has a mistake, its place may be wrong, too
  warnOfCountedId(root, wire->input, "input", device, warnings);
  warnOfCountedId(root, wire->output, "output", device, warnings);
  if (const Node* startup = find(root, {"parameters", "wire", "startup"}))
    warnOfStartup(*startup, *wire, device, warnings);
}

}  // namespace hapticd::diagnostics
