// SPDX-License-Identifier: MIT
#include "session.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::haply {

namespace {

using Json = nlohmann::json;

Json vectorJson(const std::array<double, 3>& v) {
  return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}};
}

const Json& childOf(const Json& json, const char* key) {
  static const Json nothing;
  if (!json.is_object()) return nothing;
  const auto it = json.find(key);
  return it != json.end() ? *it : nothing;
}

/// Reads three finite numbers x, y and z. Returns false if one of them is missing or not finite.
bool readVector(const Json& json, double v[3]) {
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const Json& number = childOf(json, axes[i]);
    if (!number.is_number()) return false;
    v[i] = number.get<double>();
    if (!std::isfinite(v[i])) return false;
  }
  return true;
}

Json stateOf(const hapticd_state& state, const double wanted[3], const Basis& basis) {
  Json angles = Json::object();
  for (uint32_t i = 0; i < std::min<uint32_t>(state.joint_count, 3); ++i)
    angles["a" + std::to_string(i)] = state.joints[i];
  return {{"cursor_position", vectorJson(basis.fromWorld(state.position))},
          {"cursor_velocity", vectorJson(basis.fromWorld(state.velocity))},
          {"angular_position", angles},
          {"body_orientation", {{"w", 1.0}, {"x", 0.0}, {"y", 0.0}, {"z", 0.0}}},
          {"current_cursor_force", vectorJson(basis.fromWorld(wanted))},
          {"control_domain", "cartesian"},
          {"control_mode", "force"}};
}

/// Returns the part of a state that describes the handle: the orientation of the tip, and the buttons.
Json gripOf(const hapticd_state& state, const std::string& id, const Basis& basis) {
  const auto q = basis.turnFromWorld(state.orientation);
  return {{"device_id", id},
          {"state",
           {{"orientation", {{"w", q[0]}, {"x", q[1]}, {"y", q[2]}, {"z", q[3]}}},
            {"buttons",
             {{"a", (state.buttons & 1) != 0}, {"b", (state.buttons & 2) != 0}, {"c", (state.buttons & 4) != 0}}},
            {"battery_level", 1.0}}},
          {"status", {{"connected", true}, {"awake", true}, {"ready", true}}}};
}

Json configOf() {
  return {{"type", "inverse3"},
          {"handedness", "right"},
          {"preset", "defaults"},
          {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}},
          {"basis", {{"permutation", "XYZ"}}}};
}

}  // namespace

Result<std::unique_ptr<Session>> Session::open(const std::string& daemon, int number) {
  hapticd_error error;
  hapticd_client* client = hapticd_connect(daemon.c_str(), &error);
  if (client == nullptr) return Error{error.text};
  std::unique_ptr<Session> session(new Session(client, number));
  for (int i = 0; hapticd_device_name(client, i) != nullptr; ++i)
    session->arms_.push_back(std::make_unique<Arm>(client, i, hapticd_device_name(client, i)));
  return session;
}

Session::~Session() {
  arms_.clear();
  hapticd_close(client_);
}

std::string Session::stateMessage(bool all) {
  Json arms = Json::array(), grips = Json::array();
  for (const auto& arm : arms_) {
    hapticd_state state;
    if (!arm->readState(state)) return "";
    double wanted[3];
    arm->readForce(wanted);
    Json& one = arms.emplace_back(Json{{"device_id", arm->name()}, {"state", stateOf(state, wanted, basis_)}});
    one["status"] = {{"calibrated", (state.flags & HAPTICD_GOOD) != 0},
                     {"in_use", true},
                     {"power_supply", true},
                     {"ready", state.fault == 0},
                     {"started", true}};
    if (all) one["config"] = configOf();
    grips.push_back(gripOf(state, arm->name(), basis_));
  }
  Json message = {{"inverse3", std::move(arms)}, {"wireless_verse_grip", std::move(grips)}};
  if (all) message["session_id"] = number_;
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string Session::inventory() {
  return stateMessage(true);
}

std::string Session::answer(const std::string& message) {
  const Json json = Json::parse(message, nullptr, false);
  bool all = false;
  if (json.is_object()) {
    execute(json);
    all = childOf(json, "session").contains("force_render_full_state");
  } else {
    noteProblem("a message is not a JSON object");
  }
  return stateMessage(all);
}

void Session::execute(const Json& message) {
  const Json& permutation = childOf(childOf(childOf(childOf(message, "session"), "configure"), "basis"), "permutation");
  if (permutation.is_string() && !basis_.set(permutation.get<std::string>()))
    noteProblem("the basis \"" + permutation.get<std::string>().substr(0, 40) +
                "\" is not a permutation of X, Y and Z, such as \"XZY\"");
  for (const Json& device : childOf(message, "inverse3")) {
    const Json& asked = childOf(device, "device_id");
    if (!asked.is_string()) continue;
    const auto id = asked.get<std::string>();
    const auto arm = std::find_if(arms_.begin(), arms_.end(), [&](const auto& one) { return one->name() == id; });
    if (arm == arms_.end())
      noteProblem("there is no arm \"" + id.substr(0, 100) + "\"");
    else
      executeForArm(**arm, childOf(device, "commands"));
  }
}

void Session::executeForArm(Arm& arm, const Json& commands) {
  if (!commands.is_object()) return;
  for (const auto& [name, command] : commands.items()) {
    double force[3];
    if (name == "probe_position") continue;
    if (name != "set_cursor_force") {
      noteProblem("the command " + name.substr(0, 60) +
                  " is not known here; only set_cursor_force and probe_position are known");
    } else if (!readVector(childOf(command, "values"), force)) {
      noteProblem("set_cursor_force needs values with three finite numbers x, y and z");
    } else {
      const auto world = basis_.toWorld(force);
      if (auto pushed = arm.push(world.data()); !pushed) noteProblem(pushed.error());
    }
  }
}

void Session::noteProblem(const std::string& what) {
  if (!complained_) complaint_ = what;
  complained_ = true;
}

std::string Session::takeProblem() {
  return std::exchange(complaint_, "");
}

}  // namespace hapticd::haply
