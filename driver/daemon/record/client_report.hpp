// SPDX-License-Identifier: MIT
/// What a program that pushed on an arm was like: how much of it came in time, and what it is to do otherwise.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace hapticd::record {

struct ClientReport {
  std::string device, program;
  int pid = 0;             ///< of the last process, if the program was started several times
  uint64_t times = 1;      ///< that it was started
  uint64_t answers = 0;    ///< that counted
  uint64_t in_time = 0;    ///< of these, answered in the tick that they answer
  uint64_t next_tick = 0;  ///< of these, answered one tick late
  uint64_t silences = 0;   ///< how often it fell silent, and its force ramped out
  double largest_n = 0;    ///< [N] of its force
  double asked_n = 0;      ///< [N] the largest force that it asked for
  uint64_t bounded = 0;    ///< answers that were cut to the bound
  uint64_t refused = 0;    ///< answers that were refused whole
  std::string why;         ///< why the last of these was refused; "": none was

  double sameTick() const { return share(in_time); }
  double nextTick() const { return share(next_tick); }

 private:
  double share(uint64_t part) const {  // they are counted one after the other, and a reader may see the part first
    const double whole = static_cast<double>(answers), some = static_cast<double>(part);
    return answers == 0 ? 0 : some < whole ? some / whole : 1;
  }
};

/// One tick of delay reduces the stiffest stable wall to a third: a smaller share than this is reported.
constexpr double kEnoughInTime = 0.95;

/// True if it answered for long enough to be judged, and too late.
bool late(const ClientReport& client);

/// Advice for a late program. @param answer_time [s] of the scene's clients
std::string lateFix(double answer_time);

/// Adds this to the counts of the same program on the same device. At most 32 are kept, the newest.
void add(std::vector<ClientReport>& all, const ClientReport& one);

}  // namespace hapticd::record
