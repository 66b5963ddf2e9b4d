// SPDX-License-Identifier: MIT
#include "codec/wire_marks.hpp"

#include <array>
#include <cstdio>
#include <span>
#include <string>

#include "codec/wire_overlap.hpp"

namespace hapticd::codec {
namespace {

/// One mark: its byte of the report, counted without the id.
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

/// The byte of a mark as one constant of the report writes it.
uint8_t writtenAt(const Report& report, const Field& field, size_t at) {
  Report alone;
  alone.size = report.size;
  alone.fields.push_back(field);
  std::array<uint8_t, kMaxReportBytes> bytes{};
  (void)encode(alone, Order{}, bytes);
  return bytes[at];
}

/// Bits of a mark's byte that the file gives: all of them must be those of the mark.
void placeMark(const Tree& tree, const Mark& mark, bool framed, Report& report) {
  uint8_t given = 0;
  for (size_t i = 0; i < report.fields.size(); ++i) {
    const Field& field = report.fields[i];
    const uint8_t bits = bitsTaken(field, report.size)[mark.at];
    if (bits == 0) continue;
    given |= bits;
    const bool fixed = field.role == Role::kConstant || field.role == Role::kFirmware;
    if (!framed || (fixed && (writtenAt(report, field, mark.at) & bits) == (mark.value & bits))) continue;
    const Tree wrong = tree.at("fields").item(i);
    wrong.at(fixed             ? "value"
             : wrong.has("at") ? "at"
                               : "bit_offset")
        .fail((fixed ? "is " + hexOf(writtenAt(report, field, mark.at)) + " in byte " : "takes bits of byte ") +
              std::to_string(mark.at) + ", where framing." + mark.key + " puts its mark " + hexOf(mark.value) +
              ", expected " +
              (fixed ? "the same number, or none: the mark is written without a constant"
                     : "another place: size and at count the marks"));
    return;
  }
  // What the file says of this byte of a command without escapes is a head of its own.
  if (given == 0 || framed) report.fields.push_back(constantAt(mark));
}

}  // namespace

void placeMarks(const Tree& tree, const Framing& framing, bool framed, Report& report) {
  if (framing.start >= 0 && framing.end >= 0 && report.bytes() < 2)
    return tree.at("size").fail("1, expected 2 or more: framing.start and framing.end are bytes of the report");
  if (framing.start >= 0 && report.id >= 0 && report.id != framing.start) {
    if (framed)
      tree.at("id").fail(std::to_string(report.id) + " is the first byte, where framing.start puts its mark " +
                         hexOf(framing.start) + ", expected no id: a constant at 1 tells kinds of reports apart");
  } else if (framing.start >= 0 && report.id < 0) {
    placeMark(tree, {"start", framing.start, 0}, framed, report);
  }
  if (framing.end >= 0) placeMark(tree, {"end", framing.end, report.size - 1}, framed, report);
}

}  // namespace hapticd::codec
