// SPDX-License-Identifier: MIT
#include "codec/wire_overlap.hpp"

#include <algorithm>
#include <string>

#include "codec/bits.hpp"

namespace hapticd::codec {
namespace {

bool isFlag(Role role) {
  return role == Role::kButton || role == Role::kFault || role == Role::kCalibrated || role == Role::kEnable ||
         role == Role::kCalibrate || role == Role::kFollow;
}

/// True for a field whose number changes with time: a flag in its bits would change with the number.
bool isNumber(Role role) {
  return ofJoint(role) || role == Role::kSequence || role == Role::kStarts || role == Role::kTime ||
         role == Role::kChecksum;
}

/// Bits that two fields may not share. Flags may share a status byte, and constants may cover anything. A clock may also
/// count the reports; a second counter of the same bytes adds nothing, and `hapticd check` warns of it.
bool exclusive(Role a, Role b) {
  const auto counts = [](Role role) { return role == Role::kTime || role == Role::kSequence; };
  if (counts(a) && counts(b)) return false;
  return ofJoint(a) || ofJoint(b) || (isNumber(a) && (isFlag(b) || isNumber(b))) || (isFlag(a) && isNumber(b));
}

/// Returns the name of a field for messages: "fields[0] (position of joint 1)".
std::string nameOf(const Tree& fields, const Field& field, const FieldFacts& known, size_t i) {
  std::string name = "fields[" + std::to_string(i) + "] (" + fields.item(i).at("is").text();
  if (ofJoint(field.role) && known.target) name += " of joint " + std::to_string(field.index + 1);
  return name + ")";
}

/// Returns the first byte in which both fields use the same bit, or the size of the report if there is none.
size_t firstShared(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  size_t byte = 0;
  while (byte < a.size() && (a[byte] & b[byte]) == 0) ++byte;
  return byte;
}

}  // namespace

std::vector<uint8_t> bitsTaken(const Field& field, size_t report_bytes) {
  std::vector<uint8_t> taken(report_bytes);
  if (field.at + field.bytes() > report_bytes) return taken;
  if (field.type == Type::kNibble || field.type == Type::kNibbles) {
    std::fill_n(taken.begin() + field.at, field.bytes(), uint8_t{0xff});
    return taken;
  }
  const bool one = isFlag(field.role) && field.bit >= 0;
  const uint64_t code = one ? uint64_t{1} << field.bit : onesOf(field.bits);
  putBits(code, &taken[field.at], field.bit_skip, field.bits, field.big_endian);
  return taken;
}

std::vector<const Field*> outsideChecksum(const Report& report) {
  std::vector<bool> covered(report.size);
  bool any = false;
  for (const Field& field : report.fields)
    if (field.role == Role::kChecksum) {
      any = true;
      std::fill(covered.begin() + field.from, covered.begin() + field.to, true);
    }
  std::vector<const Field*> outside;
  for (const Field& field : report.fields) {
    const auto first = covered.begin() + field.at;
    if (any && ofJoint(field.role) &&
        std::find(first, first + static_cast<long>(field.bytes()), false) != first + static_cast<long>(field.bytes()))
      outside.push_back(&field);
  }
  return outside;
}

void checkOverlaps(const Tree& fields, const Report& report, const std::vector<FieldFacts>& known) {
  const auto usable = [&known](size_t i) { return known[i].role && known[i].placed; };
  std::vector<std::vector<uint8_t>> taken;
  for (const Field& field : report.fields) taken.push_back(bitsTaken(field, report.size));
  for (size_t later = 1; later < taken.size(); ++later)
    for (size_t i = 0; i < later; ++i) {
      const bool matters = exclusive(report.fields[i].role, report.fields[later].role);
      if (!matters || !usable(i) || !usable(later)) continue;
      const size_t byte = firstShared(taken[i], taken[later]);
      if (byte == report.size) continue;
      const Tree tree = fields.item(later);
      tree.at(tree.has("at") ? "at" : "bit_offset")
          .fail("takes bits of byte " + std::to_string(byte) + ", which " +
                nameOf(fields, report.fields[i], known[i], i) +
                " uses already; correct at, bit_offset or type of one of the two fields");
      break;
    }
}

}  // namespace hapticd::codec
