// SPDX-License-Identifier: MIT
/// Random wire formats, for property tests and the fuzzer.
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "codec/bits.hpp"
#include "codec/report.hpp"
#include "codec/wire.hpp"

namespace hapticd::codec {

/// A random wire format, as a device file would give it. The output report has the same fields as the input report, so
/// a report that was written can be read again.
class RandomWire {
 public:
  explicit RandomWire(uint64_t seed) : random_(seed) {
    joints_ = 1 + pick(6);
    for (size_t joint = 1; joint <= joints_; ++joint) addNumber(joint);
    for (size_t i = pick(3); i-- > 0;) addConstant();
    if (pick(2) == 0) addCounter();
    skip(pick(12));
    const size_t body = (at_ + 7) / 8;
    at_ = 8 * body;
    if (pick(4) != 0) addChecksum(body);
    size_ = (at_ + 7) / 8;
  }

  Wire wire() const {
    Json in = fields_, out = fields_;
    for (Json& field : in)
      if (field["is"] == "torque") field["is"] = "position";
    const Json all{
        {"rate", 1000}, {"input", {{"size", size_}, {"fields", in}}}, {"output", {{"size", size_}, {"fields", out}}}};
    text_ = all.dump();
    return readWire(text_, joints_);
  }

  /// Returns a random value that the field of a joint can hold exactly.
  double valueFor(const Field& field) {
    double raw = 0;
    if (field.type == Type::kFloat) {
      raw = std::ldexp(static_cast<double>(random_() % (1u << 24)) - (1 << 23), static_cast<int>(pick(40)) - 20);
      if (field.bits == 64)
        raw = std::ldexp(static_cast<double>(static_cast<int64_t>(random_())), static_cast<int>(pick(80)) - 60);
    } else {
      raw =
          std::floor(field.least + std::ldexp(static_cast<double>(random_() >> 11), -53) * (field.most - field.least));
      if (pick(8) == 0) raw = pick(2) == 0 ? field.least : field.most;
    }
    return raw * field.scale + field.offset;
  }

  size_t joints() const { return joints_; }
  const std::string& text() const { return text_; }
  std::mt19937_64& random() { return random_; }

 private:
  using Json = nlohmann::ordered_json;
  size_t pick(size_t count) { return random_() % count; }
  void skip(size_t bits) { at_ += bits; }

  /// Returns the place of the next field, given by its first bit, or by its byte if it begins one. In big-endian fields
  /// bits are counted from the highest bit of a byte.
  Json place(size_t bits, const char* order) {
    // two fields with different byte orders never share a byte
    if (at_ % 8 != 0 && order != last_order_) at_ = (at_ + 7) / 8 * 8;
    last_order_ = order;
    Json field{{"endian", order}};
    if (at_ % 8 == 0 || pick(2) == 0) {
      field["at"] = at_ / 8;
      if (at_ % 8 != 0) field["bit_offset"] = at_ % 8;
    } else {
      field["bit_offset"] = at_;
    }
    at_ += bits;
    return field;
  }

  const char* order() { return pick(2) == 0 ? "little" : "big"; }

  void addNumber(size_t joint) {
    skip(pick(4) == 0 ? pick(9) : 0);
    const size_t kind = pick(5), bits = kind == 0 ? 32 : kind == 1 ? 64 : 2 + pick(63);
    const std::string type = (kind < 2 ? "f" : kind < 4 || bits > 24 ? "i" : "u") + std::to_string(bits);
    Json field = place(bits, order());
    const double scale = pick(2) == 0 ? 1.0 : 0.25;
    field.update({{"is", "torque"}, {"joint", joint}, {"type", type}, {"scale", scale}});
    // The offset gives an unsigned field both signs. With more than 24 bits the sum would be rounded.
    if (type[0] == 'u' && bits <= 24) field["offset"] = -std::ldexp(scale, static_cast<int>(bits) - 1);
    fields_.push_back(field);
  }

  void addConstant() {
    const size_t bits = 2 + pick(63);
    const uint64_t value = random_() & onesOf(static_cast<unsigned>(bits));
    Json field = place(bits, order());
    field.update({{"is", "constant"}, {"type", "u" + std::to_string(bits)}, {"value", value}});
    fields_.push_back(field);
  }

  void addCounter() {
    const size_t bits = 2 + pick(31);
    Json field = place(bits, order());
    field.update({{"is", "counter"}, {"type", "u" + std::to_string(bits)}});
    if (pick(2) == 0) field["modulo"] = 2 + pick(2);
    fields_.push_back(field);
  }

  void addChecksum(size_t body) {
    static const char* const kMethods[] = {"sum", "xor", "sum8", "xor8", "crc"};
    const size_t named = namedCrcs().size(), which = pick(named + 5);
    size_t bits = 8 + pick(57);
    if (which < named) bits = namedCrcs()[which].check.bits + pick(65 - namedCrcs()[which].check.bits);
    const std::string method = which < named ? namedCrcs()[which].name : kMethods[which - named];
    Json field = place(bits, order());
    field.update(
        {{"is", "checksum"}, {"type", "u" + std::to_string(bits)}, {"method", method}, {"from", 0}, {"to", body}});
    if (method == "crc")
      field.update({{"polynomial", random_() >> (64 - bits) | 1},
                    {"initial", random_() >> (64 - bits)},
                    {"reflected", pick(2) == 0}});
    if (method == "sum" && pick(2) == 0) field.update({{"negated", true}, {"word", 1 + pick(8)}});
    if (method == "xor") field.update({{"word", 1 + pick(8)}, {"final_xor", random_() >> (64 - bits)}});
    fields_.push_back(field);
  }

  std::mt19937_64 random_;
  Json fields_ = Json::array();
  const char* last_order_ = "";
  size_t at_ = 0, joints_ = 0, size_ = 0;
  mutable std::string text_;
};

}  // namespace hapticd::codec
