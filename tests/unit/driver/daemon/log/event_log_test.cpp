// SPDX-License-Identifier: MIT
/// Every kind of event has its words, and names the model or the arm.
#include "session/messages/event_log.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "hapticd/abi.h"
#include "servo/safety/guard.hpp"
#include "session/messages/pusher_log.hpp"

namespace hapticd::servo {
namespace {

class EventWords : public testing::Test {
 protected:
  EventWords() : log_(2, {{"phantom", "my-arm.yaml"}}, arms_) { log_.names().came(1, 0, {"door", "shapes/door.so"}); }
  EventLog::Message of(uint32_t kind, uint32_t code = 0, double value = 0) const {
    hapticd_event event{};
    event.kind = kind;
    event.model = 1;
    event.probe = 0;
    event.code = code;
    event.value = value;
    return log_.messageOf(event);
  }
  Arms arms_;
  EventLog log_;
};

TEST_F(EventWords, AreAtTheLevelThatAPersonNeeds) {
  EXPECT_EQ(of(HAPTICD_CLICK).level, HSP_LOG_DEBUG);
  EXPECT_EQ(of(HAPTICD_CAME).level, HSP_LOG_INFO);
  EXPECT_EQ(of(HAPTICD_DEGRADED, 0, 1).level, HSP_LOG_WARNING);
  EXPECT_EQ(of(HAPTICD_REFUSED, 0, 3).level, HSP_LOG_WARNING);
  EXPECT_EQ(of(HAPTICD_SILENCED, static_cast<uint32_t>(ShapeFault::kOverrun)).level, HSP_LOG_ERROR);
}

TEST_F(EventWords, TellTheDirectionOfAClickIfItIsKnown) {
  EXPECT_EQ(of(HAPTICD_CLICK, HAPTICD_WENT_IN).text, "snapped in at 0.0000 s");
  EXPECT_EQ(of(HAPTICD_CLICK, HAPTICD_CAME_OUT).text, "snapped out at 0.0000 s");
  EXPECT_EQ(of(HAPTICD_CLICK).text, "clicked at 0.0000 s");
}

TEST_F(EventWords, TellHowLongNoTickCame) {
  const auto stalled = of(HAPTICD_STALLED, 0, 1.5);
  EXPECT_EQ(stalled.level, HSP_LOG_WARNING);
  EXPECT_NE(stalled.text.find("no tick for 1.50 s"), std::string::npos) << stalled.text;
  EXPECT_NE(stalled.text.find("SIGSTOP"), std::string::npos) << stalled.text;
  EXPECT_NE(stalled.text.find("hapticd device check my-arm.yaml"), std::string::npos) << stalled.text;
}

TEST_F(EventWords, NameTheModel) {
  for (const uint32_t kind : {HAPTICD_CLICK, HAPTICD_DEGRADED, HAPTICD_RESTORED, HAPTICD_CAME, HAPTICD_LEFT,
                              HAPTICD_JOINED, HAPTICD_LOST, HAPTICD_REFUSED}) {
    EXPECT_EQ(of(kind).who, "door") << kind;
    EXPECT_FALSE(of(kind).text.empty()) << kind;
  }
  const auto silenced = of(HAPTICD_SILENCED, static_cast<uint32_t>(ShapeFault::kNotFinite));
  EXPECT_NE(silenced.text.find("model door: its plugin gave"), std::string::npos) << silenced.text;
}

TEST_F(EventWords, TellTimeAndForceOfAPull) {
  const std::string pulled = of(HAPTICD_SILENCED, static_cast<uint32_t>(ShapeFault::kPulls), 0.42).text;
  EXPECT_NE(pulled.find("into its surface, at 0.000 s with 0.42 N: its force has the wrong sign"), std::string::npos)
      << pulled;
  EXPECT_NE(pulled.find("hapticd plugin check shapes/door.so"), std::string::npos) << pulled;
  const std::string status = of(HAPTICD_SILENCED, static_cast<uint32_t>(ShapeFault::kBadStatus), -77).text;
  EXPECT_NE(status.find("status -77"), std::string::npos) << status;
}

TEST_F(EventWords, SayThatASwitchWasFoundPressed) {
  EXPECT_EQ(log_.messageOfSwitch(0).who, "phantom");
  EXPECT_EQ(log_.messageOfSwitch(0).level, HSP_LOG_WARNING);
  EXPECT_NE(log_.messageOfSwitch(0).text.find("release it"), std::string::npos);
}

TEST_F(EventWords, NameTheProcessThatLeads) {
  EXPECT_EQ(of(HAPTICD_JOINED, 0, 4711).text, "process 4711 leads it");
  EXPECT_EQ(of(HAPTICD_LOST, 0, 4711).text, "process 4711 no longer leads it");
}

TEST_F(EventWords, OfAHoldAndOfItsEndMatch) {
  hapticd_event event{};
  event.kind = HAPTICD_FAULT;
  event.model = -1;
  event.code = static_cast<uint32_t>(Fault::kStopped);
  EXPECT_NE(log_.messageOf(event).text.find("the arm is held"), std::string::npos) << log_.messageOf(event).text;
  log_.note(event);
  EXPECT_EQ(of(HAPTICD_CLEARED).text, "the hold is over; the forces come back");
  event.kind = HAPTICD_CLEARED;
  log_.note(event);
  EXPECT_EQ(of(HAPTICD_CLEARED).text, "the fault is over; the forces come back");
}

/// Texts of one look at the programs on an arm.
std::string update(PusherLog& log, const ClientForces& forces, double now) {
  std::string text;
  for (const auto& message : log.update(0, forces, now)) text += message.text + "\n";
  return text;
}

TEST(PusherWords, TellWhoAskedFallsSilentAndDies) {
  constexpr double kTick = 1e-3;
  ClientForces forces({scene::ClientMode::kAdd, 4, false}, 10, 1, kTick);
  PusherLog log;
  link::PushSlot slot;
  uint64_t now = 1000;
  const auto tick = [&](double force) {
    hapticd_push push{};
    push.tick = now;
    push.force[0] = force;
    slot.put(push);
    forces.collect(now++, kTick);
  };
  EXPECT_EQ(log.begins(0, 0, 4711, "spring").text, "process 4711 (spring) pushes on it");
  forces.begin(0, slot);
  tick(2);
  EXPECT_EQ(update(log, forces, 0), "");
  tick(100);
  EXPECT_NE(update(log, forces, 0).find("(spring) asked for 100 N and gets 4 N at most"), std::string::npos);
  tick(std::numeric_limits<double>::quiet_NaN());
  tick(2e6);
  EXPECT_EQ(update(log, forces, 0),
            "2 answers of process 4711 (spring) were refused so far: a force or torque is beyond 1e6 N or N m\n");
  tick(3);
  for (int i = 0; i < 300; ++i) forces.collect(now++, kTick);
  EXPECT_EQ(update(log, forces, 1),
            "process 4711 (spring) fell silent while it pushed with 3 N: its force ramped out\n");
  EXPECT_EQ(update(log, forces, 2), "");
  tick(3);
  EXPECT_NE(update(log, forces, 3).find("answers again, after about 0.3 s"), std::string::npos);
  EXPECT_EQ(log.ends(0, 0, PusherLog::End::kLeft, forces.clients()[0]).text,
            "process 4711 (spring) ended while it pushed with 3 N: its force ramped out");
  EXPECT_EQ(update(log, forces, 4), "");
}

TEST_F(EventWords, KeepTheNameOfAModelWhosePlaceIsTakenAgain) {
  log_.names().came(1, 500, {"drawer", "shapes/drawer.so"});
  const auto who = [&](uint32_t kind, uint64_t tick) {
    hapticd_event event{};
    event.kind = kind;
    event.model = 1;
    event.tick = tick;
    return log_.messageOf(event).who;
  };
  EXPECT_EQ(who(HAPTICD_TOUCH, 499), "door");
  EXPECT_EQ(who(HAPTICD_LEFT, 500), "door") << "the tick of its release is over only now";
  EXPECT_EQ(who(HAPTICD_CAME, 500), "drawer");
  EXPECT_EQ(who(HAPTICD_LEFT, 700), "drawer");
  for (uint64_t i = 1; i <= 2 * PlaceNames::kMostKept; ++i) log_.names().came(1, 1000 * i, {"leaf", ""});
  EXPECT_EQ(who(HAPTICD_TOUCH, 499), "leaf") << "as many names are kept as kMostKept says";
}

TEST_F(EventWords, OfAFaultStandWhereTheArmIsNotThere) {
  const auto message = of(HAPTICD_FAULT, static_cast<uint32_t>(Fault::kLate), 0.15);
  EXPECT_EQ(message.level, HSP_LOG_ERROR);
  EXPECT_NE(message.text.find("fault: device phantom: too many ticks"), std::string::npos) << message.text;
}

TEST_F(EventWords, OfAKindThatIsNotKnownAreNone) {
  EXPECT_TRUE(of(HAPTICD_EVENT_KINDS).text.empty());
}

}  // namespace
}  // namespace hapticd::servo
