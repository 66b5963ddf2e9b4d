// SPDX-License-Identifier: MIT
/// Any format, any values: what is encoded is decoded. Formats are made at random as a device file would give them.
#include <gtest/gtest.h>

#include <vector>

#include "codec/report.hpp"
#include "support/random_wire.hpp"

namespace hapticd::codec {
namespace {

TEST(AnyFormat, EncodeAndDecodeAgree) {
  for (uint64_t seed = 1; seed <= 3000; ++seed) {
    RandomWire format(seed);
    Wire wire;
    ASSERT_NO_THROW(wire = format.wire()) << seed << ": " << format.text();
    for (int i = 0; i < 20; ++i) {
      Order order;
      order.enable = true;
      order.sequence = static_cast<uint32_t>(format.random()());
      for (const Field& field : wire.output.fields)
        if (field.role == Role::kTorque) order.torque[field.index] = format.valueFor(field);
      std::vector<uint8_t> bytes(wire.output.bytes());
      ASSERT_EQ(encode(wire.output, order, bytes), bytes.size());
      State state;
      ASSERT_EQ(decode(wire.input, bytes, state), Verdict::kGood) << seed << ": " << format.text();
      for (size_t joint = 0; joint < format.joints(); ++joint)
        ASSERT_EQ(state.position[joint], order.torque[joint])
            << "joint " << joint + 1 << ", " << seed << ": " << format.text();
    }
  }
}

/// One bit that is another is found wherever a checksum of full width covers it.
TEST(AnyFormat, AChecksumFindsAFlippedBit) {
  size_t tried = 0;
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    RandomWire format(seed);
    const Wire wire = format.wire();
    const Field& last = wire.input.fields.back();
    if (last.role != Role::kChecksum || last.check.method != Checksum::kCrc || last.check.bits < 8) continue;
    std::vector<uint8_t> bytes(wire.output.bytes());
    (void)encode(wire.output, Order{}, bytes);
    for (size_t bit = 0; bit < 8u * last.to; ++bit) {
      bytes[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
      State state;
      EXPECT_NE(decode(wire.input, bytes, state), Verdict::kGood) << seed << " bit " << bit << ": " << format.text();
      bytes[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
      ++tried;
    }
  }
  EXPECT_GT(tried, 1000u);
}

}  // namespace
}  // namespace hapticd::codec
