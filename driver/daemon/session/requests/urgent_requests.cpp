// SPDX-License-Identifier: MIT
/// Requests that wait for no other request: a user who wants to end the force must not wait until a model is built.
#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "base/happens_within.hpp"
#include "session/requests/request_handler.hpp"

namespace hapticd::servo {

using control::Request;

namespace {

/// [ns] Pause between two checks whether the servo has obeyed, and longest time to wait; the servo needs one tick.
constexpr Nanoseconds kPause = 500'000, kPatience = 100'000'000;

std::string good() {
  return R"({"ok":true})";
}

}  // namespace

std::optional<control::Reply> RequestHandler::urgent(const control::Peer&, const std::string& line) {
  std::string id;
  auto request = control::parseRequest(line, &id);
  if (!request || (request->kind != Request::Kind::kHold && request->kind != Request::Kind::kStop)) return std::nullopt;
  if (request->kind == Request::Kind::kStop) {
    runner_.stop();
    return control::Reply(control::withId(good(), id));
  }
  const char* code = "failed";
  const auto held = hold(request->device, code);
  return control::Reply(control::withId(held ? *held : control::refusal(held.error(), code), id));
}

/// Holds arms. May be called on any thread. The queue of orders has one writer and may be full, so a hold does not use
/// it.
Result<std::string> RequestHandler::hold(const std::string& device, const char*& code) {
  const auto& devices = runner_.scene().devices;
  uint64_t arms = 0;
  for (size_t i = 0; i < devices.size() && i < 64; ++i)
    if (device.empty() || devices[i].name == device) arms |= uint64_t{1} << i;
  code = arms == 0 ? "unknown" : "timeout";
  if (arms == 0) return Error{noSuchDevice(runner_.scene(), device)};
  held_at_.store(monotonicNow());
  runner_.hold(arms);
  if (runner_.loop().ticks() == 0) return good();  // no force has flowed yet, and the hold keeps it off
  const auto obeyed = [&] { return runner_.loop().holdsObeyed(arms) || runner_.loop().finished(); };
  if (happensWithin(kPatience, kPause, obeyed)) return good();
  return Error{
      "the servo did not obey within 0.1 s: it may have stopped, and then its motors were cut: see hapticd ctl status"};
}

}  // namespace hapticd::servo
