// SPDX-License-Identifier: MIT
#include "codec/wire.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "codec/choice.hpp"
#include "codec/tree.hpp"
#include "codec/wire_field.hpp"
#include "codec/wire_marks.hpp"
#include "codec/wire_overlap.hpp"

namespace hapticd::codec {
namespace {

constexpr size_t kMaxSteps = 64;
constexpr size_t kMaxFields = 1024;  ///< of a report: each field is compared with all others

constexpr Name<Exchange> kExchanges[] = {{"stream", Exchange::kStream}, {"poll", Exchange::kPoll}};
constexpr const char* kWireKeys[] = {"exchange", "rate",  "watchdog", "framing",
                                     "startup",  "input", "output",   "endpoints"};
constexpr const char* kReportKeys[] = {"id", "size", "fields"};
constexpr const char* kStepKeys[] = {"control", "send", "expect", "tries", "wait", "timeout"};
constexpr const char* kControlKeys[] = {"type", "request", "value", "index"};
constexpr const char* kFramingKeys[] = {"header", "packet", "start", "end", "escape"};
constexpr const char* kEscapeKeys[] = {"mark", "xor", "bytes", "codes"};
constexpr const char* kEndpointKeys[] = {"in", "out"};

/// Reads the address of an endpoint. @param direction 0x80 for what the arm sends, 0 for what it gets
uint8_t endpointAt(const Tree& tree, unsigned direction) {
  const size_t before = tree.problems();
  const auto address = static_cast<unsigned>(tree.whole(0, 0xff));
  const bool good = (address & 0xf0U) == direction && (address & 0x0fU) != 0;
  if (tree.problems() == before && !good)
    tree.fail(std::to_string(address) + (direction != 0
                                             ? ", expected a number from 129 to 143 (0x81 to 0x8f): endpoints of what "
                                               "the arm sends have the bit 0x80"
                                             : ", expected a number from 1 to 15 (0x01 to 0x0f): endpoints of what "
                                               "the arm gets lack the bit 0x80"));
  return static_cast<uint8_t>(address);
}

/// A report that was read, and what is known of it.
struct ReadReport {
  Report report;
  std::vector<FieldFacts> known;  ///< of each field
  bool sized = false;             ///< true if its size is known

  /// Returns how many fields could be the ones of this role that seem to be missing: those whose role could not be
  /// read, and those of this role whose joint could not be read.
  size_t unknown(Role role) const {
    size_t count = 0;
    for (size_t i = 0; i < known.size(); ++i)
      count += !known[i].role || (report.fields[i].role == role && !known[i].target) ? 1 : 0;
    return count;
  }
};

/// Notes a problem for each joint that has two fields of this role, or none. If fields with mistakes may be the missing
/// ones, nothing is noted of those.
void requireEach(const Tree& fields, const ReadReport& read, size_t joints, Role role, const char* what) {
  const Report& report = read.report;
  std::string missing;
  size_t lacks = 0;
  for (size_t joint = 0; joint < joints; ++joint) {
    const std::string number = std::to_string(joint + 1), which = std::string(what) + " of joint " + number;
    std::optional<size_t> first;
    for (size_t i = 0; i < report.fields.size(); ++i) {
      if (!read.known[i].target || report.fields[i].role != role || report.fields[i].index != joint) continue;
      if (first)
        fields.item(i).at("joint").fail(number + ", but fields[" + std::to_string(*first) + "] is the " + which +
                                        " already; give one of them another joint, or remove it");
      else
        first = i;
    }
    if (!first) missing += (missing.empty() ? "" : ", ") + number, ++lacks;
  }
  if (lacks <= read.unknown(role)) return;
  if (lacks == 1)
    fields.fail("no " + std::string(what) + " of joint " + missing + ", expected one field {is: " + what +
                ", joint: " + missing + "}");
  else
    fields.fail("no " + std::string(what) + " of joints " + missing + ", expected one field {is: " + what +
                ", joint: N} for each");
}

/// Returns the number of joints that the fields of this role name.
size_t jointsNamed(const Report& report, Role role) {
  size_t joints = 0;
  for (const Field& field : report.fields)
    if (field.role == role) joints = std::max<size_t>(joints, field.index + size_t{1});
  return joints;
}

/// Reads the fields, and checks that no field that an arm needs is missing. Where the number of joints is not known, it
/// is the highest one that the fields name.
void readFields(const Tree& fields, size_t joints, bool input, ReadReport& read) {
  Report& report = read.report;
  for (size_t i = 0; i < fields.count(); ++i) {
    if (i == kMaxFields) {
      fields.fail("has more than " + std::to_string(kMaxFields) + " fields");
      break;
    }
    const ReadField one = readField(fields.item(i), report, joints, input);
    report.fields.push_back(one.field);
    report.fields.back().sound = one.known.all;
    read.known.push_back(one.known);
  }
  if (!fields.exists()) return;
  report.whole = std::all_of(read.known.begin(), read.known.end(), [](const FieldFacts& one) { return one.target; });
  report.placed = read.sized && report.whole &&
                  std::all_of(read.known.begin(), read.known.end(), [](const FieldFacts& one) { return one.placed; });
  checkOverlaps(fields, report, read.known);
  if (joints == 0) joints = jointsNamed(report, input ? Role::kPosition : Role::kTorque);
  requireEach(fields, read, joints, input ? Role::kPosition : Role::kTorque, input ? "position" : "torque");
  if (report.has(Role::kReference)) requireEach(fields, read, joints, Role::kReference, "reference");
  const bool roles = std::all_of(read.known.begin(), read.known.end(), [](const FieldFacts& one) { return one.role; });
  if (roles && report.has(Role::kReference) != report.has(Role::kFollow))
    fields.fail("\"reference\" and \"follow\" belong together; expected fields of both, or of neither");
}

ReadReport readReport(const Tree& tree, size_t joints, bool input) {
  ReadReport read;
  Report& report = read.report;
  if (!tree.exists()) return read;
  tree.only(kReportKeys, kWireKeys);
  if (tree.has("id")) report.id = static_cast<int>(tree.at("id").whole(1, 255));
  const size_t before = tree.problems();
  report.size = static_cast<size_t>(tree.at("size").whole(1, kMaxReportBytes - 1));
  read.sized = tree.problems() == before;
  if (!read.sized) report.size = kMaxReportBytes - 1;  // the size is unknown: notes this once, not once per field
  readFields(tree.at("fields"), joints, input, read);
  return read;
}

std::vector<uint8_t> bytesOf(const Tree& tree) {
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < tree.count(); ++i) bytes.push_back(static_cast<uint8_t>(tree.item(i).whole(0, 255)));
  return bytes;
}

void readControl(const Tree& control, StartStep& step) {
  control.only(kControlKeys);
  step.is_control = true;
  step.request_type = static_cast<uint8_t>(control.at("type").whole(0, 127));  // 0 to 127 send to the device
  step.request = static_cast<uint8_t>(control.at("request").whole(0, 255));
  if (control.has("value")) step.value = static_cast<uint16_t>(control.at("value").whole(0, 65535));
  if (control.has("index")) step.index = static_cast<uint16_t>(control.at("index").whole(0, 65535));
}

StartStep readStep(const Tree& tree) {
  StartStep step;
  tree.only(kStepKeys);
  if (tree.has("control")) readControl(tree.at("control"), step);
  if (tree.has("send")) step.send = bytesOf(tree.at("send"));
  if (tree.has("expect")) step.expect = bytesOf(tree.at("expect"));
  if (!tree.has("control") && !tree.has("send") && !tree.has("expect"))
    tree.fail("is empty; expected the key control, send or expect");
  if (tree.has("tries")) step.tries = static_cast<int>(tree.at("tries").whole(1, 1000));
  if (tree.has("wait")) step.wait = tree.at("wait").number(0, 10, "s");
  if (tree.has("timeout")) step.timeout = tree.at("timeout").number(0.001, 10, "s");
  return step;
}

uint8_t byteOf(const Tree& tree) {
  return static_cast<uint8_t>(tree.whole(0, 255));
}

Escape readEscape(const Tree& tree) {
  Escape escape;
  escape.used = true;
  tree.only(kEscapeKeys);
  escape.mark = byteOf(tree.at("mark"));
  if (tree.has("codes")) {
    const Tree codes = tree.at("codes");
    if (codes.count() < 1 || codes.count() > escape.code.size())
      return codes.fail("has " + std::to_string(codes.count()) +
                        " codes, expected 1 to 8: [[0xc0, 0xdc], [0xdb, 0xdd]]"),
             escape;
    for (; escape.count < codes.count(); ++escape.count) {
      const Tree pair = codes.item(escape.count);
      if (pair.count() != 2) return pair.fail("expected a byte and its code: [0xc0, 0xdc]"), escape;
      escape.plain[escape.count] = byteOf(pair.item(0));
      escape.code[escape.count] = byteOf(pair.item(1));
    }
    if (tree.has("xor")) tree.at("xor").fail("cannot be used together with codes; remove one of the two");
    if (tree.has("bytes")) tree.at("bytes").fail("cannot be used together with codes; remove one of the two");
    const auto end = escape.plain.begin() + static_cast<long>(escape.count);
    if (std::find(escape.plain.begin(), end, escape.mark) == end)
      codes.fail(
          "no code stands for the escape mark itself; add one: [mark, code] (a byte equal to the mark could not be "
          "sent otherwise)");
    return escape;
  }
  if (tree.has("xor")) escape.flip = static_cast<uint8_t>(tree.at("xor").whole(1, 255));
  if (!tree.has("bytes")) return escape;
  const Tree also = tree.at("bytes");
  escape.also_count = also.count();
  if (escape.also_count > escape.also.size()) return also.fail("has more than 16 bytes"), escape.also_count = 0, escape;
  for (size_t i = 0; i < escape.also_count; ++i) escape.also[i] = byteOf(also.item(i));
  return escape;
}

/// Reads the byte of a mark. @param known set to false if neither the byte nor what was meant can be told
uint8_t markOf(const Tree& tree, bool& known) {
  const size_t before = tree.problems();
  const uint8_t mark = byteOf(tree);
  if (tree.problems() != before && mark == 0) known = false;
  return mark;
}

Framing readFraming(const Tree& tree, bool& marks_known) {
  Framing framing;
  framing.used = true;
  tree.only(kFramingKeys);
  if (tree.has("packet")) framing.packet = static_cast<size_t>(tree.at("packet").whole(8, 1024));
  if (tree.has("header"))
    framing.header = static_cast<size_t>(tree.at("header").whole(0, static_cast<double>(framing.packet - 1)));
  if (tree.has("start")) framing.start = markOf(tree.at("start"), marks_known);
  if (tree.has("end")) framing.end = markOf(tree.at("end"), marks_known);
  if (!tree.has("escape")) return framing;
  framing.escape = readEscape(tree.at("escape"));
  if (framing.start < 0 && framing.end < 0)
    tree.at("escape").fail("escapes need a mark; give framing.start or framing.end, or remove framing.escape");
  for (const int mark : {framing.start, framing.end})
    if (mark == framing.escape.mark)
      tree.at("escape").fail("its mark is the same byte as framing.start or framing.end; give it another byte");
  for (const int mark : {framing.start, framing.end})
    if (mark >= 0 && framing.escape.count > 0 && !framing.escapes(static_cast<uint8_t>(mark)))
      tree.at("escape").fail("no code stands for the byte of framing.start or framing.end; add one to codes");
  return framing;
}

std::string secondsOf(double time) {
  char text[32];
  std::snprintf(text, sizeof text, "%g s", time);
  return text;
}

/// Reads whether the arm sends by itself or answers, and how often.
void readTimes(const Tree& tree, Wire& wire) {
  if (tree.has("exchange")) wire.exchange = choiceOf(tree.at("exchange"), kExchanges);
  const size_t before = tree.problems();
  wire.rate = tree.at("rate").number(kLeastRate, kMostRate, "Hz");
  if (tree.has("watchdog")) wire.watchdog = tree.at("watchdog").number(0, 10, "s (20 ms is 0.02 s)");
  const double pause = 1 / wire.rate;  // between two commands
  if (tree.problems() == before && wire.watchdog > 0 && pause > wire.watchdog / 2)
    tree.at("watchdog")
        .fail("is " + secondsOf(wire.watchdog) + ", and commands are sent at wire.rate, each " + secondsOf(pause) +
              ", so one that comes late could switch the motors off; expected " + secondsOf(2 * pause) + " or more");
}

void readStartup(const Tree& steps, Wire& wire) {
  for (size_t i = 0; i < steps.count(); ++i) {
    if (i == kMaxSteps) return steps.fail("has more than " + std::to_string(kMaxSteps) + " steps");
    wire.startup.push_back(readStep(steps.item(i)));
  }
}

/// Reads a block that stands inside of a report as the one beside it that it is meant to be.
void readMisplaced(const Tree& tree) {
  for (const char* side : {"input", "output"})
    for (const char* key : kWireKeys)
      if (tree.has(side) && tree.at(side).has(key)) tree.readInstead(key, tree.at(side).at(key));
}

/// Reads the whole description. What is wrong in it has been noted, and has its default.
Wire readAll(const Document& document, size_t joints) {
  const Tree tree = document.root();
  Wire wire;
  tree.only(kWireKeys, {}, kReportKeys, "input or output");
  readMisplaced(tree);
  readTimes(tree, wire);
  bool marks_known = true;
  if (tree.has("framing")) wire.framing = readFraming(tree.at("framing"), marks_known);
  if (tree.has("startup")) readStartup(tree.at("startup"), wire);
  if (tree.has("endpoints")) {
    const Tree endpoints = tree.at("endpoints");
    endpoints.only(kEndpointKeys);
    wire.endpoint_in = endpointAt(endpoints.at("in"), 0x80);
    wire.endpoint_out = endpointAt(endpoints.at("out"), 0);
  }
  ReadReport input = readReport(tree.at("input"), joints, true), output = readReport(tree.at("output"), joints, false);
  if (marks_known) {
    if (tree.has("input")) placeMarks(tree.at("input"), wire.framing, true, input.known, input.sized, input.report);
    if (tree.has("output"))
      placeMarks(tree.at("output"), wire.framing, wire.framing.escape.used, output.known, output.sized, output.report);
  }
  wire.input = std::move(input.report), wire.output = std::move(output.report);
  if (output.sized && wire.framing.escape.used && wire.output.bytes() > kMaxReportBytes / 2)
    tree.at("output").at("size").fail("with framing.escape, a report may have at most half of " +
                                      std::to_string(kMaxReportBytes) + " bytes, because escapes can double its size");
  return wire;
}

}  // namespace

Wire readWire(const std::string& json, size_t joints) {
  const Document document(json, "wire");
  Wire wire = readAll(document, joints);
  document.check();
  return wire;
}

Wire draftOfWire(const std::string& json, size_t joints) {
  const Document document(json, "wire");
  Wire wire = readAll(document, joints);
  wire.startup.clear();
  return wire;
}

std::vector<ReadInstead> misplacedInWire(const std::string& json, size_t joints) {
  const Document document(json, "wire");
  (void)readAll(document, joints);
  return document.readInstead();
}

}  // namespace hapticd::codec
