// SPDX-License-Identifier: MIT
#include "servo/arm/client_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::servo {

namespace {

using Eigen::Vector3d;

void count(std::atomic<uint64_t>& counter) noexcept HSP_RT {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

Vector3d bounded(const double* wanted, double most) noexcept HSP_RT {
  const Vector3d v = Eigen::Map<const Vector3d>(wanted);
  const double size = v.norm();
  return size > most ? Vector3d(v * (most / size)) : v;
}

double boundOf(double wanted, double device) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  return std::min(wanted > 0 ? wanted : kNone, device > 0 ? device : kNone);
}

/// Moves a gain toward 0 or 1. It reaches exactly 0 or 1: a rest that rounding leaves must not stay as a force.
double faded(double gain, bool in, double dt) noexcept HSP_RT {
  constexpr double kRounding = 1e-9;
  const double next = gain + (in ? dt / ClientForces::kFadeIn : -dt / ClientForces::kFadeOut);
  return next < kRounding ? 0 : std::min(next, 1.0);
}

}  // namespace

ClientForces::ClientForces(const scene::Clients& clients, double device_force, double device_torque, double period)
    : mode_(clients.mode),
      max_force_(boundOf(clients.max_force, device_force)),
      max_torque_(device_torque),
      oldest_ticks_(static_cast<uint64_t>(std::max(1.0, std::floor(kOldest / period)))) {}

void ClientForces::begin(uint32_t place, const link::PushSlot& slot) noexcept HSP_RT {
  if (place >= kMost || !possible()) return;
  Client& client = clients_[place];
  if (client.slot == nullptr && client.gain == 0) ++places_;
  client.slot = &slot;
  client.seen = 0;
  client.silence = kSilentAfter + kFadeOut;
  client.answered = false;
  for (std::atomic<uint64_t>* counter :
       {&client.answers, &client.in_time, &client.silences, &client.next_tick, &client.bounded, &client.refused})
    counter->store(0, std::memory_order_relaxed);
  for (std::atomic<double>* figure : {&client.felt, &client.largest, &client.asked, &client.given, &client.quiet})
    figure->store(0, std::memory_order_relaxed);
  client.why.store(Refusal::kNone, std::memory_order_relaxed);
}

void ClientForces::end(uint32_t place) noexcept HSP_RT {
  if (place >= kMost || clients_[place].slot == nullptr) return;
  clients_[place].slot = nullptr;
  if (clients_[place].gain == 0) --places_;
}

bool ClientForces::awaits(uint64_t tick) const noexcept HSP_RT {
  constexpr uint64_t kKeepsUp = 2;  // [ticks] the servo does not wait for a program that answers, say, every tenth tick
  const auto awaited = [&](const Client& client) {
    if (client.slot == nullptr || !client.answered || tick - client.push.tick > kKeepsUp) return false;
    hapticd_push push;
    uint64_t seen = client.seen;
    return !client.slot->take(seen, push) || push.tick < tick;
  };
  return places_ > 0 && std::any_of(clients_.begin(), clients_.end(), awaited);
}

void ClientForces::step(uint64_t tick, double dt) noexcept HSP_RT {
  force_.setZero();
  torque_.setZero();
  double most = 0;
  for (Client& client : clients_) {
    client.fresh = false;
    if (client.slot == nullptr && client.gain == 0) continue;
    step(client, tick, dt);
    most = std::max(most, client.gain);
    if (client.slot == nullptr && client.gain == 0) --places_;
  }
  if (mode_ != scene::ClientMode::kInstead) return;
  // The models fade out as the programs fade in. They come back no faster, although a silent program fades out faster.
  share_ = std::min(1 - most, share_ + dt / kFadeIn);
}

void ClientForces::step(Client& client, uint64_t tick, double dt) noexcept HSP_RT {
  const bool was_silent = client.silence > kSilentAfter;
  client.silence = take(client, tick) ? 0 : client.silence + dt;
  const bool silent = client.slot == nullptr || client.silence > kSilentAfter;
  if (silent && !was_silent && client.slot != nullptr) count(client.silences);  // not counted if the program has left
  if (client.slot != nullptr && client.answered)
    client.quiet.store(silent ? client.silence : 0, std::memory_order_relaxed);
  client.gain = faded(client.gain, !silent, dt);
  if (client.gain == 0) return client.felt.store(0, std::memory_order_relaxed);
  const Vector3d force = client.gain * bounded(client.push.force, max_force_);
  const double felt = force.norm();
  client.felt.store(felt, std::memory_order_relaxed);
  if (felt > client.largest.load(std::memory_order_relaxed)) client.largest.store(felt, std::memory_order_relaxed);
  force_ += force;
  torque_ += client.gain * bounded(client.push.torque, max_torque_);
}

/// Reads a program's record. Returns true if the record answers a newer tick than the last record did.
bool ClientForces::take(Client& client, uint64_t tick) noexcept HSP_RT {
  hapticd_push push;
  // Reads a second time: if the program was writing during the first read, its answer may be complete now.
  if (client.slot == nullptr || (!client.slot->take(client.seen, push) && !client.slot->take(client.seen, push)))
    return false;
  if (const Refusal why = refusalOf(push, tick); why != Refusal::kNone) {
    ++refused_;
    client.why.store(why, std::memory_order_relaxed);
    count(client.refused);
    return false;
  }
  if ((client.answered && push.tick <= client.push.tick) || tick - push.tick > oldest_ticks_) return false;
  client.push = push;
  client.answered = client.fresh = true;
  note(client);
  count(client.answers);
  if (push.tick == tick) count(client.in_time);
  if (push.tick + 1 == tick) count(client.next_tick);
  return true;
}

/// Notes the largest force that a program asked for, the size of its last force within the bound, and how many of its
/// forces were larger.
void ClientForces::note(Client& client) const noexcept HSP_RT {
  const double asked = Eigen::Map<const Vector3d>(client.push.force).norm();
  client.given.store(std::min(asked, max_force_), std::memory_order_relaxed);
  if (asked > client.asked.load(std::memory_order_relaxed)) client.asked.store(asked, std::memory_order_relaxed);
  if (asked > max_force_) count(client.bounded);
}

ClientForces::Refusal ClientForces::refusalOf(const hapticd_push& push, uint64_t tick) noexcept HSP_RT {
  if (push.tick > tick) return Refusal::kAhead;
  Refusal why = Refusal::kNone;
  for (const double* numbers : {push.force, push.torque})
    for (int i = 0; i < 3; ++i) {
      if (!std::isfinite(numbers[i])) return Refusal::kNotFinite;
      if (!(std::abs(numbers[i]) <= kLargestNumber)) why = Refusal::kTooLarge;
    }
  return why;
}

}  // namespace hapticd::servo
