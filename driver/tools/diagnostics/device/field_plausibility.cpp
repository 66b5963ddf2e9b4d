// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "codec/wire_overlap.hpp"
#include "diagnostics/device/arm_plausibility.hpp"
#include "diagnostics/device/device_wire.hpp"
#include "diagnostics/device/motor_force.hpp"
#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using codec::Field;
using codec::Role;
using document::Node;

/// One report of the wire format, and where the file describes it.
struct Side {
  const char* name;
  const codec::Report& report;
  const Node& fields;
  const scene::Device& device;
  document::Problems& warnings;

  size_t count() const { return std::min(report.fields.size(), fields.items.size()); }
  /// Adds a warning, unless the key has one already: earlier checks give more exact warnings.
  void warn(size_t i, const char* key, const std::string& what) const {
    const Node *given = fields.items[i].find(key), *at = given != nullptr ? given : &fields.items[i];
    if (!warned(i, key))
      document::report(warnings, device.file.string(), at->line, at->column,
                       fmt::format("parameters.wire.{}.fields[{}].{}", name, i, key), what);
  }
  bool warned(size_t i, const char* key) const {
    const std::string path = fmt::format("parameters.wire.{}.fields[{}].{}", name, i, key);
    return std::any_of(warnings.begin(), warnings.end(), [&](const auto& told) { return told.key == path; });
  }
  /// Returns the fields with numbers of more than one byte, which have a byte order.
  std::vector<size_t> wide() const {
    std::vector<size_t> found = of({Role::kPosition, Role::kVelocity, Role::kTorque, Role::kReference});
    std::erase_if(found,
                  [this](size_t i) { return report.fields[i].bits <= 8 || codec::isText(report.fields[i].type); });
    return found;
  }
  /// Returns all fields of more than one byte, of any kind. If they have both byte orders, the author chose them.
  std::vector<size_t> ordered() const {
    std::vector<size_t> found;
    for (size_t i = 0; i < count(); ++i)
      if (report.fields[i].bits > 8 && !codec::isText(report.fields[i].type) &&
          report.fields[i].role != Role::kButton && report.fields[i].sound)
        found.push_back(i);
    return found;
  }
  /// Returns the fields of these kinds, for all joints, except those with mistakes.
  std::vector<size_t> of(std::initializer_list<Role> roles) const {
    std::vector<size_t> found;
    for (size_t i = 0; i < count(); ++i)
      if (std::find(roles.begin(), roles.end(), report.fields[i].role) != roles.end() && report.fields[i].sound)
        found.push_back(i);
    return found;
  }
  /// Returns true if nothing is wrong with any field.
  bool sound() const {
    return std::all_of(report.fields.begin(), report.fields.end(), [](const Field& field) { return field.sound; });
  }
};

/// Returns the fields that differ from most others. If each group has half of the fields, it returns the group that
/// begins later.
std::vector<size_t> minorityOf(const std::vector<size_t>& all, const std::function<bool(size_t)>& is) {
  std::vector<size_t> yes, no;
  for (const size_t i : all) (is(i) ? yes : no).push_back(i);
  if (yes.empty() || no.empty()) return {};
  if (yes.size() == no.size()) return yes[0] < no[0] ? no : yes;
  return yes.size() < no.size() ? yes : no;
}

const char* orderOf(bool big) {
  return big ? "big" : "little";
}

/// Warns of mixed byte orders in one report, because a board writes all its numbers in the same order.
void mixedOrder(const Side& side) {
  for (const size_t i : minorityOf(side.wide(), [&](size_t at) { return side.report.fields[at].big_endian; }))
    side.warn(i, "endian",
              fmt::format("the byte order of this number is {}, but most other numbers of this report are {}; expected "
                          "one byte order for all, unless the firmware mixes them",
                          orderOf(side.report.fields[i].big_endian), orderOf(!side.report.fields[i].big_endian)));
}

/// Warns if the output has another byte order than the input.
void otherOrderOut(const Side& in, const Side& out) {
  const std::vector<size_t> read = in.ordered(), sent = out.wide();
  if (in.wide().empty() || sent.empty()) return;
  const bool big = out.report.fields[sent[0]].big_endian;
  for (const auto& [side, fields, order] : {std::tuple(&in, &read, !big), std::tuple(&out, &sent, big)})
    for (const size_t i : *fields)
      if (side->report.fields[i].big_endian != order) return;
  out.warn(
      sent[0], "endian",
      fmt::format("the byte order is {} in all of wire.output, but {} in all of wire.input; expected one for both, "
                  "unless the firmware mixes them",
                  orderOf(big), orderOf(!big)));
}

/// Warns of, for example, u16 for one joint and i16 for the others, because below zero its position would jump by the
/// whole range.
void mixedSigns(const Side& side, Role role) {
  std::vector<size_t> whole;
  for (const size_t i : side.of({role})) {
    const Field& field = side.report.fields[i];
    if (field.type != codec::Type::kUnsigned && field.type != codec::Type::kSigned) continue;
    if (!whole.empty() && side.report.fields[whole[0]].bits != field.bits) return;
    whole.push_back(i);
  }
  for (const size_t i :
       minorityOf(whole, [&](size_t at) { return side.report.fields[at].type == codec::Type::kUnsigned; })) {
    const bool plain = side.report.fields[i].type == codec::Type::kUnsigned;
    side.warn(
        i, "type",
        fmt::format(
            "this type is {}signed, but the types of the other joints are {}; expected one type for all, unless the "
            "firmware mixes them",
            plain ? "un" : "", plain ? "signed" : "unsigned"));
  }
}

/// Returns the advice for a scale that is too large for rad per count. Numbers above one are counts of an encoder;
/// smaller ones may be degrees.
std::string inRadians(double scale) {
  if (std::abs(scale) <= 1) return fmt::format("if it is in degrees, write scale_degrees: {:g}", scale);
  return fmt::format(
      "if it is the counts of a turn, write 2 pi / (counts of a motor turn * motor turns of one joint "
      "turn): {:.6g} with one motor turn",
      2 * M_PI / scale);
}

/// Warns of a scale that is far larger or smaller than the others, because the joints of these arms are alike and the
/// decimal point may be wrong.
void unlikeOthers(const Side& side, Role role, const std::vector<double>& motors) {
  constexpr double kTimes = 8, kFiner = 50;  // a slow joint may have a far larger gear ratio
  const auto coarseness = [&](size_t i) {
    const Field& field = side.report.fields[i];
    const double part = role == Role::kTorque && field.index < motors.size() ? motors[field.index] : 1;
    return std::abs(field.scale) / part;
  };
  std::vector<size_t> all = side.of({role});
  std::erase_if(all, [&side](size_t i) {
    return side.warned(i, "scale") || side.warned(i, "scale_degrees");
  });  // a wrong scale is no measure of others
  if (all.size() < 3 || (role == Role::kTorque && motors.empty())) return;
  for (const size_t i : all) {
    double next = 0, least = 1e300;
    for (const size_t other : all) {
      if (side.report.fields[other].bits != side.report.fields[i].bits) return;
      if (other != i) next = std::max(next, coarseness(other)), least = std::min(least, coarseness(other));
    }
    const bool finer = coarseness(i) > 0 && coarseness(i) * kFiner <= least;
    if (coarseness(i) < kTimes * next && !finer) continue;
    const double times = coarseness(i) / next, degrees = times * M_PI / 180;
    const bool in_degrees = role == Role::kPosition && degrees > 0.9 && degrees < 1.1;
    side.warn(i, "scale",
              fmt::format("this scale is {:.3g} times as {} as that of any other joint{}: {}",
                          finer ? least / coarseness(i) : times, finer ? "fine" : "coarse",
                          role == Role::kTorque ? ", measured by arm.max_torque" : "",
                          in_degrees ? inRadians(side.report.fields[i].scale) : "is the decimal point wrong?"));
  }
}

/// Warns of a scale in rad under scale_degrees: one joint has this key, its number is like the scales of the others in
/// rad, and so its step is about 57 times as fine as theirs.
void radiansAsDegrees(const Side& side) {
  constexpr double kAlike = 4, kDegree = M_PI / 180;  // joints differ by gear ratios
  const auto number = [&side](size_t i, const char* key) {
    const Node* given = side.fields.items[i].find(key);
    return given == nullptr ? 0 : std::abs(document::toNumber(given->scalar).value_or(0));
  };
  std::vector<size_t> all = side.of({Role::kPosition});
  for (const size_t i : all) {
    const double degrees = number(i, "scale_degrees");
    bool like_all = degrees > 0 && all.size() > 1;
    for (const size_t other : all) {
      if (other == i) continue;
      const double radians = number(other, "scale"), ratio = degrees / radians;
      const bool same_bits = side.report.fields[other].bits == side.report.fields[i].bits;
      like_all = like_all && radians > 0 && same_bits && ratio < kAlike && ratio > 1 / kAlike;
    }
    if (like_all)
      side.warn(
          i, "scale_degrees",
          fmt::format("{0:g} degrees are {1:.3g} rad per count, about 57 times as fine as the scales of the other "
                      "joints; if the value is in rad, write scale: {0:g}",
                      degrees, degrees * kDegree));
  }
}

/// Warns if one count moves the tip so far that a hand feels the step, with models as stiff as the arm allows.
void coarseCounts(const Node& root, const Side& side, const host::DeviceInstance& arm) {
  constexpr double kAlways = 1e-3, kSmall = 2e-4, kBuzz = 0.5;  // [m]; [m]; [N]
  const uint32_t joints = arm.kinematics().joint_count;
  const auto q = restJoints(root, joints);
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> J(6, joints);
  if (arm.kinematics().jacobian(arm.handle(), q.data(), J.data()) < 0 || !J.allFinite()) return;
  const scene::Value* most = givenIn(side.device.parameters, "device.max_stiffness");
  const double stiffness = most != nullptr ? most->number : 0;
  for (const size_t i : side.of({Role::kPosition})) {
    const Field& field = side.report.fields[i];
    if (field.type == codec::Type::kFloat || field.index >= joints || side.fields.items[i].find("scale") == nullptr)
      continue;
    const double step = J.col(field.index).head<3>().norm() * std::abs(field.scale);
    if (step < kAlways && (step < kSmall || step * stiffness < kBuzz)) continue;
    side.warn(
        i, "scale",
        fmt::format("one count of joint {} moves the tip by {:.3g} mm{}; the value must be in rad per count; {}",
                    field.index + 1, step * 1e3,
                    stiffness > 0 ? fmt::format(", a step of {:.2g} N at device.max_stiffness", step * stiffness) : "",
                    inRadians(field.scale)));
  }
}

/// Warns of a scale of 360 / N, where N is a usual number of counts in a turn: such a number is in degrees per count.
void degreesPerCount(const Side& side) {
  constexpr double kTurns = 4, kRounding = 3e-4, kDecimal = 500;  // turns that a field covers; relative error
  for (const size_t i : side.of({Role::kPosition})) {
    const Field& field = side.report.fields[i];
    const double scale = std::abs(field.scale), counts = 360 / scale;
    const bool wide = field.type != codec::Type::kFloat && std::ldexp(scale, field.bits) > kTurns * 2 * M_PI;
    if (!(scale > 0) || !wide || side.fields.items[i].find("scale") == nullptr) continue;
    const double binary = std::ldexp(1.0, std::ilogb(counts * M_SQRT2));  // the nearest power of two
    const double decimal = kDecimal * std::round(counts / kDecimal);
    const auto is = [counts](double usual, double error) { return std::abs(counts / usual - 1) < error; };
    if (!is(binary, kRounding) && !(counts < 100 * kDecimal && is(decimal, kRounding / 10))) continue;
    side.warn(i, "scale",
              fmt::format("this scale is 360 / {:.0f}, so it is in degrees per count, and the field covers {:.4g} rad; "
                          "the value must be in rad per count; write scale_degrees: {:g}",
                          is(binary, kRounding) ? binary : decimal, std::ldexp(scale, field.bits), field.scale));
  }
}

/// Warns if one count is a large angle, of an arm whose lengths are unknown.
void coarseAngles(const Side& side) {
  constexpr double kLarge = 0.01;  // [rad] 2 mm at a link of 0.2 m
  for (const size_t i : side.of({Role::kPosition})) {
    const Field& field = side.report.fields[i];
    if (field.type == codec::Type::kFloat || !(std::abs(field.scale) > kLarge) ||
        side.fields.items[i].find("scale") == nullptr)
      continue;
    side.warn(
        i, "scale",
        fmt::format("one count of joint {} is {:.3g} rad, or {:.3g} degrees; the value must be in rad per count; {}",
                    field.index + 1, field.scale, field.scale * 180 / M_PI, inRadians(field.scale)));
  }
}

/// Warns if one count of a velocity is faster than any joint, because counts or degrees were meant.
void coarseVelocities(const Side& side) {
  constexpr double kFast = 10;  // [rad/s]
  for (const size_t i : side.of({Role::kVelocity})) {
    const Field& field = side.report.fields[i];
    if (field.type == codec::Type::kFloat || !(std::abs(field.scale) >= kFast)) continue;
    side.warn(i, "scale",
              fmt::format("one count of the velocity of joint {} is {:g} rad/s, faster than a hand turns a joint; the "
                          "value must be in rad/s per count",
                          field.index + 1, field.scale));
  }
}

/// Warns if the joints have another order in the output than in the input, because most boards use one order, and
/// forces at the wrong joints may pull the hand in.
void crossedJoints(const Side& in, const Side& out) {
  const auto order = [](const Side& side, Role role) {
    std::vector<size_t> fields = side.of({role});
    std::sort(fields.begin(), fields.end(), [&](size_t a, size_t b) {
      const Field &one = side.report.fields[a], &next = side.report.fields[b];
      return one.at != next.at ? one.at < next.at : one.bit_skip < next.bit_skip;
    });
    return fields;
  };
  const std::vector<size_t> positions = order(in, Role::kPosition), torques = order(out, Role::kTorque);
  if (positions.size() != torques.size() || !in.sound() || !out.sound()) return;
  for (size_t k = 0; k < torques.size(); ++k) {
    const unsigned read = in.report.fields[positions[k]].index, sent = out.report.fields[torques[k]].index;
    if (read == sent) continue;
    return out.warn(
        torques[k], "joint",
        fmt::format("{}, but wire.input has joint {} at this place: if the firmware has one order for both, forces go "
                    "to the wrong joints; expected joint: {}, or check with a very small force first",
                    sent + 1, read + 1, read + 1));
  }
}

/// Warns of two counters in the same bytes. A second counter shows a half-written report only if it is elsewhere.
void twice(const Side& side) {
  for (size_t i = 0; i < side.count(); ++i)
    for (size_t first = 0; first < i; ++first) {
      const Field &a = side.report.fields[first], &b = side.report.fields[i];
      if (a.role != b.role || a.role != Role::kSequence || a.at != b.at || a.bit_skip != b.bit_skip) continue;
      if (!a.sound || !b.sound) continue;
      side.warn(i, "at",
                fmt::format("these bytes are already the counter of fields[{}], so this counter adds nothing; give it "
                            "another place, or remove it",
                            first));
    }
}

/// Warns of two flags that are the same bits with the same meaning of 0: a board that is enabled would always be
/// calibrated as well.
void sameFlags(const Side& side) {
  constexpr Role kFlags[] = {Role::kButton, Role::kFault,     Role::kCalibrated,
                             Role::kEnable, Role::kCalibrate, Role::kFollow};
  const auto is_flag = [&](const Field& field) {
    return std::find(std::begin(kFlags), std::end(kFlags), field.role) != std::end(kFlags);
  };
  for (size_t i = 0; i < side.count(); ++i)
    for (size_t first = 0; first < i; ++first) {
      const Field &a = side.report.fields[first], &b = side.report.fields[i];
      if (!is_flag(a) || !is_flag(b) || a.inverted != b.inverted || !a.sound || !b.sound) continue;
      if (codec::isText(a.type) && a.bit != b.bit) continue;
      if (codec::bitsTaken(a, side.report.size) != codec::bitsTaken(b, side.report.size)) continue;
      const Node* is = side.fields.items[first].find("is");
      side.warn(i, "at",
                fmt::format("these bits are already fields[{}] ({}), so the two are always the same; give one of them "
                            "another place, or remove it",
                            first, is != nullptr ? is->scalar : ""));
    }
}

/// Warns of a polynomial with reversed bits, such as 0xa001 for 0x8005, which data sheets of reflected CRCs often give.
void polynomialBackwards(const Side& side) {
  for (const size_t i : side.of({Role::kChecksum})) {
    const codec::Check& check = side.report.fields[i].check;
    if (check.method != codec::Checksum::kCrc || side.fields.items[i].find("polynomial") == nullptr) continue;
    uint64_t back = 0;
    for (unsigned bit = 0; bit < check.bits; ++bit) back |= (check.polynomial >> bit & 1) << (check.bits - 1 - bit);
    const auto known = [&check](uint64_t polynomial) {
      for (const codec::NamedCrc& crc : codec::namedCrcs())
        if (crc.check.bits == check.bits && crc.check.polynomial == polynomial) return true;
      return false;
    };
    if (known(check.polynomial) || !known(back)) continue;
    side.warn(i, "polynomial",
              fmt::format("{0:#x} is {1:#x} with its bits reversed, as in program code of reflected CRCs; expected "
                          "polynomial: {1:#x} and reflected: true",
                          check.polynomial, back));
  }
}

/// Warns of an offset that has no effect, because calibration in a pose takes the zero from where the arm is held.
void idleOffset(const Side& side) {
  constexpr double kPose = 2;  // index in the choices none, device, pose
  const scene::Value* method = givenIn(side.device.parameters, "calibration.method");
  if (method == nullptr || method->number != kPose) return;
  for (const size_t i : side.of({Role::kPosition}))
    for (const char* key : {"offset", "offset_degrees"})
      if (side.fields.items[i].find(key) != nullptr && side.report.fields[i].offset != 0)
        side.warn(i, key,
                  "has no effect: with calibration.method pose, the zero comes from where the arm is held; remove this "
                  "key, or set calibration.method: none if the encoders are absolute");
}

}  // namespace

void warnOfImplausibleFields(const Node& root, const scene::Device& device, size_t joints,
                             const host::DeviceInstance* arm, document::Problems& warnings) {
  const Node* in = find(root, {"parameters", "wire", "input", "fields"});
  const Node* out = find(root, {"parameters", "wire", "output", "fields"});
  const auto wire = wireDraftOf(device, joints);
  if (!wire || in == nullptr || out == nullptr) return;
  const Side input{"input", wire->input, *in, device, warnings}, output{"output", wire->output, *out, device, warnings};
  const Node* kind = find(root, {"parameters", "arm", "kind"});
  const bool alike = kind != nullptr && kind->scalar != "chain";
  if (arm != nullptr)
    coarseCounts(root, input, *arm);
  else
    coarseAngles(input);
  degreesPerCount(input);
  for (const Side* side : {&input, &output}) polynomialBackwards(*side);
  idleOffset(input);
  coarseVelocities(input);
  radiansAsDegrees(input);
  for (const Side* side : {&input, &output}) {
    mixedOrder(*side);
    mixedSigns(*side, side == &input ? Role::kPosition : Role::kTorque);
    if (alike) unlikeOthers(*side, side == &input ? Role::kPosition : Role::kTorque, motorsOf(device, joints));
    twice(*side);
    sameFlags(*side);
  }
  otherOrderOut(input, output);
  crossedJoints(input, output);
}

}  // namespace hapticd::diagnostics
