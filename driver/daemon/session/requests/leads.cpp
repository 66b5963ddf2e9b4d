// SPDX-License-Identifier: MIT
#include "session/requests/leads.hpp"

#include <algorithm>
#include <new>

#include "session/messages/program_name.hpp"

namespace hapticd::servo {

namespace {

Order orderOf(Order::Kind kind, const Leads::Target& target) {
  Order order;
  order.kind = kind;
  order.target = target.index;
  order.param = static_cast<uint32_t>(target.led);
  order.place = target.place;
  return order;
}

bool same(const Leads::Target& a, const Leads::Target& b) {
  return a.led == b.led && a.index == b.index;
}

}  // namespace

/// Chooses a place for a program: each time the next free one, because the force of the last program in a place may
/// still ramp out.
Result<void> Leads::findPlace(Target& target, const control::Peer& peer) {
  const auto others = pushers(target.index);
  if (exclusive_ && !others.empty())
    return Error{"process " + std::to_string(others.front().pid) + " pushes on " + target.name +
                 " already, and the scene allows only one program at a time (clients: {exclusive: true})"};
  for (const Lead& lead : leads_)
    if (same(lead.target, target) && lead.peer.id == peer.id)
      return Error{"this connection pushes on " + target.name + " already"};
  for (uint32_t i = 0; i < ClientForces::kMost; ++i) {
    target.place = last_place_ = (last_place_ + 1) % ClientForces::kMost;
    const bool taken =
        std::any_of(others.begin(), others.end(), [&](auto& other) { return other.place == target.place; });
    if (!taken) return {};
  }
  return Error{std::to_string(others.size()) + " programs push on " + target.name +
               " already, which is the most; expected one of them to end first"};
}

Result<Descriptor> Leads::begin(Target target, const control::Peer& peer) {
  if (target.led == Order::Led::kForce) {
    if (auto found = findPlace(target, peer); !found) return Error{found.error()};
  } else if (const auto pid = leader(target.led, target.index)) {
    return Error{"process " + std::to_string(*pid) + " leads " + target.name +
                 " already; that lead ends with the request unlead, or when the program's connection ends"};
  }
  auto memory = SealedMemory::create("hapticd-lead", HAPTICD_LEAD_BYTES, SealedMemory::Writers::kAll);
  if (!memory) return Error{memory.error()};
  auto shared = (*memory)->share();
  if (!shared) return Error{shared.error()};
  Order order = orderOf(Order::Kind::kLead, target);
  order.value = peer.pid;
  if (target.led == Order::Led::kForce)
    order.push = new ((*memory)->data()) link::PushSlot;  // an empty slot is all zeros, as the memory is already
  else
    order.slot = new ((*memory)->data()) link::PoseSlot;
  if (programs_.size() >= kMostPrograms) programs_.clear();
  programs_[peer.pid] = programOf(peer.pid);  // set before the servo reports the new leader
  const auto given = post_order_(order);
  // The lead is kept even if the servo did not obey in time, because the servo may obey later.
  leads_.push_back({target, peer, std::move(*memory), programs_[peer.pid]});
  notify(leads_.back(), PushEvent::kBegins);
  if (given) return std::move(*shared);
  (void)end(target, peer);
  return Error{given.error()};
}

Result<void> Leads::end(const Target& target, const control::Peer& peer, PushEvent how) {
  const auto found = std::find_if(leads_.begin(), leads_.end(), [&](const Lead& lead) {
    return same(lead.target, target) && lead.peer.id == peer.id;
  });
  if (found == leads_.end())
    return Error{"this connection neither leads " + target.name + " nor pushes on it, so there is nothing to end"};
  Lead lead = std::move(*found);
  leads_.erase(found);
  return finish(std::move(lead), how);
}

Leads::~Leads() {
  for (const Lead& lead : leads_) notify(lead, PushEvent::kEnds);
}

void Leads::notify(const Lead& lead, PushEvent news) const {
  if (on_push_event_ && lead.target.led == Order::Led::kForce)
    on_push_event_(lead.target.index, {lead.peer.pid, lead.target.place, lead.program}, news);
}

Result<void> Leads::finish(Lead lead, PushEvent how) {
  Order order = orderOf(Order::Kind::kUnlead, lead.target);
  order.value = lead.peer.pid;
  auto done = post_order_(order);
  notify(lead, how);
  if (!done) kept_.push_back(std::move(lead.memory));
  return done;
}

Result<void> Leads::endOfModel(uint32_t model) {
  const auto found = std::find_if(leads_.begin(), leads_.end(), [&](const Lead& lead) {
    return lead.target.led == Order::Led::kModel && lead.target.index == model;
  });
  return found == leads_.end() ? Result<void>() : end(found->target, found->peer);
}

void Leads::endPushes() {
  const auto pushes = [](const Lead& lead) { return lead.target.led == Order::Led::kForce; };
  for (auto found = leads_.begin(); (found = std::find_if(leads_.begin(), leads_.end(), pushes)) != leads_.end();)
    // An error only means that the servo is late: the servo will still end the push.
    (void)end(Target(found->target), control::Peer(found->peer), PushEvent::kEnds);
}

void Leads::left(const control::Peer& peer) {
  while (holds(peer)) {
    const auto found =
        std::find_if(leads_.begin(), leads_.end(), [&](const Lead& lead) { return lead.peer.id == peer.id; });
    (void)end(found->target, peer, PushEvent::kLeft);  // the peer is gone, so an error is not reported
  }
}

std::optional<pid_t> Leads::leader(Order::Led led, uint32_t index) const {
  for (const Lead& lead : leads_)
    if (lead.target.led == led && lead.target.index == index) return lead.peer.pid;
  return std::nullopt;
}

std::string Leads::program(pid_t pid) const {
  const auto found = programs_.find(pid);
  return found != programs_.end() ? found->second : "?";
}

std::vector<Leads::Pusher> Leads::pushers(uint32_t arm) const {
  std::vector<Pusher> found;
  for (const Lead& lead : leads_)
    if (lead.target.led == Order::Led::kForce && lead.target.index == arm)
      found.push_back({lead.peer.pid, lead.target.place, lead.program});
  return found;
}

bool Leads::holds(const control::Peer& peer) const {
  return std::any_of(leads_.begin(), leads_.end(), [&](const Lead& lead) { return lead.peer.id == peer.id; });
}

std::set<uint64_t> Leads::holders() const {
  std::set<uint64_t> peers;
  for (const Lead& lead : leads_) peers.insert(lead.peer.id);
  return peers;
}

}  // namespace hapticd::servo
