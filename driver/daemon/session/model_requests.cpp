// SPDX-License-Identifier: MIT
/// Models that come and go while the daemon runs.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "session/foreign_files.hpp"
#include "session/patience.hpp"
#include "session/request_handler.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::servo {

namespace {

using control::Request;

std::string addedText(size_t models) {
  return nlohmann::ordered_json({{"ok", true}, {"models", models}}).dump();
}

bool sameDevices(const scene::Scene& a, const scene::Scene& b) {
  if (a.devices.size() != b.devices.size()) return false;
  for (size_t i = 0; i < a.devices.size(); ++i)
    if (a.devices[i].module != b.devices[i].module || a.devices[i].file != b.devices[i].file) return false;
  return true;
}

}  // namespace

/// What is wrong with a scene quotes it, so a program of another user hears of that only if it may read the files too.
Result<scene::Scene> RequestHandler::loadFor(const control::Peer& peer, const std::string& file) {
  const bool foreign = isForeign(peer) && file != scene_file_;
  if (foreign)
    if (auto open = readableByAll({file}); !open) return refuse("forbidden", open.error());
  auto scene = load_(file);
  if (!foreign) return scene;
  if (!scene) return refuse("failed", file + ": cannot be used\n  fix: hapticd check tells why");
  std::vector<std::string> files = filesOf(scene->models);
  files.push_back(file);
  if (auto open = readableByAll(files); !open) return refuse("forbidden", open.error());
  return scene;
}

Result<std::string> RequestHandler::add(const control::Peer& peer, const Request& request) {
  auto scene = loadFor(peer, request.file);
  if (!scene) return Error{scene.error()};
  std::vector<scene::Model> models;
  for (const scene::Model& model : scene->models)
    if (request.model.empty() || model.name == request.model) models.push_back(model);
  if (models.empty()) return Error{request.file + ": has no model" + (request.model.empty() ? "" : " of that name")};
  for (const scene::Model& model : models)
    if (placeOf(model.name)) return refuse("busy", "a model named \"" + model.name + "\" exists already");
  if (auto done = adopt(models); !done) return Error{done.error()};
  return addedText(models.size());
}

/// A plugin that ended a run is kept out of this one too.
Result<void> RequestHandler::refuseQuarantined(const std::vector<scene::Model>& models) const {
  if (runner_.stateDir().empty()) return {};
  for (const watch::QuarantinedPlugin& entry : watch::quarantined(runner_.stateDir()))
    for (const scene::Model& model : models)
      if (model.plugin == entry.plugin)
        return refuse("quarantined", "model \"" + model.name + "\": plugin '" + entry.plugin +
                                         "' ended an earlier run by " + entry.reason +
                                         "\n  fix: repair it, then: hapticd plugin clear " + entry.plugin);
  return {};
}

/// All of them or none: everything that can fail is done before the first is given to the servo.
Result<void> RequestHandler::adopt(const std::vector<scene::Model>& models) {
  code_ = "failed";  // that no model of these names was found is as it should be
  std::vector<uint32_t> empty;
  for (uint32_t i = 0; i < places_.size(); ++i)
    if (!places_[i].taken && runner_.world().shapes()[i] == nullptr) empty.push_back(i);
  if (empty.size() < models.size())
    return refuse("too_many", fmt::format("{} more models can be added, not {}", empty.size(), models.size()));
  if (auto trusted = refuseQuarantined(models); !trusted) return trusted;
  std::vector<std::unique_ptr<host::ShapeInstance>> shapes;
  for (const scene::Model& model : models) {
    auto shape = runner_.world().prepare(model, log_);
    if (!shape) return Error{shape.error()};
    shapes.push_back(std::move(*shape));
  }
  for (size_t i = 0; i < models.size(); ++i) {
    const uint32_t place = empty[i];
    prepared_.push_back(std::make_unique<ModelState>(Core::stateOf(*shapes[i], models[i])));
    runner_.nameModel(place, models[i].name, models[i].plugin);
    Order order;
    order.kind = Order::Kind::kAdopt;
    order.target = place;
    order.model = prepared_.back().get();
    const auto given = give(order);
    places_[place] = {models[i], true, true};
    runner_.world().keep(place, std::move(shapes[i]), models[i]);  // also where it was late: it may obey yet
    if (!given) return given;
    prepared_.pop_back();
  }
  return {};
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
  if (auto given = give(order); !given) return given;
  waitUntil([&] {
    sweep();
    return runner_.world().shapes()[place] == nullptr;
  });
  return {};
}

Result<std::string> RequestHandler::reload(const control::Peer& peer, const std::string& file) {
  auto scene = loadFor(peer, file);
  if (!scene) return Error{scene.error()};
  if (!sameDevices(*scene, runner_.scene()))
    return Error{file +
                 ": names other devices than the running ones\n  fix: stop the daemon and start it with this scene"};
  std::vector<uint32_t> old;
  for (uint32_t i = 0; i < places_.size(); ++i)
    if (places_[i].taken) old.push_back(i);
  if (auto done = adopt(scene->models); !done) return Error{file + ": nothing was changed: " + done.error()};
  for (const uint32_t place : old)
    if (auto done = release(place); !done) return Error{done.error()};
  scene_file_ = file;
  return addedText(scene->models.size());
}

void RequestHandler::sweep() {
  uint32_t place = 0;
  while (runner_.world().core().takeReleased(place)) {
    runner_.world().destroy(place);
    runner_.nameModel(place, "", "");
  }
}

}  // namespace hapticd::servo
