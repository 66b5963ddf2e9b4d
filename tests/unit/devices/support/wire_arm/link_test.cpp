// SPDX-License-Identifier: MIT
/// The I/O thread over a transport that a test plays: nothing here asserts times.
#include "wire_arm/link.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>

#include "emulators/board.hpp"
#include "emulators/wire_file.hpp"
#include "wire_arm/calibration.hpp"

namespace hapticd::wire_arm {
namespace {

/// A board that streams, at 1 kHz of the real clock unless a test says otherwise.
struct FakeBoard {
  std::atomic<bool> plugged{true}, pushed{false}, stalled{false}, silent{false}, floods{false};
  bool shares_memory = false;  ///< it reads its command just before it writes its report
  std::atomic<int> torn{0};    ///< commands that came when it reads
  std::atomic<Nanoseconds> reported_at{0};
  std::atomic<int> opened{0}, reports{0}, commands{0};
  std::string asked_for;  ///< serial number that it was opened by last
  int kept = 0;           ///< reports from before anybody read
  emulator::BoardState state;
  Nanoseconds next = 0, period = 1'000'000;
  std::atomic<int> prompt{0}, late{0};  ///< answers to the newest report, and to the one before: its sign tells
};

class FakeTransport final : public Transport {
 public:
  explicit FakeTransport(FakeBoard& board) : board_(board) {}
  Result<Identity> open(const Address& address, const codec::Wire&) override {
    if (!board_.plugged) return Error{"not found"};
    board_.asked_for = address.serial;
    ++board_.opened;
    return Identity{"7", "fake board", "1.0", "plug " + std::to_string(board_.opened)};
  }
  void close() noexcept override {}
  Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept override {
    size = 0;
    if (!board_.plugged) return Status::kGone;
    if (board_.stalled) return Status::kStalled;
    RealClock clock(0);
    const Nanoseconds now = clock.now();
    if (board_.floods) board_.next = now;
    if (board_.shares_memory) wait = std::min(wait, board_.period / 10);  // it is polled
    if (board_.silent || board_.next > now + wait) return clock.waitUntil(now + wait), Status::kNothing;
    if (!board_.floods) clock.waitUntil(board_.next);
    ++board_.reports;
    board_.reported_at = monotonicNow();
    board_.next = std::max(board_.next, now - 5 * board_.period) + board_.period;
    ++board_.state.sequence;
    emulator::BoardState state = board_.state;
    if (board_.kept > 0) --board_.kept, state.counts = {};
    const auto bytes = state.bytes();
    std::copy(bytes.begin(), bytes.end(), to.begin());
    size = bytes.size();
    return Status::kOk;
  }
  Status send(std::span<const uint8_t> bytes) noexcept override {
    const emulator::BoardCommand command(bytes);
    board_.pushed = command.pushes();
    ++board_.commands;
    if (monotonicNow() > board_.next - board_.period / 4) ++board_.torn;
    if (command.pushes())
      ++((command.current[0] > 0) == (board_.state.sequence % 2 == 0) ? board_.prompt : board_.late);
    return !board_.plugged ? Status::kGone : command.valid ? Status::kOk : Status::kFailed;
  }
  Status control(const codec::StartStep&) noexcept override { return Status::kOk; }
  bool sharesMemory() const noexcept override { return board_.shares_memory; }

 private:
  FakeBoard& board_;
};

class LinkTest : public ::testing::Test {
 protected:
  LinkSettings settings(Calibration calibration) {
    LinkSettings s;
    s.session.calibration = calibration;
    s.session.health.least_rate = 0;  // a busy machine may well be slow
    s.log = [this](int, const std::string& text) {
      const std::lock_guard lock(mutex);
      said += text + "\n";
    };
    s.zero = [this](const Identity& identity) { return loadZero(folder, Address{}, identity, 3); };
    return s;
  }
  std::unique_ptr<Link> make(Calibration calibration = Calibration::kDevice) {
    return std::make_unique<Link>(std::make_unique<FakeTransport>(board), wire, settings(calibration));
  }
  /// Pushes until `done` or five seconds.
  bool pushUntil(Link& link, const std::function<bool(const Sample&)>& done) {
    RealClock clock(0);
    Sample sample;
    for (int i = 0; i < 5000; ++i) {
      link.read(sample);
      wanted.time = clock.now(), ++wanted.sequence, wanted.on = true, wanted.torque = {0.5, 0, 0};
      link.write(wanted);
      if (done(sample)) return true;
      clock.waitUntil(clock.now() + 1'000'000);
    }
    return false;
  }
  std::string words() {
    const std::lock_guard lock(mutex);
    return said;
  }

  FakeBoard board;
  codec::Wire wire = codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/premium15.yaml"), 3);
  std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "hapticd-link-test";
  std::mutex mutex;
  std::string said;
  ArmCommand wanted;
};

TEST_F(LinkTest, ReportsThatWaitedWhileTheArmMovedAreNoJump) {
  board.kept = 4;
  board.state.counts = {20000, 20000, 20000};
  auto link = make();
  ASSERT_TRUE(link->open());
  ASSERT_TRUE(link->start());
  Sample sample;
  ASSERT_TRUE(pushUntil(*link, [&](const Sample& s) { return sample = s, s.sequence > 20; }));
  EXPECT_EQ(sample.trouble, Trouble::kNone) << describe(sample.trouble);
}

TEST_F(LinkTest, PushesLosesFindsAndPushesAgain) {
  auto link = make();
  ASSERT_TRUE(link->open());
  const auto started = link->start();
  ASSERT_TRUE(started) << started.error();
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return board.pushed.load(); }));
  board.plugged = false;
  ASSERT_TRUE(pushUntil(*link, [](const Sample& s) { return s.trouble == Trouble::kUnplugged; }));
  EXPECT_NE(words().find("unplugged"), std::string::npos);
  board.pushed = false;
  board.plugged = true;
  ASSERT_TRUE(pushUntil(*link, [&](const Sample& s) { return s.trouble == Trouble::kNone && board.pushed; }));
  EXPECT_EQ(board.opened, 2);
  EXPECT_EQ(board.asked_for, "7") << "another arm of this kind would do as well";
  link->stop();
  EXPECT_FALSE(board.pushed) << "motors are off when the thread ends";
}

/// Slow enough that a busy machine is not.
class PacedLinkTest : public LinkTest {
 protected:
  static constexpr Nanoseconds kPeriod = 20'000'000;
  std::unique_ptr<Link> startSlow() {
    board.period = kPeriod;
    wire.rate = 50;
    LinkSettings s = settings(Calibration::kDevice);
    s.session.health.stale = 1, s.session.health.host_silent = 1, s.session.health.ramp = 0;
    auto link = std::make_unique<Link>(std::make_unique<FakeTransport>(board), wire, std::move(s));
    EXPECT_TRUE(link->open() && link->start());
    return link;
  }
};

TEST_F(PacedLinkTest, EachReportEndsTheWaitAndItsAnswerGoesOutBeforeTheNext) {
  auto link = startSlow();
  Sample sample;
  link->read(sample);
  const bool even = (sample.sequence - board.state.sequence) % 2 == 0;
  int fresh = 0;
  constexpr int kRounds = 50;
  for (int i = 0; i < kRounds; ++i) {
    const uint64_t before = sample.sequence;
    link->waitForNews(monotonicNow() + 10 * kPeriod);
    link->read(sample);
    fresh += sample.sequence != before;
    wanted.time = monotonicNow(), ++wanted.sequence, wanted.on = true;
    wanted.torque = {(sample.sequence % 2 == 0) == even ? 0.5 : -0.5, 0, 0};
    link->write(wanted);
  }
  link->waitForNews(monotonicNow() + kPeriod);  // lets the last one out
  // A machine that stands still for ten milliseconds is forgiven; without the wait all of them are late.
  EXPECT_GT(fresh, kRounds / 2);
  EXPECT_GT(board.prompt, 2 * board.late) << board.late << " answers went out a report late";
  EXPECT_GT(board.prompt, kRounds / 2);
}

TEST_F(PacedLinkTest, ABoardThatSharesMemoryReadsNoHalfWrittenCommands) {
  board.shares_memory = true;
  auto link = startSlow();
  RealClock clock(0);
  constexpr int kRounds = 50;
  for (int i = 0; i < kRounds; ++i) {
    clock.waitUntil(board.reported_at + kPeriod - kPeriod / 8);  // just when it reads
    wanted.time = monotonicNow(), ++wanted.sequence, wanted.on = true, wanted.torque = {0.5, 0, 0};
    link->write(wanted);
    const int reports = board.reports;
    for (int k = 0; k < 100 && board.reports == reports; ++k) clock.waitUntil(clock.now() + kPeriod / 50);
  }
  EXPECT_GT(board.commands, kRounds / 2);
  EXPECT_LT(board.torn, kRounds / 3);  // on a machine that stands still for some milliseconds, now and then
}

TEST_F(PacedLinkTest, ACutEndsThePushOfAServoThatIsStuckAndHoldsUntilItIsEnded) {
  auto link = startSlow();
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return board.pushed.load(); }));
  link->cut();  // nobody writes any more, and the last command is good for a second
  RealClock clock(0);
  for (int i = 0; i < 500 && board.pushed; ++i) clock.waitUntil(clock.now() + 1'000'000);
  EXPECT_FALSE(board.pushed);
  int rounds = 0;
  EXPECT_FALSE(pushUntil(*link, [&](const Sample&) { return board.pushed || ++rounds > 200; }) && board.pushed);
  link->endCut();
  EXPECT_TRUE(pushUntil(*link, [&](const Sample&) { return board.pushed.load(); }));
}

TEST_F(PacedLinkTest, ATroubleEndsTheWaitAndSilenceItsBound) {
  auto link = startSlow();
  Sample sample;
  link->read(sample);
  board.plugged = false;
  for (int i = 0; i < 100 && sample.trouble != Trouble::kUnplugged; ++i) {
    link->waitForNews(monotonicNow() + 100 * kPeriod);
    link->read(sample);
  }
  EXPECT_EQ(sample.trouble, Trouble::kUnplugged);
  const Nanoseconds until = monotonicNow() + kPeriod;
  link->waitForNews(until);
  EXPECT_GE(monotonicNow(), until);
}

TEST_F(LinkTest, AStalledEndpointIsNamedAndReopened) {
  auto link = make();
  ASSERT_TRUE(link->open());
  ASSERT_TRUE(link->start());
  board.stalled = true;
  ASSERT_TRUE(pushUntil(*link, [](const Sample& s) { return s.trouble == Trouble::kStalled; }));
  const Nanoseconds begun = monotonicNow();
  const int opened = board.opened;
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return board.opened > opened + 3; }));
  EXPECT_GT(monotonicNow() - begun, 200'000'000u) << "opened again and again without a pause";
  EXPECT_EQ(words().find("is back"), std::string::npos) << "it is there, but not well";
  board.stalled = false;
  ASSERT_TRUE(pushUntil(*link, [](const Sample& s) { return s.trouble == Trouble::kNone; }));
}

TEST_F(LinkTest, APoseCalibrationHoldsUntilTheArmIsPluggedInAnew) {
  std::filesystem::remove_all(folder);
  {
    auto link = make(Calibration::kPose);
    ASSERT_TRUE(link->open());
    board.state.counts = {100, 200, 300};
    ASSERT_TRUE(link->start());
    ASSERT_TRUE(pushUntil(*link, [](const Sample& s) { return s.sequence > 5; }));
    EXPECT_FALSE(board.pushed);
    const auto offset = link->calibrateAt({0.1, 0.2, 0.3});
    ASSERT_TRUE(offset) << offset.error();
    ASSERT_TRUE(storeZero(folder, Address{}, link->identity(), *offset, 3));
    Sample last;
    ASSERT_TRUE(pushUntil(*link, [&](const Sample& s) { return last = s, s.calibrated && board.pushed; }));
    EXPECT_NEAR(last.position[1], 0.2, 1e-12);
    EXPECT_TRUE(loadZero(folder, Address{}, link->identity(), 3).known);
  }
  auto link = make(Calibration::kPose);
  ASSERT_TRUE(link->open());  // opened a second time: the fake says that it was plugged in anew
  EXPECT_FALSE(loadZero(folder, Address{}, link->identity(), 3).known);
}

TEST_F(LinkTest, TwoArmsHaveTwoCalibrations) {
  std::filesystem::remove_all(folder);
  Address one, other;
  const Address none;
  one.port = "11-2", other.port = "1-2";
  Identity a, a1, like_port;
  const Identity nameless;
  a.serial = "A", a1.serial = "A1", like_port.serial = "1-2";
  ASSERT_TRUE(storeZero(folder, one, a, {1}, 1));
  ASSERT_TRUE(storeZero(folder, other, a1, {2}, 1));
  ASSERT_TRUE(storeZero(folder, none, like_port, {3}, 1));
  ASSERT_TRUE(storeZero(folder, other, nameless, {4}, 1));
  EXPECT_EQ(loadZero(folder, one, a, 1).offset[0], 1);
  EXPECT_EQ(loadZero(folder, other, a1, 1).offset[0], 2);
  EXPECT_EQ(loadZero(folder, none, like_port, 1).offset[0], 3);
  EXPECT_EQ(loadZero(folder, other, nameless, 1).offset[0], 4);
}

TEST_F(LinkTest, AnArmThatFellSilentIsNotCalibratedByItsLastReport) {
  auto link = make(Calibration::kPose);
  ASSERT_TRUE(link->open());
  ASSERT_TRUE(link->start());
  board.silent = true;
  ASSERT_TRUE(pushUntil(*link, [](const Sample& s) { return s.trouble == Trouble::kStale; }));
  const auto offset = link->calibrateAt({0.1, 0.2, 0.3});
  ASSERT_FALSE(offset);
  EXPECT_NE(offset.error().find("no new reports"), std::string::npos) << offset.error();
}

TEST_F(LinkTest, ADeviceThatSendsWithoutEndLeavesTimeForTheServo) {
  auto link = make();
  ASSERT_TRUE(link->open());
  ASSERT_TRUE(link->start());
  board.floods = true;
  board.reports = board.commands = 0;
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return board.commands > 100; }));
  EXPECT_LT(board.reports, 160 * board.commands) << "its thread never sleeps";
}

TEST_F(LinkTest, ADeviceThatSendsNothingDoesNotStart) {
  board.next = monotonicNow() + 100'000'000'000;
  auto link = make();
  ASSERT_TRUE(link->open());
  const auto started = link->start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().find("no new reports"), std::string::npos) << started.error();
}

}  // namespace
}  // namespace hapticd::wire_arm
