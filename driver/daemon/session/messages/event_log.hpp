// SPDX-License-Identifier: MIT
/// Writes the events of the servo into the daemon's log when they happen: faults, silenced and degraded models, models
/// and leaders that come and go.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hapticd/client.h"
#include "servo/arm/arm.hpp"
#include "session/messages/place_names.hpp"
#include "session/messages/pusher_log.hpp"
#include "session/telemetry/flight.hpp"

namespace hapticd::servo {

class EventLog {
 public:
  using Named = PlaceNames::Named;

  /// [main] @param places most models that the run can have @param devices the arms, in order
  EventLog(size_t places, std::vector<Named> devices, const Arms& arms)
      : models_(places), devices_(std::move(devices)), arms_(arms) {}

  /// [any] The models that have had the places of the run.
  PlaceNames& names() { return models_; }
  const PlaceNames& names() const { return models_; }

  /// [main] Writes the events since the last call.
  void logNewEvents(const Flight& flight);

  /// [any] Notes the name of a process that is about to lead, because the process may be gone when its event is
  /// reported.
  void leads(pid_t pid, const std::string& program);

  /// [any] Called when a program begins to push on an arm, and when it has stopped.
  void pushes(uint32_t arm, uint32_t place, pid_t pid, const std::string& program);
  void pushesNoMore(uint32_t arm, uint32_t place, PusherLog::End how);

  /// A message for the log. Its text is empty if nothing is to be reported.
  struct Message {
    int32_t level;  ///< HSP_LOG_DEBUG, ...
    std::string who, text;
  };
  /// [main] Returns the message for an event.
  Message messageOf(const hapticd_event& event) const;
  /// [main] Notes whether an arm is held, because the messages of later events depend on it.
  void note(const hapticd_event& event);
  /// [main] Returns the message for an arm whose enable switch is down since the start.
  Message messageOfSwitch(size_t arm) const;

 private:
  void logSwitches();
  void logPushers();
  void write(uint32_t arm, const PusherLog::Message& message) const;
  std::string leaderOf(const hapticd_event& event) const;
  Named device(const hapticd_event& event) const;
  Message messageOfModel(const hapticd_event& event) const;
  Message messageOfArm(const hapticd_event& event) const;
  Message messageOfLeader(const hapticd_event& event) const;

  mutable std::mutex mutex_;  // because the request worker notes programs
  PlaceNames models_;
  std::vector<Named> devices_;
  const Arms& arms_;
  std::vector<bool> told_of_switch_, held_;
  PusherLog pushers_;
  std::map<pid_t, std::string> programs_;  ///< names of the programs that lead; at most kMostPrograms
  uint64_t next_ = 0;
};

}  // namespace hapticd::servo
