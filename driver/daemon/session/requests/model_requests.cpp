// SPDX-License-Identifier: MIT
/// Requests that add, remove and reload models while the daemon runs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "document/suggestion.hpp"
#include "host/catalog.hpp"
#include "host/file_stamp.hpp"
#include "host/replaced_library.hpp"
#include "scene/load.hpp"
#include "session/messages/setup_watch.hpp"
#include "session/replay/model_description.hpp"
#include "session/requests/foreign_files.hpp"
#include "session/requests/kept_settings.hpp"
#include "session/requests/request_handler.hpp"
#include "session/requests/wait_until.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::servo {

namespace {

using control::Request;

/// [bytes] A description of a model has at most kMostMarks rows of this size in the stream `marks`.
constexpr size_t kMarkBytes = Order::kTextBytes - 1, kMostMarks = 960;

/// Adds `notes` to the answer: which added models may not be what the user expects, because their plugin's file has
/// changed since it was loaded.
void addReplaced(nlohmann::ordered_json& json, const std::vector<scene::Model>& models,
                 const host::Services::Log& log) {
  std::set<std::string> told;
  for (const scene::Model& model : models) {
    if (!host::replacedSinceLoaded(model.library) || !told.insert(model.library.string()).second) continue;
    const std::string text = "the file of plugin '" + model.plugin +
                             "' has changed since this daemon loaded it: this run goes on with the old code, because a "
                             "library is never unloaded\n  fix: end the daemon and start it again";
    json["notes"].push_back(text);
    log(HSP_LOG_WARNING, model.name, text);
  }
}

bool sameDevices(const scene::Scene& a, const scene::Scene& b) {
  if (a.devices.size() != b.devices.size()) return false;
  for (size_t i = 0; i < a.devices.size(); ++i)
    if (a.devices[i].module != b.devices[i].module || a.devices[i].file != b.devices[i].file) return false;
  return true;
}

}  // namespace

/// Loads the scene of a request with the rights of the caller: only for the daemon's own user and for root, files are
/// opened by name; other programs must send open files.
Result<scene::Scene> RequestHandler::loadFor(const control::Peer& peer, const Request& request) {
  passed_.reset();
  if (!request.files.empty() || !given_files_.empty()) {
    auto copies = PassedFiles::copy(request.files, std::exchange(given_files_, {}));
    if (!copies) return refuse("bad_request", copies.error());
    passed_ = std::move(*copies);
    return loadPassed(peer, request.file.empty() ? scene_file_ : request.file);
  }
  if (request.file.empty()) return loadOwn(peer);
  if (!isForeign(peer)) return load_(request.file);
  return refuse(
      "forbidden",
      request.file +
          ": the daemon runs as another user and does not open files for this program; the program must send the "
          "scene and the files that it names as open files\n  fix: use hapticd ctl, which does this, or see "
          "\"files\" in driver/docs/control.md");
}

/// Reads the daemon's own scene again. Its content is not shown to other users.
Result<scene::Scene> RequestHandler::loadOwn(const control::Peer& peer) {
  if (!isForeign(peer)) return load_(scene_file_);
  if (scene_passed_)
    return refuse(
        "forbidden",
        scene_file_ +
            ": a program sent this scene, so only a program can load it again\n  fix: hapticd ctl reload FILE");
  auto scene = load_(scene_file_);
  if (!scene) return refuse("failed", tellable(peer, scene.error()));
  return scene;
}

/// Loads a scene that a program sent. The daemon may read the files of its own arms for it, because the scene must name
/// these arms, but shows nothing of their content. A scene that names no arm has the default one, which ships.
Result<scene::Scene> RequestHandler::loadPassed(const control::Peer& peer, const std::string& file) {
  if (!passed_) return Error{"the request came without open files, expected those of \"files\""};
  std::vector<std::string> own;
  if (const auto usual = host::shippedFile(scene::kDefaultDevice)) own.push_back(usual->string());
  for (const scene::Device& device : runner_.scene().devices) {
    own.push_back(device.file.string());
    for (const scene::Value& value : device.parameters)
      if (value.kind == HSP_PATH && !value.text.empty()) own.push_back(value.text);
  }
  for (const std::string& name : own) passed_->allow(name);
  const PassedFiles::Scope scope(*passed_);
  auto scene = load_(file);
  if (scene) return scene;
  for (const std::string& name : own)
    if (isForeign(peer) && passed_->pathOf(name) == name && scene.error().find(name) != std::string::npos)
      return refuse("failed", name + ": the daemon cannot use this file of its own with the scene that was sent");
  return Error{passed_->named(scene.error())};
}

/// Returns an error that this peer may see: another user does not get quotes from the daemon's own scene.
std::string RequestHandler::tellable(const control::Peer& peer, const std::string& why) const {
  if (passed_) return passed_->named(why);
  return isForeign(peer)
             ? scene_file_ +
                   ": the scene has problems, which only the daemon's user may see\n  fix: ask that user to "
                   "test it with hapticd check"
             : why;
}

Result<std::string> RequestHandler::add(const control::Peer& peer, const Request& request) {
  auto scene = loadFor(peer, request);
  if (!scene) return Error{scene.error()};
  std::vector<scene::Model> models;
  for (const scene::Model& model : scene->models)
    if (request.model.empty() || model.name == request.model) models.push_back(model);
  if (models.empty()) {
    std::vector<std::string> names;
    for (const scene::Model& model : scene->models) names.push_back(model.name);
    return refuse("unknown",
                  request.file + ": the scene has no model" +
                      (request.model.empty() ? std::string()
                                             : " \"" + request.model.substr(0, 100) + "\", expected one of " +
                                                   document::listedFor(request.model, names, 20)));
  }
  for (const scene::Model& model : models)
    if (placeOf(model.name))
      return refuse("busy", "a model named \"" + model.name +
                                "\" exists already\n  fix: remove it first, or rename one of the two");
  if (auto done = adopt(models); !done) return Error{tellable(peer, done.error())};
  auto json = cameAnswer(models);
  addReplaced(json, models, log_);
  addWarnings(peer, models, json);
  return lineOf(json);
}

/// Refuses models whose plugin is on the quarantine list, because it ended an earlier run.
Result<void> RequestHandler::refuseQuarantined(const std::vector<scene::Model>& models) const {
  if (runner_.stateDir().empty()) return {};
  for (const watch::QuarantinedPlugin& entry : watch::quarantined(runner_.stateDir()))
    for (const scene::Model& model : models)
      if (entry.holds(model.plugin, host::identityOnDisk(model.library)))
        return refuse("quarantined", "model \"" + model.name + "\": plugin '" + entry.plugin +
                                         "' ended an earlier run by " + entry.reason +
                                         "\n  fix: repair the plugin, then: hapticd plugin clear " + entry.plugin);
  return {};
}

/// Adds all these models or none: all steps that can fail come before the first model is given to the servo.
Result<void> RequestHandler::adopt(const std::vector<scene::Model>& models) {
  code_ = "failed";  // placeOf() has set another code, because these names were not found
  std::vector<uint32_t> empty;
  for (uint32_t i = 0; i < places_.size(); ++i)
    if (!places_[i].taken && runner_.world().shapes()[i] == nullptr) empty.push_back(i);
  if (empty.size() < models.size())
    return refuse(
        "too_many",
        fmt::format("the run has room for {} more models, but {} were given\n  fix: remove models first, or add fewer",
                    empty.size(), models.size()));
  if (auto trusted = refuseQuarantined(models); !trusted) return trusted;
  auto coming = prepare(models);
  if (!coming) return Error{coming.error()};
  for (size_t i = 0; i < models.size(); ++i) {
    const uint32_t place = empty[i];
    auto& shape = (*coming)[i].shape;
    if (auto told = describe(place, (*coming)[i].description); !told) return told;
    prepared_.push_back(std::make_unique<ModelState>(Core::stateOf(*shape, models[i])));
    runner_.nameModel(place, models[i].name, models[i].plugin, models[i].library.string());
    Order order;
    order.kind = Order::Kind::kAdopt;
    order.target = place;
    order.model = prepared_.back().get();
    const auto given = post(order);
    places_[place] = {models[i], true, models[i].enabled, tickNow()};
    // The shape is kept even if the servo did not obey in time, because the servo may obey later.
    runner_.world().store(place, std::move(shape), models[i]);
    if (!given) return given;
    prepared_.pop_back();
  }
  return {};
}

/// Builds these models and describes them, which may take long.
Result<std::vector<RequestHandler::Coming>> RequestHandler::prepare(const std::vector<scene::Model>& models) {
  std::vector<Coming> coming;
  host::Services::Log log = log_;
  if (passed_)  // the log names files as the program does
    log = [log = log_, named = passed_->naming()](int level, const std::string& who, const std::string& text) {
      log(level, who, named(text));
    };
  const SetupWatch waiting(log_, 5, "the other models are felt, but no request is answered until it returns");
  for (const scene::Model& model : models) {
    const scene::Model readable = passed_ ? withPaths(model, *passed_) : model;
    auto shape = runner_.world().prepare(readable, log);
    if (!shape) return Error{shape.error()};
    std::string description = describeModel(model, readable, (*shape)->description(), kMarkBytes * kMostMarks);
    coming.push_back({std::move(*shape), std::move(description)});
  }
  came_stiffness_.clear();
  for (const Coming& one : coming) came_stiffness_.push_back(one.shape->report().max_stiffness);
  return coming;
}

/// Writes into the stream `marks` what comes to this place, so that a recording names its models and joints, and a
/// replay can build the model. The text is cut into rows.
Result<void> RequestHandler::describe(uint32_t place, const std::string& text) {
  constexpr size_t kBytes = kMarkBytes, kAtOnce = 16;
  std::vector<Order> orders((text.size() + kBytes - 1) / kBytes);
  for (size_t i = 0; i < orders.size(); ++i) {
    orders[i].kind = Order::Kind::kMark;
    orders[i].target = place;
    orders[i].param = static_cast<uint32_t>(orders.size() - 1 - i);
    text.copy(orders[i].text, kBytes, i * kBytes);
  }
  for (size_t i = 0; i < orders.size(); i += kAtOnce)
    if (auto given = post(std::span(orders).subspan(i, std::min(kAtOnce, orders.size() - i))); !given) return given;
  return {};
}

/// Adds the warnings of `hapticd check` about the added models to the answer, as `warnings`, and to the log. A caller
/// of another user gets no warnings about the daemon's own scene.
void RequestHandler::addWarnings(const control::Peer& peer, const std::vector<scene::Model>& models,
                                 nlohmann::ordered_json& json) const {
  if (!advise_ || (isForeign(peer) && !passed_)) return;
  scene::Scene came;
  came.models = models;
  for (const std::string& text : advise_(came, came_stiffness_)) {
    json["warnings"].push_back(tellable(peer, text));
    log_(HSP_LOG_WARNING, "", text);
  }
}

uint64_t RequestHandler::tickNow() const {
  return runner_.telemetry().statusWriter()->page().now.read().value_or(status::TickStatus{}).tick;
}

/// Waits until the servo has run for this time [s], or has ended.
void RequestHandler::waitForServo(double seconds) const {
  const auto now = [&] {
    return runner_.telemetry().statusWriter()->page().now.read().value_or(status::TickStatus{}).t;
  };
  const double came = now();
  waitUntil([&] { return now() > came + seconds || runner_.loop().finished(); });
}

/// Lists which of these models wait for a tip to leave them. @param met [s] time in which the servo surely has stepped
/// the models once
nlohmann::ordered_json RequestHandler::waitingOf(const std::vector<scene::Model>& models, double met) const {
  nlohmann::ordered_json waiting = nlohmann::ordered_json::array();
  waitForServo(met);
  for (uint32_t i = 0; i < places_.size(); ++i) {
    const std::string& name = places_[i].model.name;
    const auto is = [&](const scene::Model& model) { return model.name == name; };
    if (!places_[i].taken || std::none_of(models.begin(), models.end(), is) || !waitsForTip(session(), i)) continue;
    waiting.push_back(name);
    log_(HSP_LOG_WARNING, name,
         "a tip is inside this model; the model gives no force until the tip has been outside for 50 ms");
  }
  return waiting;
}

nlohmann::ordered_json RequestHandler::cameAnswer(const std::vector<scene::Model>& models) {
  constexpr double kMet = 0.25;  // [s] the search finds a new model within about 0.1 s, and then the model is stepped
  nlohmann::ordered_json json = {{"ok", true}, {"models", models.size()}};
  if (auto waiting = waitingOf(models, kMet); !waiting.empty()) json["waiting"] = std::move(waiting);
  return json;
}

Result<void> RequestHandler::remove(const std::string& model) {
  const auto place = placeOf(model);
  if (!place) return Error{place.error()};
  return release(*place);
}

Result<void> RequestHandler::release(uint32_t place) {
  if (auto ended = leads_.endOfModel(place); !ended) return ended;
  runner_.world().forget(place);
  places_[place].taken = false;
  Order order;
  order.kind = Order::Kind::kRelease;
  order.target = place;
  if (auto given = post(order); !given) return given;
  waitUntil([&] {
    sweep();
    return runner_.world().shapes()[place] == nullptr;
  });
  return {};
}

Result<std::string> RequestHandler::reload(const control::Peer& peer, const Request& request) {
  const std::string file = request.file.empty() ? scene_file_ : request.file;
  auto scene = loadFor(peer, request);
  if (!scene) return Error{scene.error()};
  if (!sameDevices(*scene, runner_.scene()))
    return Error{
        file +
        ": its devices are not those of this run, and a reload cannot change devices\n  fix: stop the daemon and "
        "start it with this scene"};
  std::vector<uint32_t> old;
  for (uint32_t i = 0; i < places_.size(); ++i)
    if (places_[i].taken) old.push_back(i);
  if (auto done = adopt(scene->models); !done)
    return Error{file + ": nothing was changed: " + tellable(peer, done.error())};
  scene_file_ = file;
  scene_passed_ = passed_.has_value();
  takePermission(scene->clients);
  for (const uint32_t place : old)
    if (auto done = release(place); !done) return Error{done.error()};
  auto json = cameAnswer(scene->models);
  addReplaced(json, scene->models, log_);
  addWarnings(peer, scene->models, json);
  if (const auto kept = reportKeptSettings(*scene); !kept.empty()) json["kept"] = kept;
  return lineOf(json);
}

/// Takes or gives the permission to push from a reloaded scene. A scene that lets no program push ends all pushes, with
/// their ramp. A scene that allows pushes gives the permission back, but only if the scene at the start allowed pushes.
void RequestHandler::takePermission(const scene::Clients& wanted) {
  const bool may = wanted.mode != scene::ClientMode::kOff && wanted.push;
  const scene::Clients& given = runner_.scene().clients;
  if (given.mode == scene::ClientMode::kOff || !given.push) return;
  if (!may && leads_.mayPush())
    log_(HSP_LOG_WARNING, scene_file_, "programs may no longer push; their forces ramp out");
  leads_.setMayPush(may);
  if (!may) leads_.endPushes();
}

/// Returns, and logs, the settings of the scene that a reload cannot apply to the run.
std::vector<std::string> RequestHandler::reportKeptSettings(const scene::Scene& wanted) const {
  std::vector<std::string> kept = keptSettings(runner_.scene(), wanted);
  if (!leads_.mayPush()) std::erase(kept, "clients.mode"), std::erase(kept, "clients.push");
  if (!kept.empty())
    log_(HSP_LOG_WARNING, scene_file_,
         fmt::format(
             "a reload cannot change {}; the old value stays\n  fix: stop the daemon and start it with this scene",
             fmt::join(kept, ", ")));
  return kept;
}

void RequestHandler::sweep() {
  uint32_t place = 0;
  while (runner_.world().core().takeReleased(place)) {
    runner_.world().destroy(place);
    runner_.nameModel(place, "", "", "");
  }
}

}  // namespace hapticd::servo
