// SPDX-License-Identifier: MIT
/// Messages for the daemon's log about programs that push on an arm: which process pushes, when it begins, ends or
/// falls silent, and why its force is less than it asks for.
#pragma once
#include <sys/types.h>

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "servo/arm/client_forces.hpp"

namespace hapticd::servo {

class PusherLog {
 public:
  /// [s] a silence longer than this is reported in the log; a shorter one is only counted
  static constexpr double kSilent = 0.2;
  /// [s] least time between two reports about refused answers of a program
  static constexpr double kRefusedPeriod = 1.0;

  /// A message for the log. @param level HSP_LOG_INFO, ...
  struct Message {
    int32_t level;
    std::string text;
  };
  /// How a program stops pushing: by a request, or because its connection ended.
  enum class End { kUnlead, kLeft };

  /// [any] Called when a program begins to push. @param place less than ClientForces::kMost
  Message begins(uint32_t arm, uint32_t place, pid_t pid, const std::string& program);
  /// [any] Called when a program stops pushing. @param client the counts of the program
  Message ends(uint32_t arm, uint32_t place, End how, const ClientForces::Client& client);
  /// [any] Returns messages about changes since the last call, of the programs on an arm. @param now [s]
  std::vector<Message> update(uint32_t arm, const ClientForces& forces, double now);

 private:
  /// What was already reported about a program.
  struct Reported {
    pid_t pid = 0;  ///< 0 if the place is empty
    std::string program;
    bool silent = false, bounded = false;
    double quiet = 0;  ///< [s] ClientForces::Client::quiet at the last call
    uint64_t refused = 0;
    double refused_at = -kRefusedPeriod;
  };
  static std::string who(const Reported& told);
  Reported& at(uint32_t arm, uint32_t place);
  static void checkSilence(Reported& told, const ClientForces::Client& client, std::vector<Message>& messages);
  static void checkRefusals(Reported& told, const ClientForces::Client& client, double now,
                            std::vector<Message>& messages);
  static void checkBound(Reported& told, const ClientForces::Client& client, double bound,
                         std::vector<Message>& messages);

  std::mutex mutex_;  // because the request worker adds and removes programs
  std::vector<std::array<Reported, ClientForces::kMost>> told_;
};

/// [any] Returns why an answer was refused, such as "a number is not finite".
const char* describe(ClientForces::Refusal why);

}  // namespace hapticd::servo
