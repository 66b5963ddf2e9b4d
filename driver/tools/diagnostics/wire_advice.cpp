// SPDX-License-Identifier: MIT
#include "diagnostics/wire_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnostics/node_path.hpp"
#include "diagnostics/wire_of.hpp"

namespace hapticd::diagnostics {
namespace {

using codec::Field;
using codec::Role;
using document::Node;

const scene::Value* valueOf(const scene::Device& device, const char* id) {
  const auto found = std::find_if(device.parameters.begin(), device.parameters.end(),
                                  [id](const scene::Value& value) { return value.id == id; });
  return found == device.parameters.end() ? nullptr : &*found;
}

/// [N m] of a joint; 0: not known.
double maxTorque(const scene::Device& device, size_t joint) {
  const scene::Value* value = valueOf(device, "arm.max_torque");
  if (value == nullptr || value->numbers.empty()) return 0;
  return value->numbers.size() == 1 ? value->numbers[0] : joint < value->numbers.size() ? value->numbers[joint] : 0;
}

/// What is odd about the torque that a field can carry; "" for nothing.
std::string oddTorque(const Field& field, double most, bool scaled) {
  constexpr double kNearly = 0.9;  // rounded data sheets
  constexpr double kSteps = 8;     // so few, and the hand feels each
  const double a = field.least * field.scale + field.offset, b = field.most * field.scale + field.offset;
  const double range = std::min(std::abs(a), std::abs(b)), step = std::abs(field.scale);
  if (field.type != codec::Type::kFloat && step * kSteps > most)
    return fmt::format(
        "{}one raw unit is {:g} N m, of arm.max_torque's {:g} N m: most torques would be sent as 0; "
        "expected the N m of one raw unit",
        scaled ? "" : "not given, so ", step, most);
  if (range < kNearly * most)
    return fmt::format(
        "its largest raw number is {:g} N m, less than arm.max_torque's {:g} N m: all above is cut off; "
        "expected {:.3g} or more, or a smaller max_torque",
        range, most, step * most / std::max(range, 1e-300));
  return "";
}

void adviseTorques(const Node& fields, const codec::Report& report, const scene::Device& device,
                   document::Problems& warnings) {
  for (size_t i = 0; i < report.fields.size() && i < fields.items.size(); ++i) {
    const Field& field = report.fields[i];
    const double most = maxTorque(device, field.index);
    if (field.role != Role::kTorque || most <= 0) continue;
    const Node *scale = fields.items[i].find("scale"), *at = scale != nullptr ? scale : &fields.items[i];
    const std::string odd = oddTorque(field, most, scale != nullptr);
    if (odd.empty()) continue;
    document::report(warnings, device.file.string(), at->line, at->column,
                     fmt::format("parameters.wire.output.fields[{}].scale", i), odd);
  }
}

/// "i16 in a slot of an i24" reads well while angles are small: a byte between two joints' numbers that no field has.
void adviseGaps(const Node& fields, const codec::Report& report, const scene::Device& device,
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
    document::report(
        warnings, device.file.string(), fields.items[i].line, fields.items[i].column,
        fmt::format("parameters.wire.input.fields[{}].type", i),
        fmt::format("no field has byte {}, between the positions of joints {} and {}; expected a type of {} "
                    "bytes, if the number is that wide",
                    end, one.index + 1, next.index + 1, one.bytes() + free));
    return;
  }
}

/// The start-up sequence goes out before every limit, and while forces are off: as a command it must not push.
void adviseStartup(const Node& steps, const codec::Wire& wire, const scene::Device& device,
                   document::Problems& warnings) {
  codec::Report torques = wire.output;
  std::erase_if(torques.fields, [](const Field& field) { return field.role != Role::kTorque; });
  for (size_t i = 0; i < wire.startup.size() && i < steps.items.size(); ++i) {
    codec::State sent;
    const std::vector<uint8_t>& bytes = wire.startup[i].send;
    if (bytes.size() != torques.bytes() || decode(torques, bytes, sent) != codec::Verdict::kGood) continue;
    for (const Field& field : torques.fields) {
      const double torque = sent.torque[field.index];
      if (std::abs(torque) <= std::abs(field.scale)) continue;  // as near to none as it can be sent
      document::report(
          warnings, device.file.string(), steps.items[i].line, steps.items[i].column,
          fmt::format("parameters.wire.startup[{}].send", i),
          fmt::format("as wire.output has it, these bytes are a torque of {:.3g} N m at joint {}, which goes "
                      "out before every limit; expected torques of 0",
                      torque, field.index + 1));
      break;
    }
  }
}

}  // namespace

void adviseWire(const Node& root, const scene::Device& device, size_t joints, document::Problems& warnings) {
  const Node* in = find(root, {"parameters", "wire", "input", "fields"});
  const Node* out = find(root, {"parameters", "wire", "output", "fields"});
  const auto wire = wireOf(device, joints);
  if (!wire || in == nullptr || out == nullptr) return;
  adviseTorques(*out, wire->output, device, warnings);
  adviseGaps(*in, wire->input, device, warnings);
  if (const Node* startup = find(root, {"parameters", "wire", "startup"}))
    adviseStartup(*startup, *wire, device, warnings);
}

}  // namespace hapticd::diagnostics
