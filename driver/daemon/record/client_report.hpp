// SPDX-License-Identifier: MIT
/// Statistics of a program that pushed on an arm: how many of its answers came in time, and advice if too few came in
/// time.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace hapticd::record {

struct ClientReport {
  std::string device, program;
  int pid = 0;             ///< process id of the program, the last one if it was started several times
  uint64_t times = 1;      ///< how often the program was started
  uint64_t answers = 0;    ///< answers that were used
  uint64_t in_time = 0;    ///< number of these answers that came in the same tick
  uint64_t next_tick = 0;  ///< number of these answers that came one tick later
  uint64_t silences = 0;   ///< how often it stopped answering, so that its force was ramped out
  double largest_n = 0;    ///< [N] its largest force
  double asked_n = 0;      ///< [N] largest force that it asked for
  uint64_t bounded = 0;    ///< answers whose force was reduced to the bound
  uint64_t refused = 0;    ///< answers that were refused because of an error in them
  std::string why;         ///< why the last answer was refused; "" if none was

  double sameTick() const { return share(in_time); }
  double nextTick() const { return share(next_tick); }

 private:
  // at most 1, because a reader may see the new value of `part` but the old value of `answers`
  double share(uint64_t part) const {
    const double whole = static_cast<double>(answers), some = static_cast<double>(part);
    return answers == 0 ? 0 : some < whole ? some / whole : 1;
  }
};

/// If a smaller share of the answers comes in the same tick, advice is given. With one tick of delay, a wall that a
/// program renders can have only a third of the stiffness before it becomes unstable.
constexpr double kEnoughInTime = 0.95;

/// True if the program answered too late, and often enough to judge this.
bool late(const ClientReport& client);

/// Returns advice for a late program. @param answer_time [s] the scene's clients.answer_time
std::string lateFix(double answer_time);

/// Adds the counts of `one` to those of the same program on the same device. Only the newest 32 programs are kept.
void add(std::vector<ClientReport>& all, const ClientReport& one);

}  // namespace hapticd::record
