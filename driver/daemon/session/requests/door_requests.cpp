// SPDX-License-Identifier: MIT
/// Requests of programs that read rows, subscribe to events, or lead.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/shell_word.hpp"
#include "session/messages/program_name.hpp"
#include "session/requests/request_handler.hpp"
#include "session/requests/wait_until.hpp"

namespace hapticd::servo {

using control::Request;

Result<uint32_t> RequestHandler::armOf(const std::string& device) const {
  for (uint32_t i = 0; i < runner_.scene().devices.size(); ++i)
    if (runner_.scene().devices[i].name == device) return i;
  return refuse("unknown", noSuchDevice(runner_.scene(), device));
}

/// Reports to the status page, the log and the report of the run that a program has begun or ended to push.
void RequestHandler::reportPusher(uint32_t arm, const Leads::Pusher& pusher, Leads::PushEvent news) {
  if (news == Leads::PushEvent::kBegins) return runner_.namePusher(arm, pusher.place, pusher.pid, pusher.program);
  runner_.forgetPusher(arm, pusher.place,
                       news == Leads::PushEvent::kLeft ? PusherLog::End::kLeft : PusherLog::End::kUnlead);
  const ClientForces::Client& client = runner_.arms()[arm]->clients().clients()[pusher.place];
  runner_.recordClient(reportOf(client, pusher, runner_.scene().devices[arm].name));
}

Result<Leads::Target> RequestHandler::pushOf(const std::string& device) const {
  const auto arm = armOf(device);
  if (!arm) return Error{arm.error()};
  if (!runner_.scene().clients.push)
    return refuse(
        "unsupported",
        "the scene lets programs watch, but not push\n  fix: write clients: {push: true} in the scene, and start "
        "the daemon again");
  if (!leads_.mayPush())
    return refuse("unsupported", "the scene of the last reload does not let programs push: " + scene_file_ +
                                     "\n  fix: write clients: add (or instead) in the scene, then: hapticd ctl reload");
  if (!runner_.arms()[*arm]->clients().possible())
    return refuse(
        "unsupported",
        "the scene does not let programs push on its arms\n  fix: write clients: add (or instead) in the scene, "
        "and start the daemon again");
  return Leads::Target{Order::Led::kForce, *arm, "device \"" + device + "\""};
}

/// Returns the target that a request wants to lead, or why it cannot be led.
Result<Leads::Target> RequestHandler::leadOf(const Request& request) const {
  if (!request.force.empty()) return pushOf(request.force);
  if (request.hand.empty()) {
    const auto place = placeOf(request.model);
    if (!place && armOf(request.model))
      return refuse("unknown",
                    "\"" + request.model +
                        "\" is an arm, not a model\n  fix: lead its simulated hand: hapticd ctl lead --hand " +
                        shellWord(request.model));
    if (!place) return Error{place.error()};
    if (!places_[*place].model.kinematic)
      return refuse("unsupported", "model \"" + request.model +
                                       "\" is not kinematic: only kinematic models can be led\n"
                                       "  fix: write motion: kinematic in the scene");
    return Leads::Target{Order::Led::kModel, *place, "model \"" + request.model + "\""};
  }
  const auto arm = armOf(request.hand);
  if (!arm) return Error{arm.error()};
  const std::string name = "device \"" + request.hand + "\"";
  if (!runner_.arms()[*arm]->simulated())
    return refuse("unsupported",
                  name + " is not simulated, so a person holds it; only the hand of a simulated arm can be led");
  if (!runner_.arms()[*arm]->hand().guided())
    return refuse("unsupported", "the hand of " + name +
                                     " follows a script or a path\n  fix: write hand: {script: guided} in the scene");
  return Leads::Target{Order::Led::kHand, *arm, "the hand of " + name};
}

Result<std::string> RequestHandler::lead(const control::Peer& peer, const Request& request) {
  if (runner_.virtualTime())
    return refuse(
        "unsupported",
        "the run is in virtual time, which programs cannot follow\n  fix: start the run without --virtual-time");
  const auto target = leadOf(request);
  if (!target) return Error{target.error()};
  if (!stays(peer) && staying() >= control::Server::kMaxStaying)
    return refuse("too_many", std::to_string(staying()) +
                                  " programs lead or listen already, which is the most\n  fix: end one of them");
  runner_.nameLeader(peer.pid, programOf(peer.pid));
  auto memory = leads_.begin(*target, peer);
  if (!memory) return refuse("busy", memory.error());
  attached_ = std::move(*memory);
  const bool pushes = target->led == Order::Led::kForce;
  const std::string why = pushes ? noForceWhy(session(), target->index) : "";
  const double most = pushes ? runner_.arms()[target->index]->clients().bound() : INFINITY;
  return fmt::format(R"({{"ok":true,"bytes":{},"record":"{}"{}{}}})", HAPTICD_LEAD_BYTES,
                     pushes ? "hapticd_push" : "hapticd_target",
                     std::isfinite(most) ? ",\"max_force\":" + nlohmann::json(most).dump() : "",
                     why.empty() ? "" : ",\"no_force\":" + nlohmann::json(why).dump());
}

/// Attaches shared memory to the answer. The memory is made at the first request, and later requests get the same.
Result<void> RequestHandler::attach(std::unique_ptr<SealedMemory>& kept, const char* name, size_t bytes,
                                    SealedMemory::Writers writers) {
  if (!kept) {
    auto memory = SealedMemory::create(name, bytes, writers);
    if (!memory) return Error{memory.error()};
    kept = std::move(*memory);
  }
  auto copy = kept->share();
  if (!copy) return Error{copy.error()};
  attached_ = std::move(*copy);
  return {};
}

Result<std::string> RequestHandler::state() {
  const auto arms = static_cast<uint32_t>(runner_.arms().size());
  const bool first = !runner_.shared().state;
  if (auto done = attach(runner_.shared().state, "hapticd-state", Door::stateBytes(arms), SealedMemory::Writers::kOne);
      !done)
    return Error{done.error()};
  const SealedMemory& memory = *runner_.shared().state;
  if (first) runner_.door().showState(memory.data(), arms);
  return fmt::format(R"({{"ok":true,"bytes":{},"record":"hapticd_state","arms":{},"stride":{}}})", memory.bytes(), arms,
                     Door::kStateStride);
}

Result<std::string> RequestHandler::bell() {
  const bool first = !runner_.shared().bell;
  if (auto done = attach(runner_.shared().bell, "hapticd-bell", sizeof(hapticd_bell), SealedMemory::Writers::kAll);
      !done)
    return Error{done.error()};
  const SealedMemory& memory = *runner_.shared().bell;
  if (first) runner_.door().setBell(new (memory.data()) hapticd_bell{});
  return fmt::format(R"({{"ok":true,"bytes":{},"record":"hapticd_bell"}})", memory.bytes());
}

Result<void> RequestHandler::unlead(const control::Peer& peer, const Request& request) {
  const auto target = leadOf(request);
  if (!target) return Error{target.error()};
  return leads_.end(*target, peer);
}

Result<std::string> RequestHandler::eventsAfter(double after) const {
  constexpr size_t kMost = 256;
  const Flight& flight = *runner_.telemetry().flight();
  uint64_t first = static_cast<uint64_t>(after);
  const uint64_t end = flight.ring().written(kEvents);
  if (after == 0 && end > kMost) first = end - kMost;  // only the newest events
  const auto events = flight.events(first, kMost);
  std::string list;
  for (const hapticd_event& event : events) list += (list.empty() ? "" : ",") + eventText(session(), event);
  return fmt::format(R"({{"ok":true,"first":{},"next":{},"events":[{}]}})", first, first + events.size(), list);
}

/// Marks a tick with a text. The answer says which tick it is.
Result<std::string> RequestHandler::mark(const std::string& text) {
  const Flight& flight = *runner_.telemetry().flight();
  const uint64_t number = flight.ring().written(kMarks);  // of the next mark, because only this thread gives them
  Order order;
  order.kind = Order::Kind::kMark;
  order.target = Order::kNoModel;
  text.copy(order.text, sizeof order.text - 1);
  if (auto given = post(order); !given) return Error{given.error()};
  MarkRow row;
  if (!waitUntil([&] { return flight.mark(number, row); }))
    return refuse("timeout", "the servo has not ended the tick of the mark within 2 s: see hapticd ctl status");
  return lineOf({{"ok", true}, {"tick", row.tick}, {"t", row.t}});
}

Result<std::string> RequestHandler::subscribe(const control::Peer& peer) {
  if (!stays(peer) && staying() >= control::Server::kMaxStaying)
    return refuse("too_many", std::to_string(staying()) +
                                  " programs lead or listen already, which is the most\n  fix: end one of them");
  const uint64_t next = runner_.telemetry().flight()->ring().written(kEvents);
  listeners_[peer.id] = next;
  return fmt::format(R"({{"ok":true,"next":{}}})", next);
}

std::string RequestHandler::news(const control::Peer& peer) {
  constexpr size_t kMostAtOnce = 64;
  const auto listener = listeners_.find(peer.id);
  if (listener == listeners_.end()) return "";
  uint64_t first = listener->second;
  const auto events = runner_.telemetry().flight()->events(first, kMostAtOnce);
  std::string lines;
  if (first > listener->second)
    lines = fmt::format(R"({{"event":"missed","value":{}}})", first - listener->second) + "\n";
  for (const hapticd_event& event : events) lines += eventText(session(), event) + "\n";
  listener->second = first + events.size();
  return lines;
}

void RequestHandler::left(const control::Peer& peer) {
  listeners_.erase(peer.id);
  leads_.left(peer);
}

bool RequestHandler::stays(const control::Peer& peer) const {
  return listeners_.count(peer.id) > 0 || leads_.holds(peer);
}

size_t RequestHandler::staying() const {
  std::set<uint64_t> peers = leads_.holders();
  for (const auto& listener : listeners_) peers.insert(listener.first);
  return peers.size();
}

}  // namespace hapticd::servo
