// SPDX-License-Identifier: MIT
/// The mailbox's own duties over a plain file: places that cannot be, half blocks, silence of the bus.
#include "rig.hpp"

namespace hapticd::vme {
namespace {

using emulator::VmeBlock;
using wire_arm::Status;

class MailboxTest : public ::testing::Test {
 protected:
  MailboxTest() : file("mailbox") {
    place.window.node = file.path();
    place.window.address = 0x100000;
  }
  /// A block with a right checksum and these two numbers.
  static VmeBlock block(uint16_t first, uint16_t last) {
    VmeBlock b{};
    b[0] = static_cast<uint8_t>(first >> 8), b[1] = static_cast<uint8_t>(first);
    b[78] = static_cast<uint8_t>(last >> 8), b[79] = static_cast<uint8_t>(last);
    return b;
  }
  Status receive(Mailbox& mailbox) { return mailbox.receive(bytes, size, 0); }
  std::string refusal(const MailboxPlace& p) {
    auto fits = check(p, wire);
    return fits ? "" : fits.error();
  }

  WindowFile file;
  MailboxPlace place;
  codec::Wire wire = codec::readWire(emulator::wireOf(kSarcos), 10);
  std::array<uint8_t, 1024> bytes{};
  size_t size = 0;
};

TEST_F(MailboxTest, EachBlockComesOnce) {
  Mailbox mailbox(place);
  file.write(0, block(7, 7));
  ASSERT_TRUE(mailbox.open({}, wire));
  EXPECT_EQ(receive(mailbox), Status::kNothing) << "what stood there may be years old";
  file.write(0, block(8, 8));
  EXPECT_EQ(receive(mailbox), Status::kOk);
  EXPECT_EQ(size, 80u);
  EXPECT_EQ(bytes[1], 8);
  EXPECT_EQ(receive(mailbox), Status::kNothing);
}

TEST_F(MailboxTest, NothingIsWrittenToMemoryWhereNoBoardCounts) {
  Mailbox mailbox(place);
  file.write(0, block(7, 7));
  ASSERT_TRUE(mailbox.open({}, wire));
  const std::array<uint8_t, 4> order{1, 2, 3, 4};
  EXPECT_EQ(receive(mailbox), Status::kNothing);
  EXPECT_EQ(mailbox.send(order), Status::kOk);
  EXPECT_EQ(file.read(0x100), VmeBlock{}) << "a wrong address may be somebody else's";
  file.write(0, block(8, 8));
  ASSERT_EQ(receive(mailbox), Status::kOk);
  EXPECT_EQ(mailbox.send(order), Status::kOk);
  EXPECT_EQ(file.read(0x100)[3], 4);
}

TEST_F(MailboxTest, ABlockThatIsBeingWrittenIsNotTakenForWhole) {
  Mailbox mailbox(place);
  file.write(0, block(7, 7));
  ASSERT_TRUE(mailbox.open({}, wire));
  file.write(0, block(8, 7));
  EXPECT_EQ(receive(mailbox), Status::kNothing) << "the last number stands yet";
  file.write(0, block(8, 9));  // a write that was overtaken
  ASSERT_EQ(receive(mailbox), Status::kOk);
  codec::State state;
  EXPECT_NE(codec::decode(wire.input, {bytes.data(), size}, state), codec::Verdict::kGood);
  file.write(0, block(9, 9));
  EXPECT_EQ(receive(mailbox), Status::kOk);
  EXPECT_EQ(bytes[1], 9);
}

TEST_F(MailboxTest, NumbersOfAllOnesAreNotSilence) {
  Mailbox mailbox(place);
  file.write(0, block(0xfffe, 0xfffe));
  ASSERT_TRUE(mailbox.open({}, wire));
  file.write(0, block(0xffff, 0xffff));
  EXPECT_EQ(receive(mailbox), Status::kOk);
  EXPECT_EQ(receive(mailbox), Status::kNothing);
  file.write(0, block(0, 0));
  EXPECT_EQ(receive(mailbox), Status::kOk);
}

TEST_F(MailboxTest, ABusOfAllOnesIsNobody) {
  Mailbox mailbox(place);
  VmeBlock ones;
  ones.fill(0xff);
  file.write(0, ones);
  const auto nobody = mailbox.open({}, wire);
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().find("no board answers"), std::string::npos) << nobody.error();
  file.write(0, block(1, 1));
  ASSERT_TRUE(mailbox.open({}, wire));
  file.write(0, ones);
  EXPECT_EQ(receive(mailbox), Status::kAbsent);
}

TEST_F(MailboxTest, AWindowOfAnotherProgramIsLeftAlone) {
  Mailbox first(place), second(place);
  ASSERT_TRUE(first.open({}, wire));
  const auto refused = second.open({}, wire);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("in use"), std::string::npos) << refused.error();
}

TEST_F(MailboxTest, PlacesThatCannotBeAreNamed) {
  EXPECT_EQ(refusal(place), "");
  MailboxPlace p = place;
  p.window.address = 0x100001;
  EXPECT_NE(refusal(p).find("multiple of 64 KiB"), std::string::npos) << refusal(p);
  p = place, p.window.size = 0x1000;
  EXPECT_NE(refusal(p).find("vme.size"), std::string::npos) << refusal(p);
  p = place, p.window.address = 0xff0000, p.window.size = 0x20000;
  EXPECT_NE(refusal(p).find("beyond A24"), std::string::npos) << refusal(p);
  p = place, p.window.space = 1, p.window.address = 0;
  EXPECT_EQ(refusal(p), "") << "A16 is one window of 64 KiB";
  p = place, p.window.space = 4, p.window.address = 0xffff0000;
  EXPECT_EQ(refusal(p), "");
  p = place, p.command = 0xfff0;
  EXPECT_NE(refusal(p).find("beyond the window"), std::string::npos) << refusal(p);
  p = place, p.command = 0x40;
  EXPECT_NE(refusal(p).find("overlaps the state block"), std::string::npos) << refusal(p);
  p = place, p.command = 0x101;
  EXPECT_NE(refusal(p).find("multiple of 2"), std::string::npos) << refusal(p);
}

}  // namespace
}  // namespace hapticd::vme
