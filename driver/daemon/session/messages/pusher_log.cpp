// SPDX-License-Identifier: MIT
#include "session/messages/pusher_log.hpp"

#include <fmt/format.h>

#include "hapticd/abi.h"

namespace hapticd::servo {

namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

}  // namespace

const char* describe(ClientForces::Refusal why) {
  switch (why) {
    case ClientForces::Refusal::kNone:
      return "";
    case ClientForces::Refusal::kNotFinite:
      return "a number is not finite";
    case ClientForces::Refusal::kTooLarge:
      return "a force or torque is beyond 1e6 N or N m";
    case ClientForces::Refusal::kAhead:
      return "it answers a tick that has not begun";
  }
  return "";
}

PusherLog::Reported& PusherLog::at(uint32_t arm, uint32_t place) {
  if (arm >= told_.size()) told_.resize(arm + 1);
  return told_[arm][place % ClientForces::kMost];
}

std::string PusherLog::who(const Reported& told) {
  return fmt::format("process {} ({})", told.pid, told.program);
}

PusherLog::Message PusherLog::begins(uint32_t arm, uint32_t place, pid_t pid, const std::string& program) {
  const std::lock_guard lock(mutex_);
  Reported& told = at(arm, place) = Reported();
  told.pid = pid;
  told.program = program;
  return {HSP_LOG_INFO, who(told) + " pushes on it"};
}

PusherLog::Message PusherLog::ends(uint32_t arm, uint32_t place, End how, const ClientForces::Client& client) {
  const std::lock_guard lock(mutex_);
  Reported& told = at(arm, place);
  const std::string name = who(told);
  told.pid = 0;
  const double given = client.given.load(kRelaxed);
  if (how == End::kUnlead) return {HSP_LOG_INFO, name + " no longer pushes on it"};
  if (told.silent) return {HSP_LOG_WARNING, name + " ended; it was silent before, so its force had ended already"};
  if (given == 0) return {HSP_LOG_INFO, name + " ended; its force was zero"};
  return {HSP_LOG_WARNING, fmt::format("{} ended while it pushed with {:.3g} N: its force ramped out", name, given)};
}

std::vector<PusherLog::Message> PusherLog::update(uint32_t arm, const ClientForces& forces, double now) {
  const std::lock_guard lock(mutex_);
  std::vector<Message> messages;
  for (uint32_t place = 0; place < ClientForces::kMost; ++place) {
    Reported& told = at(arm, place);
    if (told.pid == 0) continue;
    const ClientForces::Client& client = forces.clients()[place];
    checkSilence(told, client, messages);
    checkRefusals(told, client, now, messages);
    checkBound(told, client, forces.bound(), messages);
  }
  return messages;
}

void PusherLog::checkSilence(Reported& told, const ClientForces::Client& client, std::vector<Message>& messages) {
  const double quiet = client.quiet.load(kRelaxed);
  if (!told.silent && quiet > kSilent)
    messages.push_back(
        {HSP_LOG_WARNING, fmt::format("{} fell silent while it pushed with {:.3g} N: its force ramped out", who(told),
                                      client.given.load(kRelaxed))});
  if (told.silent && quiet == 0)
    messages.push_back(
        {HSP_LOG_INFO,
         fmt::format("{} answers again, after about {:.1f} s of silence: its force fades in", who(told), told.quiet)});
  told.silent = told.silent ? quiet > 0 : quiet > kSilent;
  told.quiet = quiet;
}

void PusherLog::checkRefusals(Reported& told, const ClientForces::Client& client, double now,
                              std::vector<Message>& messages) {
  const uint64_t refused = client.refused.load(kRelaxed);
  if (refused == told.refused || now - told.refused_at < kRefusedPeriod) return;
  told.refused = refused;
  told.refused_at = now;
  messages.push_back(
      {HSP_LOG_WARNING, fmt::format("{} answer{} of {} {} refused so far: {}", refused, refused == 1 ? "" : "s",
                                    who(told), refused == 1 ? "was" : "were", describe(client.why.load(kRelaxed)))});
}

void PusherLog::checkBound(Reported& told, const ClientForces::Client& client, double bound,
                           std::vector<Message>& messages) {
  constexpr double kRounding = 1e-3;  // tolerance, for a program such as libHD that limits its force to the same bound
  if (told.bounded || client.bounded.load(kRelaxed) == 0) return;
  if (client.asked.load(kRelaxed) <= bound * (1 + kRounding)) return;
  told.bounded = true;
  messages.push_back(
      {HSP_LOG_WARNING,
       fmt::format("{} asked for {:.3g} N and gets {:.3g} N at most (clients.max_force, or the limit of the device)",
                   who(told), client.asked.load(kRelaxed), bound)});
}

}  // namespace hapticd::servo
