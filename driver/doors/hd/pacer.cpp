// SPDX-License-Identifier: MIT
#include "pacer.hpp"

#include <cerrno>
#include <ctime>

#include "base/clock.hpp"
#include "library.hpp"

namespace hapticd::hd {

namespace {

constexpr uint64_t kSecond = 1'000'000'000, kMillisecond = 1'000'000;  // [ns]
constexpr int kPatienceMs = 20;                     ///< time without a tick after which the library ticks by itself
constexpr uint64_t kSilentNs = 500 * kMillisecond;  ///< time without a tick after which the daemon counts as gone
constexpr uint64_t kLookNs = 100 * kMillisecond;    ///< time between two checks whether the daemon's process lives

void sleepNs(uint64_t ns) {
  const timespec time{static_cast<time_t>(ns / kSecond), static_cast<long>(ns % kSecond)};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &time, nullptr);
}

}  // namespace

double Pacer::rate() const {
  const Guard guard(library_.lock);
  return library_.rate();
}

Pacer::LeadingArm Pacer::first() const {
  const Guard guard(library_.lock);
  for (size_t i = 0; i < kMostArms; ++i)
    if (const Arm& arm = library_.arms()[i]; arm.isOpen()) return {arm.link(), static_cast<HHD>(i)};
  return {};
}

uint64_t Pacer::wait() {
  const std::lock_guard waiting(waiting_);
  const LeadingArm lead = first();
  if (lead.link != followed_.lock()) {
    followed_ = lead.link;
    seen_ = UINT64_MAX, silent_since_ns_ = 0, lost_ = false;
  }
  hapticd_state state;
  const bool there = waitFor(lead, state);
  const uint64_t ns = monotonicNow();
  if (there) {
    seen_ = state.tick;
    silent_since_ns_ = 0, lost_ = lead.link->lost = false;
    show(lead, state, ns);
  } else if (lead.link) {
    missed(lead);
  }
  return ns;
}

bool Pacer::waitFor(const LeadingArm& lead, hapticd_state& state) {
  const auto period = static_cast<uint64_t>(static_cast<double>(kSecond) / rate());
  const bool alone = !lead.link || lost_ || silent_since_ns_ != 0;
  if (!alone) {
    lead.link->listen(listen_us_);
    return lead.link->next(seen_, kPatienceMs, state) == 1;
  }
  sleepNs(period);
  return lead.link && lead.link->next(seen_, 0, state) == 1;
}

/// Called if no state came in time. Reports the error once, until states come again.
void Pacer::missed(const LeadingArm& lead) {
  const uint64_t now = monotonicNow();
  if (silent_since_ns_ == 0) silent_since_ns_ = now, looked_ns_ = 0;
  if (lost_ || now - looked_ns_ < kLookNs) return;
  looked_ns_ = now;
  if (lead.link->runs() && now - silent_since_ns_ < kSilentNs) return;
  lost_ = lead.link->lost = true;
  library_.errors.push(HD_COMM_ERROR, lead.handle, ECONNRESET);
}

void Pacer::show(const LeadingArm& lead, const hapticd_state& state, uint64_t ns) {
  const Guard guard(library_.lock);
  for (Arm& arm : library_.arms()) {
    if (!arm.isOpen()) continue;
    hapticd_state own = state;
    if (arm.link() == lead.link || arm.link()->next(UINT64_MAX, 0, own) == 1) arm.tick(own, ns);
  }
}

void Pacer::endTick() {
  const Guard guard(library_.lock);
  const uint64_t ns = monotonicNow();
  for (Arm& arm : library_.arms()) arm.heartbeat(ns);
}

}  // namespace hapticd::hd
