// SPDX-License-Identifier: MIT
#include "session/requests/answers.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "document/json_text.hpp"
#include "document/suggestion.hpp"
#include "host/class_params.hpp"
#include "host/class_table.hpp"
#include "session/messages/silence_reason.hpp"
#include "session/telemetry/event_finder.hpp"

namespace hapticd::servo {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kClientModes[] = {"off", "add", "instead"};  ///< in the order of scene::ClientMode

/// Returns the default of a parameter. For an array, the plugin's table has it as JSON text such as "[0, 1, 0]", or
/// empty.
Json defaultOf(const hsp_param& param) {
  Json numbers = Json::parse(host::textOf(param.def_text), nullptr, false);
  return numbers.is_array() ? numbers : Json::array();
}

/// Returns a parameter's value in JSON: the word of a choice, true or false for a switch.
Json valueJson(const scene::Model& model, const hsp_param& param) {
  const scene::Value* value = scene::givenIn(model.parameters, param.id);
  const double number = value != nullptr ? value->number : param.def;
  switch (param.kind) {
    case HSP_BOOL:
      return number != 0;
    case HSP_ENUM: {
      const auto choice = static_cast<uint32_t>(number);
      return choice < param.choice_count ? Json(host::textOf(param.choices[choice])) : Json(choice);
    }
    case HSP_REAL:
    case HSP_INT:
      return number;
    case HSP_ARRAY:
      return value != nullptr ? Json(value->numbers) : defaultOf(param);
    default:
      return value != nullptr ? Json(value->text) : param.def_text != nullptr ? Json(param.def_text) : Json();
  }
}

Json liveParameters(const Session& session, uint32_t place) {
  Json live = Json::array();
  const hsp_class& plugin = session.runner.world().shapes()[place]->description();
  for (uint32_t i = 0; i < plugin.param_count; ++i) {
    const hsp_param& param = host::paramAt(plugin, i);
    if ((param.flags & HSP_P_LIVE) == 0 || param.kind > HSP_ENUM) continue;
    live.push_back({{"id", param.id},
                    {"unit", host::textOf(param.unit)},
                    {"min", param.min},
                    {"max", param.max},
                    {"safety", (param.flags & HSP_P_SAFETY) != 0},
                    {"value", scene::numberIn(session.places[place].model.parameters, param.id, param.def)},
                    {"whole", param.kind != HSP_REAL},
                    {"doc", host::textOf(param.doc)}});
    if (param.kind == HSP_ENUM)
      for (uint32_t choice = 0; choice < param.choice_count; ++choice)
        live.back()["choices"].push_back(host::textOf(param.choices[choice]));
  }
  return live;
}

/// Returns the pose of a model: of a moving model from its newest row, otherwise the pose in which it rests.
Json poseJson(const Session& session, uint32_t place) {
  PoseRow row;
  if (session.runner.telemetry().flight()->newestPose(place, row) && row.tick >= session.places[place].since)
    return {{"position", row.position}, {"orientation", row.orientation}};
  return jsonOf(session.places[place].model.pose);
}

/// Lists the programs that push on an arm, with the counts of their answers.
Json pushersJson(const Session& session, uint32_t index) {
  Json list = Json::array();
  for (const Leads::Pusher& pusher : session.leads.pushers(index)) {
    const auto& client = session.runner.arms()[index]->clients().clients()[pusher.place];
    const record::ClientReport report = reportOf(client, pusher, "");
    list.push_back({{"pid", pusher.pid},
                    {"place", pusher.place},
                    {"answers", report.answers},
                    {"same_tick", report.sameTick()},
                    {"silences", report.silences},
                    {"program", report.program},
                    {"next_tick", report.nextTick()},
                    {"force_n", client.felt.load(std::memory_order_relaxed)},
                    {"largest_n", report.largest_n},
                    {"asked_n", report.asked_n},
                    {"bounded", report.bounded},
                    {"refused", report.refused},
                    {"why", report.why.empty() ? Json() : Json(report.why)}});
  }
  return list;
}

status::ModelStatus nowOf(const Session& session, uint32_t place) {
  const status::Page& page = session.runner.telemetry().statusWriter()->page();
  return place < status::kMaxModels ? page.model[place].now.read().value_or(status::ModelStatus{})
                                    : status::ModelStatus{};
}

/// Returns at which end of its range a joint stands, or null.
Json endJson(uint32_t at_end) {
  return at_end == 0 ? Json() : Json(status::nameOfEnd(at_end));
}

Json modelJson(const Session& session, uint32_t place) {
  const ModelPlace& taken = session.places[place];
  const auto leader = session.leads.leader(Order::Led::kModel, place);
  const std::string why = silencedWhy(session, place);
  const bool deforms = (session.runner.world().shapes()[place]->description().flags & HSP_C_DEFORMS) != 0;
  return {{"name", taken.model.name},
          {"number", place},
          {"since", taken.since},
          {"plugin", taken.model.plugin},
          {"enabled", taken.enabled},
          {"kinematic", taken.model.kinematic},
          {"leader", leader ? Json(*leader) : Json()},
          {"pose", poseJson(session, place)},
          {"silenced", why.empty() ? Json() : Json(why)},
          {"deforms", deforms},
          {"tip_radius", scene::numberIn(taken.model.parameters, "tip_radius", 0)},
          {"waits", waitsForTip(session, place)},
          {"end", endJson(nowOf(session, place).at_end)}};
}

Json silencedJson(const Session& session) {
  Json models = Json::array();
  for (uint32_t i = 0; i < session.places.size(); ++i)
    if (const std::string why = session.places[i].taken ? silencedWhy(session, i) : ""; !why.empty())
      models.push_back({{"model", session.places[i].model.name}, {"why", why}});
  return models;
}

}  // namespace

std::string lineOf(const Json& json) {
  return document::jsonLine(json);
}

Json jsonOf(const scene::Pose& pose) {
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Quaterniond& q = pose.orientation;
  return {{"position", {p.x(), p.y(), p.z()}}, {"orientation", {q.w(), q.x(), q.y(), q.z()}}};
}

record::ClientReport reportOf(const ClientForces::Client& client, const Leads::Pusher& pusher,
                              const std::string& device) {
  const auto read = [](const auto& value) { return value.load(std::memory_order_relaxed); };
  record::ClientReport report;
  report.device = device;
  report.program = pusher.program;
  report.pid = pusher.pid;
  report.answers = read(client.answers);
  report.in_time = read(client.in_time);
  report.next_tick = read(client.next_tick);
  report.silences = read(client.silences);
  report.largest_n = read(client.largest);
  report.asked_n = read(client.asked);
  report.bounded = read(client.bounded);
  report.refused = read(client.refused);
  report.why = describe(read(client.why));
  return report;
}

bool waitsForTip(const Session& session, uint32_t place) {
  return nowOf(session, place).waits != 0;
}

std::string silencedWhy(const Session& session, uint32_t place) {
  const status::ModelStatus now = nowOf(session, place);
  const scene::Model& model = session.places[place].model;
  return silenceReason(model.name, model.library.string(), static_cast<ShapeFault>(now.trouble), now.failed_status);
}

std::string statusAnswer(const Session& session, const std::string& name, const std::string& socket) {
  const status::Page& page = session.runner.telemetry().statusWriter()->page();
  const auto now = page.now.read().value_or(status::TickStatus{});
  Json devices = Json::array();
  for (size_t i = 0; i < session.runner.arms().size(); ++i) {
    const auto arm = page.arm[i].now.read().value_or(status::ArmStatus{});
    const auto fault = static_cast<Fault>(arm.fault);
    const std::string why = noForceWhy(session, static_cast<uint32_t>(i));
    const std::string& slow = session.runner.arms()[i]->slowness();
    devices.push_back({{"name", session.runner.scene().devices[i].name},
                       {"fault", fault == Fault::kNone ? Json() : Json(describe(fault))},
                       {"no_force", why.empty() ? Json() : Json(why)},
                       {"less_force", slow.empty() ? Json() : Json(slow)},
                       {"force_n", {arm.force[0], arm.force[1], arm.force[2]}},
                       {"position_m", {arm.position[0], arm.position[1], arm.position[2]}}});
    if (session.runner.arms()[i]->clients().possible() && session.leads.mayPush())
      devices.back()["clients"] = pushersJson(session, static_cast<uint32_t>(i));
  }
  return lineOf({{"ok", true},
                 {"name", name},
                 {"socket", socket},
                 {"scene", session.scene_file},
                 {"seconds", now.t},
                 {"tick", now.tick},
                 {"rate_hz", page.rate},
                 {"missed_ticks", now.missed},
                 {"ends", session.runner.loop().ends()},
                 {"lateness_us", {{"p50", page.lateness_us.quantile(0.5)}, {"p99", page.lateness_us.quantile(0.99)}}},
                 {"devices", devices},
                 {"silenced", silencedJson(session)}});
}

std::string listAnswer(const Session& session) {
  Json models = Json::array();
  for (uint32_t i = 0; i < session.places.size(); ++i) {
    if (!session.places[i].taken) continue;
    models.push_back(modelJson(session, i));
    models.back()["live_parameters"] = liveParameters(session, i);
  }
  return lineOf({{"ok", true}, {"models", models}});
}

std::string snapshotAnswer(const Session& session) {
  const record::FlightRing& ring = session.runner.telemetry().flight()->ring();
  const auto mode = session.leads.mayPush() ? session.runner.scene().clients.mode : scene::ClientMode::kOff;
  Json next = Json::object(), models = Json::array(), devices = Json::array();
  // Read before the poses, so that a reader that starts at these rows misses no motion of the models listed here.
  for (size_t i = 0; i < ring.specs().size(); ++i) next[ring.specs()[i].name] = ring.written(i);
  for (uint32_t i = 0; i < session.places.size(); ++i)
    if (session.places[i].taken) models.push_back(modelJson(session, i));
  for (uint32_t i = 0; i < session.runner.arms().size(); ++i) {
    const Arm& arm = *session.runner.arms()[i];
    const auto leader = session.leads.leader(Order::Led::kHand, i);
    devices.push_back({{"name", session.runner.scene().devices[i].name},
                       {"number", i},
                       {"module", session.runner.scene().devices[i].module},
                       {"joints", arm.info().joint_count},
                       {"buttons", arm.info().buttons},
                       {"simulated", arm.simulated()},
                       {"guided", arm.hand().guided()},
                       {"clients", kClientModes[static_cast<size_t>(mode)]},
                       {"leader", leader ? Json(*leader) : Json()}});
  }
  return lineOf(
      {{"ok", true}, {"scene", session.scene_file}, {"next", next}, {"models", models}, {"devices", devices}});
}

std::string noSuchParameter(const hsp_class& plugin, const std::string& parameter, uint32_t flags) {
  std::vector<std::string> names, others;
  for (uint32_t i = 0; i < plugin.param_count; ++i)
    ((host::paramAt(plugin, i).flags & flags) == flags ? names : others).emplace_back(host::paramAt(plugin, i).id);
  const std::string word = parameter.substr(0, 100);
  const std::string meant = document::suggestionOfName(word, names),
                    other = meant.empty() ? document::suggestionOfName(word, others) : "";
  return "parameter \"" + word + "\" of " + plugin.name + ": there is no " +
         ((flags & HSP_P_LIVE) != 0 ? "live " : "") + "parameter of that name, expected one of " +
         document::listedFor(word, names) + meant + other +
         (other.empty() ? "" : "\n  fix: parameters that are not live change in the scene, then: hapticd ctl reload");
}

std::string noSuchDevice(const scene::Scene& scene, const std::string& device) {
  std::vector<std::string> names;
  for (const scene::Device& one : scene.devices) names.push_back(one.name);
  const std::string wanted = device.substr(0, 100);
  return "there is no device \"" + wanted + "\", expected one of: " + document::listedFor(wanted, names) +
         document::suggestionOfName(wanted, names);
}

Result<std::string> valuesAnswer(const Session& session, uint32_t place, const std::string& parameter) {
  const hsp_class& plugin = session.runner.world().shapes()[place]->description();
  const scene::Model& model = session.places[place].model;
  Json values = Json::object();
  for (uint32_t i = 0; i < plugin.param_count; ++i) {
    const hsp_param& param = host::paramAt(plugin, i);
    if (parameter == param.id)
      return lineOf({{"ok", true}, {"value", valueJson(model, param)}, {"unit", host::textOf(param.unit)}});
    values[param.id] = valueJson(model, param);
  }
  if (parameter.empty()) return lineOf({{"ok", true}, {"values", values}});
  return Error{noSuchParameter(plugin, parameter, 0)};
}

std::string noForceWhy(const Session& session, uint32_t index) {
  const Arm& arm = *session.runner.arms()[index];
  const std::string& device = session.runner.scene().devices[index].name;
  const Fault fault = arm.limiter().fault();
  const std::string clear = "\n  fix: hapticd ctl clear, once the person who holds the arm agrees";
  if (fault == Fault::kStopped && session.runner.loop().ends())
    return "device " + device + ": the run ends, so its forces ramp to zero";
  if (fault == Fault::kStopped)
    return "device " + device + ": the arm is held; its forces ended and stay off until the hold is cleared" + clear;
  if (fault != Fault::kNone)
    return faultMessage(device, fault, arm.limiter().measured(), arm.troubleOf(fault),
                        session.runner.scene().devices[index].file.string()) +
           (endsByItself(fault) ? "" : clear);
  if (!arm.foundPressed()) return "";
  return "device " + device +
         ": the button of limits.enable was down when the run began, so it does not enable forces\n  fix: release "
         "it, then press it";
}

namespace {

/// Adds the program that pushes or pushed on an arm and had the most refused answers.
void addRefused(const Session& session, uint32_t arm, Json& json) {
  uint64_t most = 0;
  for (const Leads::Pusher& pusher : session.leads.pushers(arm)) {
    const auto& client = session.runner.arms()[arm]->clients().clients()[pusher.place];
    const uint64_t refused = client.refused.load(std::memory_order_relaxed);
    if (refused <= most) continue;
    most = refused;
    json["pid"] = pusher.pid;
    json["program"] = pusher.program;
    json["why"] = describe(client.why.load(std::memory_order_relaxed));
  }
}

/// For an event of a lead: adds the program, and whether it leads or pushes.
void addProgram(const Session& session, const hapticd_event& event, Json& json) {
  const bool push = event.model < 0 && event.code == static_cast<uint32_t>(Order::Led::kForce);
  if (event.kind == HAPTICD_REFUSED && push) return addRefused(session, static_cast<uint32_t>(event.probe), json);
  if (event.kind != HAPTICD_JOINED && event.kind != HAPTICD_LOST) return;
  const auto pid = static_cast<pid_t>(event.value);
  json["pid"] = pid;
  json["program"] = session.leads.program(pid);
  json["does"] = push ? "pushes" : "leads";
}

}  // namespace

std::string eventText(const Session& session, const hapticd_event& event) {
  Json json = {{"event", nameOfEvent(event.kind)}, {"tick", event.tick}, {"t", event.t}};
  const auto arm = static_cast<size_t>(event.probe);
  if (event.model >= 0) json["number"] = event.model;
  const auto [model, library] = session.runner.names().of(event);
  if (!model.empty()) json["model"] = model;
  if (event.probe >= 0 && arm < session.runner.scene().devices.size())
    json["device"] = session.runner.scene().devices[arm].name;
  json["code"] = event.code;
  json["value"] = event.value;
  if (*directionOfClick(event) != 0) json["snapped"] = directionOfClick(event);
  if (*endOf(event) != 0) json["end"] = endOf(event);
  if (MarkRow mark; event.kind == HAPTICD_MARK && session.runner.telemetry().flight()->mark(event.code, mark))
    json["text"] = mark.text;
  if (event.kind == HAPTICD_FAULT) json["why"] = describe(static_cast<Fault>(event.code));
  if (event.probe < 0 || arm < session.runner.arms().size()) addProgram(session, event, json);
  if (event.kind == HAPTICD_REFUSED && *whyRefused(event) != 0) json["why"] = whyRefused(event);
  if (event.kind == HAPTICD_SILENCED) json["why"] = silenceReason(event, model, model.empty() ? "FILE.so" : library);
  return lineOf(json);
}

}  // namespace hapticd::servo
