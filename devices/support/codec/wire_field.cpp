// SPDX-License-Identifier: MIT
#include "codec/wire_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>

#include "codec/bits.hpp"
#include "codec/checksum_start.hpp"
#include "codec/choice.hpp"
#include "codec/wire_correction.hpp"
#include "codec/wire_overlap.hpp"

namespace hapticd::codec {
namespace {

constexpr Name<Role> kRoles[] = {{"position", Role::kPosition},
                                 {"velocity", Role::kVelocity},
                                 {"torque", Role::kTorque},
                                 {"button", Role::kButton},
                                 {"sequence", Role::kSequence},
                                 {"counter", Role::kSequence},
                                 {"fault", Role::kFault},
                                 {"calibrated", Role::kCalibrated},
                                 {"firmware", Role::kFirmware},
                                 {"constant", Role::kConstant},
                                 {"checksum", Role::kChecksum},
                                 {"enable", Role::kEnable},
                                 {"calibrate", Role::kCalibrate},
                                 {"reference", Role::kReference},
                                 {"follow", Role::kFollow},
                                 {"starts", Role::kStarts},
                                 {"time", Role::kTime}};
constexpr Name<bool> kOrders[] = {{"little", false}, {"big", true}};
constexpr const char* kKeys[] = {"is",      "joint",         "button",         "at",        "type",
                                 "endian",  "bit",           "bit_offset",     "inverted",  "scale",
                                 "offset",  "scale_degrees", "offset_degrees", "limit",     "wraps",
                                 "value",   "modulo",        "method",         "from",      "to",
                                 "word",    "polynomial",    "initial",        "reflected", "final_xor",
                                 "negated", "over_id"};

bool onlyIn(Role role) {
  return role == Role::kPosition || role == Role::kVelocity || role == Role::kButton || role == Role::kFault ||
         role == Role::kCalibrated || role == Role::kStarts || role == Role::kTime;
}

bool onlyOut(Role role) {
  return role == Role::kEnable || role == Role::kCalibrate || role == Role::kReference || role == Role::kFollow;
}

/// Reads what the field is, and the number of its joint or button.
void readTarget(const Tree& tree, size_t joints, bool input, Field& field, FieldFacts& known) {
  const size_t before = tree.problems();
  const Tree is = tree.at("is");
  const std::string word = is.text();
  if (tree.problems() != before) return;  // it is missing, or no text
  if (word == "watchdog" || word == "heartbeat" || word == "alive")
    return is.fail("\"" + word +
                   "\", expected the role of a byte that tells the arm that commands come: counter if it must change, "
                   "constant if it has one value, enable if it switches the motors on");
  field.role = choiceOf(is, kRoles, [input](Role role) { return !(input ? onlyOut(role) : onlyIn(role)); });
  if (tree.problems() != before) return;
  if (input ? onlyOut(field.role) : onlyIn(field.role))
    return is.fail("\"" + is.text() + "\" cannot be a field of an " +
                   (input ? "input report (what the arm sends); move it to wire.output"
                          : "output report (what the arm gets); move it to wire.input"));
  known.role = true;
  const double most = static_cast<double>(joints > 0 ? joints : kMaxJoints);
  if (ofJoint(field.role))
    field.index = static_cast<uint8_t>(tree.at("joint").whole(1, most, "(joints are counted from 1)") - 1);
  if (field.role == Role::kButton)
    field.index = static_cast<uint8_t>(tree.at("button").whole(1, kMaxButtons, "(buttons are counted from 1)") - 1);
  known.target = tree.problems() == before;
}

/// Reads a type such as "u24" (u, i or f, then the number of bits), or one of the two kinds of text.
/// @return false if the type is unknown
bool readType(const Tree& tree, Field& field) {
  const size_t before = tree.problems();
  const std::string text = tree.text();
  if (text == "nibble" || text == "nibbles") {
    field.type = text == "nibble" ? Type::kNibble : Type::kNibbles;
    field.bits = text == "nibble" ? 8 : 32;
    return true;
  }
  const bool digits = text.size() >= 2 && text.size() <= 3 && text[1] != '0' &&
                      std::all_of(text.begin() + 1, text.end(), [](char c) { return c >= '0' && c <= '9'; });
  const int bits = digits ? std::stoi(text.substr(1)) : 0;
  const char kind = text.empty() ? ' ' : text[0];
  const bool good = (kind == 'u' && bits >= 1 && bits <= 64) || (kind == 'i' && bits >= 2 && bits <= 64) ||
                    (kind == 'f' && (bits == 32 || bits == 64));
  if (good) {
    field.type = kind == 'u' ? Type::kUnsigned : kind == 'i' ? Type::kSigned : Type::kFloat;
    field.bits = static_cast<uint8_t>(bits);
  } else if (tree.exists() && tree.problems() == before) {
    tree.fail("\"" + text +
              "\", expected one of i8, i16, i32, u8, u16, u32 "
              "(any width: i2 to i64, u1 to u64), f32, f64, nibble, nibbles" +
              suggestType(text));
  }
  return good;
}

/// Returns the key of the report's size, such as "wire.input.size", from a key of one of its fields. With the whole
/// key, who shows the message can add the line.
std::string sizeKey(const Tree& of_field) {
  const std::string fields = of_field.path().substr(0, of_field.path().rfind('['));
  return fields.substr(0, fields.rfind('.')) + ".size";
}

/// Reads the first byte of a field. The bits of the field must fit into the report from this byte on.
double readByte(const Tree& at, const Report& report, unsigned bits) {
  const double byte = at.whole(0, kMaxReportBytes);
  const auto first = static_cast<size_t>(byte), last = first + (bits + 7) / 8 - 1;
  if (last < report.size) return byte;
  const std::string bytes =
      first == last ? "byte " + std::to_string(last) : "bytes " + std::to_string(first) + " to " + std::to_string(last);
  at.fail(std::to_string(first) + ", so it takes the " + bytes + ", but " + sizeKey(at) + " is " +
          std::to_string(report.size) + ": the last byte is " + std::to_string(report.size - 1) +
          "; expected size: " + std::to_string(last + 1) + " or more, or a smaller at" +
          (report.id < 0 ? "" : "; at, from, to and size do not count the id"));
  return 0;
}

void readPlace(const Tree& tree, const Report& report, Field& field) {
  const auto room = static_cast<double>(8 * report.size - field.bits);
  if (tree.has("bit_offset") && isText(field.type))
    tree.at("bit_offset").fail("a text field has no bit_offset; only fields of type i, u or f have one");
  if (field.bits > 8 * report.size)
    return tree.at("type").fail("\"" + tree.at("type").text() + "\" takes " + std::to_string((field.bits + 7) / 8) +
                                " bytes, but " + sizeKey(tree) + " is " + std::to_string(report.size) +
                                "; expected a narrower type, or a larger size");
  const bool at_bit = tree.has("bit_offset");
  double skip = at_bit && !tree.has("at") ? 0 : 8 * readByte(tree.at("at"), report, at_bit ? 8 : field.bits);
  if (at_bit) skip += tree.at("bit_offset").whole(0, std::max(0.0, room - skip));
  field.at = static_cast<uint16_t>(skip / 8);
  field.bit_skip = static_cast<uint8_t>(static_cast<size_t>(skip) % 8);
}

/// Notes a problem if the type of a checksum is wider than its method and does not fit into the report, as u61 for u16;
/// then takes the type of the method, so that the place of the field is judged with it. @return true if it noted this
/// problem
bool fitToMethod(const Tree& tree, const Report& report, Field& field) {
  if (field.role != Role::kChecksum || !tree.has("method") || !tree.has("at") || tree.has("bit_offset")) return false;
  if (static_cast<size_t>(tree.at("at").whole(0, kMaxReportBytes)) + (field.bits + 7U) / 8 <= report.size) return false;
  const std::string method = tree.at("method").text();
  for (const NamedCrc& named : namedCrcs())
    if (method == named.name && field.bits > named.check.bits) {
      tree.at("type").fail("\"" + tree.at("type").text() + "\", expected u" + std::to_string(named.check.bits) +
                           " for " + method);
      field.bits = named.check.bits;
      return true;
    }
  return false;
}

/// Reads where the bits of the field are, and the number that they encode. While the type is unknown, every number is
/// allowed, so that a mistake is noted once. @param typed true if the type is known
void readNumber(const Tree& tree, const Report& report, bool typed, Field& field) {
  readPlace(tree, report, field);
  if (tree.has("endian")) field.big_endian = choiceOf(tree.at("endian"), kOrders);
  std::tie(field.least, field.most) = typed ? rangeOf(field.type, field.bits) : rangeOf(Type::kFloat, 64);
  if (tree.has("bit")) {
    if (field.type == Type::kFloat || field.type == Type::kNibbles)
      tree.at("bit").fail("a field of type " + tree.at("type").text() +
                          " has no single bits; expected a whole-number type");
    const double bits = !typed ? 64 : field.type == Type::kNibble ? 4 : field.bits;
    field.bit = static_cast<int8_t>(tree.at("bit").whole(0, bits - 1));
  }
  if (tree.has("inverted")) field.inverted = tree.at("inverted").boolean();
}

/// Notes a problem if a key in degrees is used together with the key in SI units, or for a torque.
void refuseDegrees(const Tree& tree, const Field& field) {
  for (const auto& [key, plain] : {std::pair{"scale_degrees", "scale"}, std::pair{"offset_degrees", "offset"}}) {
    if (!tree.has(key)) continue;
    if (field.role == Role::kTorque)
      tree.at(key).fail("a torque has no degrees; use " + std::string(plain) + " in N m");
    else if (tree.has(plain))
      tree.at(key).fail("cannot be used together with " + std::string(plain) + "; remove one of the two");
  }
}

/// Notes a problem if the field of a torque cannot hold both signs: a motor that can push only in one direction would
/// pull the hand into a surface.
void requireBothSigns(const Tree& tree, const Field& field) {
  const auto [least, most] = rangeOf(field.type, field.bits);
  const double a = least * field.scale + field.offset, b = most * field.scale + field.offset;
  if (std::min(a, b) < 0 && std::max(a, b) > 0) return;
  char range[64];
  std::snprintf(range, sizeof range, "%g to %g N m", std::min(a, b), std::max(a, b));
  tree.at("type").fail("\"" + tree.at("type").text() + "\" can only express " + range +
                       " with this scale and offset; expected both " +
                       "signs: use a signed type such as i16, or an offset that puts zero in the middle");
}

void readScale(const Tree& tree, Field& field) {
  const double degree = M_PI / 180;
  const size_t before = tree.problems();
  refuseDegrees(tree, field);
  if (tree.has("scale")) field.scale = tree.at("scale").number(-1e9, 1e9);
  if (tree.has("offset")) field.offset = tree.at("offset").number(-1e9, 1e9);
  if (tree.has("scale_degrees")) field.scale = degree * tree.at("scale_degrees").number(-1e9, 1e9);
  if (tree.has("offset_degrees")) field.offset = degree * tree.at("offset_degrees").number(-1e9, 1e9);
  if (!(std::abs(field.scale) > 0) && tree.problems() == before) {
    tree.at(tree.has("scale_degrees") ? "scale_degrees" : "scale")
        .fail("0, expected the value of one raw unit in SI units (rad, m, N m), which is not 0");
    field.scale = 1;
  }
  if (tree.has("limit")) {
    const double limit = tree.at("limit").number(0, field.most);
    field.least = std::max(field.least, -limit), field.most = limit;
  }
  if (tree.has("wraps")) {
    field.wraps = tree.at("wraps").boolean();
    if (field.wraps && (field.type == Type::kFloat || field.role != Role::kPosition))
      tree.at("wraps").fail(
          "only a position with a whole-number type can wrap; remove this key, or correct is or type");
  }
}

void readConstant(const Tree& tree, Field& field) {
  const Tree value = tree.at("value");
  const size_t before = tree.problems();
  field.value = value.number(field.least, field.most);
  if (field.type == Type::kFloat || tree.problems() != before || field.most > std::ldexp(1.0, 64)) return;
  const unsigned digits = field.type == Type::kNibble ? 4 : field.type == Type::kNibbles ? 16 : field.bits;
  constexpr double kExact = 9007199254740992;  // 2^53: a double cannot hold all digits of larger numbers
  if (std::abs(field.value) < kExact && field.value == std::floor(field.value))
    field.code = static_cast<uint64_t>(static_cast<int64_t>(field.value)) & onesOf(digits);
  else
    field.code = value.bits(digits);
}

void readSequence(const Tree& tree, Field& field) {
  if (field.type == Type::kFloat)
    tree.at("type").fail("\"" + tree.at("type").text() + "\", expected a whole-number type such as u16");
  if (tree.has("modulo"))
    field.modulo = static_cast<uint64_t>(tree.at("modulo").whole(2, std::min(field.most + 1, 4294967296.0)));
}

/// Reads the method, which is given by its name or by the numbers of a CRC. @return false if the method is not known
bool readMethod(const Tree& tree, Field& field) {
  Check& check = field.check;
  check.bits = field.bits;
  const Tree method = tree.at("method");
  const size_t before = tree.problems();
  const std::string name = method.text();
  if (name == "sum8" || name == "xor8") check.bits = 8;
  if (name == "sum8" || name == "sum") return true;
  if (name == "xor8" || name == "xor") return check.method = Checksum::kXor, true;
  if (name == "crc") {
    check.method = Checksum::kCrc;
    check.polynomial = tree.at("polynomial").bits(check.bits);
    if (tree.problems() == before && (check.polynomial & 1) == 0)
      tree.at("polynomial")
          .fail(
              "is even, but every polynomial of a CRC ends in + 1; expected it without its highest term, such as "
              "0x1021 for x^16 + x^12 + x^5 + 1");
    return true;
  }
  std::string all = "sum, xor, sum8, xor8, crc";
  for (const NamedCrc& named : namedCrcs()) {
    if (name == named.name) return check = named.check, true;
    all += std::string(", ") + named.name;
  }
  if (method.exists() && tree.problems() == before) {
    const std::string meant = suggestMethod(name);
    method.fail("\"" + name + "\", expected one of " +
                (meant.empty() ? all : "sum, xor, crc and the names of CRCs, such as crc16-modbus" + meant));
  }
  return false;
}

/// Reads the keys that change a sum or a CRC. A CRC that is given by its name allows none of them.
void readMethodDetails(const Tree& tree, Check& check) {
  const bool crc = tree.at("method").text() == "crc", named = check.method == Checksum::kCrc && !crc;
  const auto forbid = [&](const char* key, bool allowed, const char* what) {
    if (tree.has(key) && !allowed)
      tree.at(key).fail("cannot be used with method: " + tree.at("method").text() + ", only with " + what +
                        "; remove it, or correct method");
    return tree.has(key) && allowed;
  };
  (void)forbid("polynomial", crc, "method crc");
  if (forbid("reflected", crc, "method crc")) check.reflected = tree.at("reflected").boolean();
  if (forbid("initial", !named, "sum, xor and crc (a CRC given by its name has this value built in)"))
    check.initial = tree.at("initial").bits(check.bits);
  if (forbid("final_xor", !named, "sum, xor and crc (a CRC given by its name has this value built in)"))
    check.final_xor = tree.at("final_xor").bits(check.bits);
  const bool words = check.method != Checksum::kCrc;
  if (forbid("negated", check.method == Checksum::kSum, "a sum")) check.negated = tree.at("negated").boolean();
  if (forbid("word", words, "sum and xor")) check.word = static_cast<uint8_t>(tree.at("word").whole(1, 8));
}

/// Notes a problem if a checksum covers its own bytes. The likeliest mistake is a `to` that counts the bytes of the
/// checksum too.
void refuseItself(const Tree& tree, const Field& field) {
  const size_t end = field.at + field.bytes();
  if (field.at >= field.to || end <= field.from) return;
  const std::string own = field.bytes() == 1 ? "byte " + std::to_string(field.at)
                                             : "bytes " + std::to_string(field.at) + " to " + std::to_string(end - 1);
  if (field.at > field.from)
    tree.at("to").fail(std::to_string(field.to) + ", so the checksum covers itself (" + own +
                       "); the bytes from `from` to `to` - 1 are covered: expected to: " + std::to_string(field.at) +
                       " or less, or another at");
  else
    tree.at("from").fail(std::to_string(field.from) + ", so the checksum covers itself (" + own +
                         "); expected from: " + std::to_string(end) + " or more, or another at");
}

void readChecksum(const Tree& tree, const Report& report, const FieldFacts& known, Field& field) {
  const bool method = readMethod(tree, field);
  if (method) readMethodDetails(tree, field.check);
  field.check.big_endian = field.big_endian;
  if (tree.has("over_id") && tree.at("over_id").boolean()) {
    if (report.id < 0)
      tree.at("over_id").fail("true, but the report has no id; remove over_id, or give the report an id");
    if (field.check.word > 1) tree.at("over_id").fail("over_id works only with word: 1; remove one of the two");
    field.check = startedWith(field.check, static_cast<uint8_t>(std::max(report.id, 0)));
  }
  const size_t before_range = tree.problems();
  field.from = static_cast<uint16_t>(tree.at("from").whole(0, static_cast<double>(report.size - 1)));
  field.to = static_cast<uint16_t>(tree.at("to").whole(field.from + 1.0, static_cast<double>(report.size)));
  if (known.placed && tree.problems() == before_range) refuseItself(tree, field);
  if (!known.type) return;
  if (field.type != Type::kUnsigned && field.type != Type::kSigned)
    tree.at("type").fail("\"" + tree.at("type").text() +
                         "\", expected a whole-number type for a checksum, such as u8 or u16");
  else if (method && field.bits < field.check.bits)
    tree.at("type").fail("\"" + tree.at("type").text() + "\", expected u" + std::to_string(field.check.bits) + " for " +
                         tree.at("method").text());
}

/// Reads the clock of the arm, whose scale is the length of one raw unit in s.
void readTime(const Tree& tree, Field& field) {
  constexpr const char* kExpected =
      "expected the length of one raw unit in s, such as 1.0e-6 for a clock in microseconds";
  const size_t before = tree.problems();
  if (!tree.has("scale"))
    tree.fail(std::string("lacks the key \"scale\", ") + kExpected);
  else
    field.scale = tree.at("scale").number(0, 10, "s");
  if (tree.problems() == before && !(field.scale > 0)) tree.at("scale").fail(std::string("0 s, ") + kExpected);
  if (!(field.scale > 0)) field.scale = 1;
}

}  // namespace

ReadField readField(const Tree& tree, const Report& report, size_t joints, bool input) {
  ReadField read;
  Field& field = read.field;
  const size_t first = tree.problems();
  if (!tree.only(kKeys) && !tree.has("is")) return read;
  readTarget(tree, joints, input, field, read.known);
  read.known.type = readType(tree.at("type"), field);
  const size_t before = tree.problems();
  const size_t of_type = read.known.type && fitToMethod(tree, report, field) ? 1 : 0;
  readNumber(tree, report, read.known.type, field);
  read.known.placed = read.known.type && tree.problems() == before + of_type;
  if (!read.known.role) return read;  // the role decides which other keys a field needs
  const size_t before_scale = tree.problems();
  if (ofJoint(field.role)) readScale(tree, field);
  const bool scaled = read.known.type && tree.problems() == before_scale;
  if (field.role == Role::kTorque && !input && scaled) requireBothSigns(tree, field);
  if (field.role == Role::kConstant || field.role == Role::kFirmware) readConstant(tree, field);
  if (field.role == Role::kEnable || field.role == Role::kCalibrate || field.role == Role::kFollow)
    field.value = tree.has("value") ? tree.at("value").number(field.least, field.most) : 1;
  if (field.role == Role::kSequence || field.role == Role::kStarts) readSequence(tree, field);
  if (field.role == Role::kTime) readTime(tree, field);
  if (field.role == Role::kChecksum) readChecksum(tree, report, read.known, field);
  read.known.all = tree.problems() == first;
  return read;
}

}  // namespace hapticd::codec
