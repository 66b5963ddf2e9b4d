// SPDX-License-Identifier: MIT
#include "record/client_report.hpp"

#include <algorithm>

namespace hapticd::record {

bool late(const ClientReport& client) {
  constexpr uint64_t kEnough = 200;  // fewer answers are too few to judge
  return client.answers >= kEnough && client.sameTick() < kEnoughInTime;
}

std::string lateFix(double answer_time) {
  const std::string priority = "give the program SCHED_FIFO priority 70 (group haptic) and its own processor";
  if (answer_time > 0) return priority;
  return "write clients: {mode: add, answer_time: 60e-6} in the scene, so that the servo waits for its answers; then " +
         priority;
}

void add(std::vector<ClientReport>& all, const ClientReport& one) {
  constexpr size_t kMost = 32;
  const auto same = std::find_if(all.begin(), all.end(), [&](const ClientReport& other) {
    return other.device == one.device && other.program == one.program;
  });
  if (same == all.end()) {
    if (all.size() == kMost) all.erase(all.begin());
    all.push_back(one);
    return;
  }
  same->pid = one.pid;
  same->times += one.times;
  same->answers += one.answers;
  same->in_time += one.in_time;
  same->next_tick += one.next_tick;
  same->silences += one.silences;
  same->largest_n = std::max(same->largest_n, one.largest_n);
  same->asked_n = std::max(same->asked_n, one.asked_n);
  same->bounded += one.bounded;
  same->refused += one.refused;
  if (!one.why.empty()) same->why = one.why;
}

}  // namespace hapticd::record
