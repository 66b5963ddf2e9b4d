// SPDX-License-Identifier: MIT
/// The functions of client.h that wait for the rows or for the state of a tick. They use the bell (hapticd_bell).
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <ctime>

#include "base/clock.hpp"
#include "internal.hpp"
#include "link/lead.hpp"

namespace {

constexpr long kMsPerSecond = 1000, kNsPerMs = 1'000'000, kNsPerSecond = kMsPerSecond * kNsPerMs;

int64_t nowNs() {
  return static_cast<int64_t>(hapticd::monotonicNow());
}

long nowMs() {
  return static_cast<long>(nowNs() / kNsPerMs);
}

void sleepUntil(int64_t ns) {
  const timespec when{ns / kNsPerSecond, ns % kNsPerSecond};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr);
}

/// Sleeps until the word is no longer `seen`, at most for the given time. It may return earlier (spurious wake-up).
void sleepOn(uint32_t& word, uint32_t& waiting, uint32_t seen, long ms) {
  std::atomic_ref<uint32_t>(waiting).store(1);
  if (std::atomic_ref<uint32_t>(word).load() != seen)
    return;  // the servo counted before it could see that this program waits
  const timespec limit{ms / kMsPerSecond, ms % kMsPerSecond * kNsPerMs};
  syscall(SYS_futex, &word, FUTEX_WAIT, seen, &limit, nullptr, 0);
}

/// Calls `there` after each wake-up until it returns true, or until nowMs() is `end`. @return 1 if `there` returned
/// true, 0 if it did not in time, -1 if the daemon has ended
template <class There>
int waitFor(hapticd_client* client, uint32_t& word, uint32_t& waiting, long end, There&& there) {
  constexpr long kLongest = 100;  // [ms] a wake-up may be lost if another program writes to the bell
  for (;;) {
    const uint32_t seen = std::atomic_ref<uint32_t>(word).load();
    if (there()) return 1;
    const long left = end - nowMs();
    if (left <= 0) return client->ended() ? -1 : 0;
    if (client->ended()) return -1;
    sleepOn(word, waiting, seen, std::min(left, kLongest));
  }
}

hapticd_bell* bellOf(hapticd_client* client) {
  return reinterpret_cast<hapticd_bell*>(
      client->page(R"({"do":"bell"})", client->bell, sizeof(hapticd_bell), PROT_READ | PROT_WRITE));
}

/// Reads the newest record of an arm. It tries again while the servo writes, which takes less than a microsecond.
template <class Record>
bool newest(std::byte* at, Record& record) {
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    uint64_t seen = 0;  // the value of the count before the first record is written
    if (reinterpret_cast<hapticd::link::LeadSlot<Record>*>(at)->take(seen, record)) return true;
    if (std::atomic_ref<uint64_t>(*reinterpret_cast<uint64_t*>(at)).load() == 0) return false;
  }
  return false;
}

/// Polls from `before` [ns] before the time at which the tick after `state` is due until `before` after it. @return
/// true if a tick after `after` came
bool listen(std::byte* at, int64_t period, int64_t before, uint64_t after, hapticd_state& state) {
  const int64_t due = static_cast<int64_t>(state.time_ns) + period, now = nowNs();
  // In virtual time, or after a pause of the daemon, the time of the next tick is unknown.
  if (due + before < now || due - now > 2 * period) return false;
  sleepUntil(due - before);
  while (nowNs() < due + before)
    if (newest(at, state) && state.tick > after) return true;
  return false;
}

/// Returns the record of an arm in the memory of `state`, or nullptr if there is none.
std::byte* recordOf(hapticd_client* client, int device, size_t behind, size_t bytes) {
  const std::byte* shared = client->page(R"({"do":"state"})", client->states, sizeof(hapticd_state_page), PROT_READ);
  if (shared == nullptr) return nullptr;
  hapticd_state_page page;
  std::memcpy(&page, shared, sizeof page);
  if (device < 0 || static_cast<uint32_t>(device) >= page.arms || page.stride < behind + bytes || page.stride % 8 != 0)
    return nullptr;
  return client->states.at(sizeof page + size_t{page.stride} * static_cast<uint32_t>(device) + behind, bytes);
}

}  // namespace

int hapticd_wait(hapticd_client* client, uint64_t tick, int timeout_ms) try {
  const int ticks = hapticd_stream(client, "ticks");
  hapticd_bell* bell = bellOf(client);
  if (bell == nullptr || ticks < 0) return -1;
  return waitFor(client, bell->rows, bell->rows_waiting, nowMs() + timeout_ms,
                 [&] { return hapticd_written(client, ticks) > tick; });
} catch (const std::exception&) {
  return -1;
}

int hapticd_next_state(hapticd_client* client, int device, uint64_t after, int timeout_ms, hapticd_state* state) try {
  std::byte* at = recordOf(client, device, 0, sizeof(hapticd::link::StateSlot));
  hapticd_bell* bell = bellOf(client);
  if (at == nullptr || bell == nullptr) return -1;
  const auto there = [&] { return newest(at, *state) && (after == UINT64_MAX || state->tick > after); };
  const int64_t before = client->listen_ns.load(std::memory_order_relaxed), period = client->rows.period();
  const long end = nowMs() + timeout_ms;
  if (after == UINT64_MAX && client->ended()) return -1;  // the daemon has ended, so no new state will come
  if (there()) return 1;
  if (before > 0 && after != UINT64_MAX && timeout_ms * kNsPerMs > 2 * period &&
      listen(at, period, before, after, *state))
    return 1;
  return waitFor(client, bell->state, bell->state_waiting, end, there);
} catch (const std::exception&) {
  return -1;
}

void hapticd_listen(hapticd_client* client, unsigned microseconds) {
  constexpr unsigned kMost = 200;
  client->listen_ns.store(std::min(microseconds, kMost) * int64_t{1000}, std::memory_order_relaxed);
}

int hapticd_read_jacobian(hapticd_client* client, int device, hapticd_jacobian* jacobian) try {
  std::byte* at = recordOf(client, device, hapticd::link::kJacobianAt, sizeof(hapticd::link::JacobianSlot));
  if (at == nullptr) return -1;
  return newest(at, *jacobian) ? 1 : 0;
} catch (const std::exception&) {
  return -1;
}
