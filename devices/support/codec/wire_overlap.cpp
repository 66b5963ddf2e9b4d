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

/// Bits that two fields may not share. Flags may share a status byte, and constants may cover anything. A clock may
/// also count the reports; a second counter of the same bytes adds nothing, and `hapticd check` warns of it.
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

/// Returns the bit of the report at which a field begins.
size_t startOf(const Field& field) {
  return size_t{8} * field.at + field.bit_skip;
}

/// Finds fields that share bits, and says at which of them the mistake is.
class Overlaps {
 public:
  Overlaps(const Tree& fields, const Report& report, const std::vector<FieldFacts>& known)
      : fields_(fields), all_(report.fields), size_(report.size), known_(known), too_wide_(all_.size()) {
    for (const Field& field : all_) taken_.push_back(bitsTaken(field, size_));
  }

  /// Notes a problem for the type of each field in which others begin, if its width is the likelier mistake: it has
  /// its digits exchanged, or several fields begin in it.
  void checkWidths() {
    for (size_t wide = 0; wide < all_.size(); ++wide) {
      size_t within = 0, first = wide;
      for (size_t i = 0; i < all_.size(); ++i) {
        if (startOf(all_[i]) <= startOf(all_[wide]) || shared(wide, i) == size_) continue;
        if (within++ == 0 || startOf(all_[i]) < startOf(all_[first])) first = i;
      }
      const std::string meant = within == 0 || isText(all_[wide].type) ? "" : narrower(wide, first, within);
      if (!meant.empty()) blame(wide, first, within, meant);
    }
  }

  /// Notes a problem for each other field that shares a bit with an earlier one.
  void checkPlaces() const {
    for (size_t later = 1; later < all_.size(); ++later)
      for (size_t i = 0; i < later; ++i) {
        const size_t byte = shared(i, later);
        if (byte == size_ || too_wide_[i] || too_wide_[later]) continue;
        if (failForOrder(later, i) || failForOrder(i, later)) break;
        const Tree tree = fields_.item(later);
        tree.at(tree.has("at") ? "at" : "bit_offset")
            .fail("takes bits of byte " + std::to_string(byte) + ", which " + nameOf(fields_, all_[i], known_[i], i) +
                  " uses already; correct at, bit_offset or type of one of the two fields");
        break;
      }
  }

 private:
  /// Notes that `endian` is missing, if a field would be beside the other one with the byte order of that one.
  /// @return false if this is not so
  bool failForOrder(size_t one, size_t other) const {
    const Tree tree = fields_.item(one);
    if (tree.has("endian") || !all_[other].big_endian) return false;
    Field turned = all_[one];
    turned.big_endian = true;
    if (firstShared(bitsTaken(turned, size_), taken_[other]) != size_) return false;
    tree.fail("no endian, so it is little, and its bits are those of " +
              nameOf(fields_, all_[other], known_[other], other) + ", which is big; expected endian: big here, too");
    return true;
  }

  /// Returns the first byte in which two fields share a bit that they may not share; the size of the report if there is
  /// none, or if too little is known about them.
  size_t shared(size_t a, size_t b) const {
    const auto usable = [this](size_t i) { return known_[i].role && known_[i].placed; };
    if (a == b || !exclusive(all_[a].role, all_[b].role) || !usable(a) || !usable(b)) return size_;
    return firstShared(taken_[a], taken_[b]);
  }

  /// Returns the number of bits that was probably meant, so that the field ends where the first of the others begins;
  /// "" if its width is no likelier mistake than a place.
  std::string narrower(size_t wide, size_t first, size_t within) const {
    const size_t room = startOf(all_[first]) - startOf(all_[wide]), bits = all_[wide].bits;
    if (all_[wide].type == Type::kFloat) return room == 32 ? "32" : "";  // the only narrower one
    const size_t exchanged = 10 * (bits % 10) + bits / 10;               // such as 16 of 61
    if (exchanged >= 8 && exchanged <= room && exchanged % 8 == 0) return std::to_string(exchanged);
    return within > 1 && room % 8 == 0 ? std::to_string(room) : "";
  }

  void blame(size_t wide, size_t first, size_t within, const std::string& bits) {
    too_wide_[wide] = true;
    const Tree type = fields_.item(wide).at("type");
    const std::string others = within == 1 ? "" : " (the first of " + std::to_string(within) + " fields in it)";
    type.fail("\"" + type.text() + "\" takes the bytes " + std::to_string(all_[wide].at) + " to " +
              std::to_string(all_[wide].at + all_[wide].bytes() - 1) + ", but " +
              nameOf(fields_, all_[first], known_[first], first) + " begins at byte " +
              std::to_string(startOf(all_[first]) / 8) + others + "; expected a narrower type (did you mean \"" +
              type.text().substr(0, 1) + bits + "\"?), or other values of at");
  }

  const Tree& fields_;
  const std::vector<Field>& all_;
  const size_t size_;
  const std::vector<FieldFacts>& known_;
  std::vector<bool> too_wide_;
  std::vector<std::vector<uint8_t>> taken_;
};

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
  Overlaps overlaps(fields, report, known);
  overlaps.checkWidths();
  overlaps.checkPlaces();
}

}  // namespace hapticd::codec
