// SPDX-License-Identifier: MIT
#include "codec/wire_marks.hpp"

#include <array>
#include <cstdio>
#include <string>

#include "codec/wire_overlap.hpp"

namespace hapticd::codec {
namespace {

/// One mark, and the number of its byte in the report, counted without the id.
struct Mark {
  const char* key;
  int value;
  size_t at;
};

std::string hexOf(int byte) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%02x", static_cast<unsigned>(byte));
  return text;
}

Field constantAt(const Mark& mark) {
  Field field;
  field.role = Role::kConstant;
  field.at = static_cast<uint16_t>(mark.at);
  field.value = mark.value;
  field.code = static_cast<uint64_t>(mark.value);
  field.most = 255;
  return field;
}

/// The value that one constant of the report gives to the byte `at`.
uint8_t writtenAt(const Report& report, const Field& field, size_t at) {
  Report alone;
  alone.size = report.size;
  alone.fields.push_back(field);
  std::array<uint8_t, kMaxReportBytes> bytes{};
  (void)encode(alone, Order{}, bytes);
  return bytes[at];
}

/// Adds a constant for one mark if no field of the file has bits in its byte. If fields have bits there, they must
/// write the bits of the mark; another field is noted as a problem.
void placeMark(const Tree& tree, const Mark& mark, bool framed, const std::vector<FieldFacts>& known, Report& report) {
  uint8_t given = 0;
  for (size_t i = 0; i < known.size(); ++i) {
    const Field& field = report.fields[i];
    const bool fixed = field.role == Role::kConstant || field.role == Role::kFirmware;
    if (!known[i].role || !(fixed ? known[i].all : known[i].placed)) continue;
    const uint8_t bits = bitsTaken(field, report.size)[mark.at];
    if (bits == 0) continue;
    given |= bits;
    if (!framed || (fixed && (writtenAt(report, field, mark.at) & bits) == (mark.value & bits))) continue;
    const Tree wrong = tree.at("fields").item(i);
    wrong.at(fixed             ? "value"
             : wrong.has("at") ? "at"
                               : "bit_offset")
        .fail((fixed ? "is " + hexOf(writtenAt(report, field, mark.at)) + " in byte " : "takes bits of byte ") +
              std::to_string(mark.at) + ", where framing." + mark.key + " puts its mark " + hexOf(mark.value) +
              ", expected " +
              (fixed ? "the same value, or no constant field here (framing writes the mark by itself)"
                     : "another byte: the marks are bytes of the report, so `size` and `at` count them too"));
    return;
  }
  // Without escapes, a field that the file gives for this byte of a command is the head of the command, and stays.
  if (given == 0 || framed) report.fields.push_back(constantAt(mark));
}

/// Notes a constant in the first byte after a report id that must go: without the id, the mark is in its byte, and they
/// differ.
void otherConstant(const Tree& tree, int mark, const std::vector<FieldFacts>& known, const Report& report) {
  for (size_t i = 0; i < known.size(); ++i) {
    const Field& field = report.fields[i];
    if (!known[i].role || !known[i].all || field.role != Role::kConstant || field.at != 0) continue;
    const uint8_t given = writtenAt(report, field, 0);
    if (given == mark) return;
    return tree.at("fields").item(i).at("value").fail(
        "is " + hexOf(given) + " in the first byte after the id, but framing.start puts its mark " + hexOf(mark) +
        " there, if the id is removed; "
        "expected the same value, or no constant field here (framing writes the mark by itself)");
  }
}

}  // namespace

void placeMarks(const Tree& tree, const Framing& framing, bool framed, const std::vector<FieldFacts>& known, bool sized,
                Report& report) {
  if (sized && framing.start >= 0 && framing.end >= 0 && report.bytes() < 2)
    return tree.at("size").fail("1, expected 2 or more: framing.start and framing.end are bytes of the report");
  if (framing.start >= 0 && report.id >= 0 && report.id != framing.start) {
    if (framed) otherConstant(tree, framing.start, known, report);
    if (framed)
      tree.at("id").fail(std::to_string(report.id) + " is the report id, and framing.start puts its mark " +
                         hexOf(framing.start) +
                         " into the same first byte; remove id (a constant field at byte 1 can tell kinds of reports "
                         "apart), or framing, if the arm has none, as over HID");
  } else if (framing.start >= 0 && report.id < 0) {
    placeMark(tree, {"start", framing.start, 0}, framed, known, report);
  }
  if (sized && framing.end >= 0) placeMark(tree, {"end", framing.end, report.size - 1}, framed, known, report);
}

}  // namespace hapticd::codec
