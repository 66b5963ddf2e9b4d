// SPDX-License-Identifier: MIT
#include "codec/wire.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "codec/tree.hpp"

namespace hapticd::codec {
namespace {

constexpr double kMaxRate = 20000;
constexpr size_t kMaxSteps = 64;

template <class T>
struct Name {
  const char* name;
  T value;
};
constexpr Name<Type> kTypes[] = {{"i8", Type::kI8},          {"i16", Type::kI16}, {"i32", Type::kI32},
                                 {"u8", Type::kU8},          {"u16", Type::kU16}, {"u32", Type::kU32},
                                 {"f32", Type::kF32},        {"f64", Type::kF64}, {"nibble", Type::kNibble},
                                 {"nibbles", Type::kNibbles}};
constexpr Name<Role> kRoles[] = {
    {"position", Role::kPosition},     {"velocity", Role::kVelocity}, {"torque", Role::kTorque},
    {"button", Role::kButton},         {"sequence", Role::kSequence}, {"fault", Role::kFault},
    {"calibrated", Role::kCalibrated}, {"firmware", Role::kFirmware}, {"constant", Role::kConstant},
    {"checksum", Role::kChecksum},     {"enable", Role::kEnable},     {"calibrate", Role::kCalibrate},
    {"reference", Role::kReference},   {"follow", Role::kFollow},     {"starts", Role::kStarts}};
constexpr Name<Checksum> kMethods[] = {
    {"sum8", Checksum::kSum8}, {"xor8", Checksum::kXor8}, {"crc16", Checksum::kCrc16}};
constexpr Name<bool> kOrders[] = {{"little", false}, {"big", true}};
constexpr Name<Exchange> kExchanges[] = {{"stream", Exchange::kStream}, {"poll", Exchange::kPoll}};

template <class T, size_t N>
T choiceOf(const Tree& tree, const Name<T> (&names)[N]) {
  const std::string text = tree.text();
  std::string all;
  for (const Name<T>& name : names) {
    if (text == name.name) return name.value;
    all += (all.empty() ? "" : ", ") + std::string(name.name);
  }
  tree.fail("\"" + text + "\", expected one of " + all);
}

bool perJoint(Role role) {
  return role == Role::kPosition || role == Role::kVelocity || role == Role::kTorque || role == Role::kReference;
}

bool isInteger(Type type) {
  return type != Type::kF32 && type != Type::kF64;
}

void readTarget(const Tree& tree, size_t joints, bool input, Field& field) {
  const Tree is = tree.at("is");
  field.role = choiceOf(is, kRoles);
  const bool only_in = field.role == Role::kPosition || field.role == Role::kVelocity || field.role == Role::kButton ||
                       field.role == Role::kFault || field.role == Role::kCalibrated || field.role == Role::kStarts;
  const bool only_out = field.role == Role::kEnable || field.role == Role::kCalibrate ||
                        field.role == Role::kReference || field.role == Role::kFollow;
  if ((input && only_out) || (!input && only_in))
    is.fail("\"" + is.text() + "\" in an " + (input ? "input" : "output") + " report, expected it in the other one");
  if (perJoint(field.role))
    field.index = static_cast<uint8_t>(tree.at("joint").whole(1, static_cast<double>(joints)) - 1);
  if (field.role == Role::kButton) field.index = static_cast<uint8_t>(tree.at("button").whole(1, kMaxButtons) - 1);
}

void readNumber(const Tree& tree, const Report& report, Field& field) {
  field.type = choiceOf(tree.at("type"), kTypes);
  const size_t bytes = sizeOf(field.type);
  if (bytes > report.size)
    tree.at("type").fail("takes " + std::to_string(bytes) + " bytes, expected no more than the report's " +
                         std::to_string(report.size));
  field.at = static_cast<uint16_t>(tree.at("at").whole(0, static_cast<double>(report.size - bytes)));
  if (tree.has("endian")) field.big_endian = choiceOf(tree.at("endian"), kOrders);
  const auto [least, most] = rangeOf(field.type);
  field.least = least, field.most = most;
  if (tree.has("bit")) {
    if (!isInteger(field.type) || field.type == Type::kNibbles)
      tree.at("bit").fail("of a " + tree.at("type").text() + ", expected a whole-number type");
    const double bits = field.type == Type::kNibble ? 4 : 8 * static_cast<double>(bytes);
    field.bit = static_cast<int8_t>(tree.at("bit").whole(0, bits - 1));
  }
  if (tree.has("inverted")) field.inverted = tree.at("inverted").boolean();
}

void readScale(const Tree& tree, Field& field) {
  const double degree = M_PI / 180;
  if (tree.has("scale")) field.scale = tree.at("scale").number(-1e9, 1e9);
  if (tree.has("offset")) field.offset = tree.at("offset").number(-1e9, 1e9);
  if (tree.has("scale_degrees")) field.scale = degree * tree.at("scale_degrees").number(-1e9, 1e9);
  if (tree.has("offset_degrees")) field.offset = degree * tree.at("offset_degrees").number(-1e9, 1e9);
  if (!(std::abs(field.scale) > 0)) tree.at("scale").fail("0, expected the SI value of one raw unit");
  if (tree.has("limit")) {
    const double limit = tree.at("limit").number(0, field.most);
    field.least = std::max(field.least, -limit), field.most = limit;
  }
  if (tree.has("wraps")) {
    field.wraps = tree.at("wraps").boolean();
    if (field.wraps && (!isInteger(field.type) || field.role != Role::kPosition))
      tree.at("wraps").fail("true, expected it only with a whole-number position");
  }
}

Field readField(const Tree& tree, const Report& report, size_t joints, bool input) {
  tree.only({"is", "joint", "button", "at", "type", "endian", "bit", "inverted", "scale", "offset", "scale_degrees",
             "offset_degrees", "limit", "wraps", "value", "method", "from", "to"});
  Field field;
  readTarget(tree, joints, input, field);
  readNumber(tree, report, field);
  if (perJoint(field.role)) readScale(tree, field);
  if (field.role == Role::kConstant || field.role == Role::kFirmware)
    field.value = tree.at("value").number(field.least, field.most);
  if (field.role == Role::kEnable || field.role == Role::kCalibrate || field.role == Role::kFollow)
    field.value = tree.has("value") ? tree.at("value").number(field.least, field.most) : 1;
  if (field.role == Role::kChecksum) {
    field.method = choiceOf(tree.at("method"), kMethods);
    field.from = static_cast<uint16_t>(tree.at("from").whole(0, static_cast<double>(report.size - 1)));
    field.to = static_cast<uint16_t>(tree.at("to").whole(field.from + 1.0, static_cast<double>(report.size)));
    const size_t needs = field.method == Checksum::kCrc16 ? 2 : 1;
    if (sizeOf(field.type) < needs || !isInteger(field.type) || field.type >= Type::kNibble)
      tree.at("type").fail("\"" + tree.at("type").text() + "\", expected u8 for sum8 and xor8, u16 for crc16");
    if (field.at < field.to && field.at + sizeOf(field.type) > field.from)
      tree.at("at").fail("lies inside the bytes that the checksum covers, expected it outside");
  }
  return field;
}

bool has(const Report& report, Role role) {
  return std::any_of(report.fields.begin(), report.fields.end(), [&](const Field& f) { return f.role == role; });
}

/// One field of a role for each joint.
void requireEach(const Tree& fields, const Report& report, size_t joints, Role role, const char* what) {
  for (size_t joint = 0; joint < joints; ++joint) {
    int found = 0;
    for (const Field& field : report.fields) found += field.role == role && field.index == joint ? 1 : 0;
    if (found != 1)
      fields.fail(std::to_string(found) + what + " of joint " + std::to_string(joint + 1) + ", expected one");
  }
}

Report readReport(const Tree& tree, size_t joints, bool input) {
  tree.only({"id", "size", "fields"});
  Report report;
  if (tree.has("id")) report.id = static_cast<int>(tree.at("id").whole(1, 255));
  report.size = static_cast<size_t>(tree.at("size").whole(1, kMaxReportBytes - 1));
  const Tree fields = tree.at("fields");
  for (size_t i = 0; i < fields.count(); ++i) report.fields.push_back(readField(fields.item(i), report, joints, input));
  requireEach(fields, report, joints, input ? Role::kPosition : Role::kTorque, input ? " positions" : " torques");
  if (has(report, Role::kReference)) requireEach(fields, report, joints, Role::kReference, " references");
  if (has(report, Role::kReference) != has(report, Role::kFollow))
    fields.fail("references and \"follow\" belong together, expected both or none");
  return report;
}

std::vector<uint8_t> bytesOf(const Tree& tree) {
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < tree.count(); ++i) bytes.push_back(static_cast<uint8_t>(tree.item(i).whole(0, 255)));
  return bytes;
}

StartStep readStep(const Tree& tree) {
  tree.only({"control", "send", "expect", "tries", "wait", "timeout"});
  StartStep step;
  if (tree.has("control")) {
    const Tree control = tree.at("control");
    control.only({"type", "request", "value", "index"});
    step.is_control = true;
    step.request_type = static_cast<uint8_t>(control.at("type").whole(0, 127));  // to the device: nothing to read back
    step.request = static_cast<uint8_t>(control.at("request").whole(0, 255));
    if (control.has("value")) step.value = static_cast<uint16_t>(control.at("value").whole(0, 65535));
    if (control.has("index")) step.index = static_cast<uint16_t>(control.at("index").whole(0, 65535));
  }
  if (tree.has("send")) step.send = bytesOf(tree.at("send"));
  if (tree.has("expect")) step.expect = bytesOf(tree.at("expect"));
  if (!step.is_control && step.send.empty() && step.expect.empty())
    tree.fail("is empty, expected control, send or expect");
  if (tree.has("tries")) step.tries = static_cast<int>(tree.at("tries").whole(1, 1000));
  if (tree.has("wait")) step.wait = tree.at("wait").number(0, 10);
  if (tree.has("timeout")) step.timeout = tree.at("timeout").number(0.001, 10);
  return step;
}

Framing readFraming(const Tree& tree) {
  tree.only({"header", "packet", "start", "end"});
  Framing framing;
  framing.used = true;
  if (tree.has("packet")) framing.packet = static_cast<size_t>(tree.at("packet").whole(8, 1024));
  if (tree.has("header"))
    framing.header = static_cast<size_t>(tree.at("header").whole(0, static_cast<double>(framing.packet - 1)));
  if (tree.has("start")) framing.start = static_cast<int>(tree.at("start").whole(0, 255));
  if (tree.has("end")) framing.end = static_cast<int>(tree.at("end").whole(0, 255));
  return framing;
}

}  // namespace

Wire readWire(const std::string& json, size_t joints) {
  const Document document(json, "wire");
  const Tree tree = document.root();
  tree.only({"exchange", "rate", "keep_alive", "watchdog", "framing", "startup", "input", "output", "endpoints"});
  Wire wire;
  if (tree.has("exchange")) wire.exchange = choiceOf(tree.at("exchange"), kExchanges);
  wire.rate = tree.at("rate").number(50, kMaxRate);
  if (tree.has("keep_alive")) wire.keep_alive = tree.at("keep_alive").number(1e-4, 1);
  if (tree.has("watchdog")) wire.watchdog = tree.at("watchdog").number(0, 10);
  if (wire.watchdog > 0 && wire.keep_alive > wire.watchdog / 2)
    tree.at("keep_alive").fail("more than half of the watchdog time, expected less: the motors would stutter");
  if (tree.has("framing")) wire.framing = readFraming(tree.at("framing"));
  if (tree.has("startup"))
    for (size_t i = 0; i < tree.at("startup").count(); ++i) {
      if (i == kMaxSteps) tree.at("startup").fail("has more than " + std::to_string(kMaxSteps) + " steps");
      wire.startup.push_back(readStep(tree.at("startup").item(i)));
    }
  if (tree.has("endpoints")) {
    const Tree endpoints = tree.at("endpoints");
    endpoints.only({"in", "out"});
    wire.endpoint_in = static_cast<uint8_t>(endpoints.at("in").whole(0x81, 0x8f));
    wire.endpoint_out = static_cast<uint8_t>(endpoints.at("out").whole(0x01, 0x0f));
  }
  wire.input = readReport(tree.at("input"), joints, true);
  wire.output = readReport(tree.at("output"), joints, false);
  return wire;
}

}  // namespace hapticd::codec
