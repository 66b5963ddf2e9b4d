// SPDX-License-Identifier: MIT
#include "session/request_handler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "document/suggestion.hpp"
#include "host/class_table.hpp"
#include "record/dump_folder.hpp"
#include "session/foreign_files.hpp"
#include "session/geometry_answer.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::servo {

namespace {

using Json = nlohmann::ordered_json;
using control::Request;

constexpr Nanoseconds kPause = 1'000'000;
constexpr Nanoseconds kPatience = 2'000'000'000;  ///< for the servo to obey

std::string text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// True once `done` is, false after a while.
template <class Done>
bool waitUntil(Done&& done) {
  RealClock clock(0);
  for (const Nanoseconds end = clock.now() + kPatience; clock.now() < end; clock.waitUntil(clock.now() + kPause))
    if (done()) return true;
  return done();
}

/// The parameter of a class by its id; nullptr if there is none.
const hsp_param* parameterOf(const hsp_class& plugin, const std::string& id, uint32_t& index) {
  for (index = 0; index < plugin.param_count; ++index) {
    const hsp_param* param = HSP_AT(const hsp_param, plugin.params, plugin.params[0].struct_size, index);
    if (id == param->id) return param;
  }
  return nullptr;
}

bool sameDevices(const scene::Scene& a, const scene::Scene& b) {
  if (a.devices.size() != b.devices.size()) return false;
  for (size_t i = 0; i < a.devices.size(); ++i)
    if (a.devices[i].module != b.devices[i].module || a.devices[i].file != b.devices[i].file) return false;
  return true;
}

}  // namespace

RequestHandler::RequestHandler(Runner& runner, LoadScene load, host::Services::Log log, std::string dump_folder)
    : runner_(runner),
      load_(std::move(load)),
      log_(std::move(log)),
      dump_folder_(std::move(dump_folder)),
      scene_file_(std::filesystem::absolute(runner.scene().file).string()),
      places_(runner.world().places()),
      leads_([this](const Order& order) { return give(order); }, runner.scene().clients.exclusive) {
  for (size_t i = 0; i < runner.scene().models.size(); ++i) places_[i] = {runner.scene().models[i], true, true};
}

control::Reply RequestHandler::answer(const control::Peer& peer, const std::string& line) {
  std::string id;
  const auto request = control::parseRequest(line, &id);
  if (!request) return control::withId(control::refusal(request.error()), id);
  try {
    sweep();
    attached_ = Descriptor();
    code_ = "failed";
    const auto done = obey(peer, *request);
    if (!done) return control::withId(control::refusal(done.error(), code_), id);
    return {control::withId(*done, id), std::move(attached_)};
  } catch (const std::exception& error) {
    return control::withId(control::refusal(std::string("it failed: ") + error.what(), "failed"), id);
  }
}

Result<std::string> RequestHandler::tell(const control::Peer& peer, const Request& request) {
  switch (request.kind) {
    case Request::Kind::kStatus:
      return statusAnswer(session());
    case Request::Kind::kList:
      return listAnswer(session());
    case Request::Kind::kSnapshot:
      return snapshotAnswer(session());
    case Request::Kind::kEvents:
      return eventsAfter(request.after);
    case Request::Kind::kSubscribe:
      return subscribe(peer);
    case Request::Kind::kGet: {
      const auto place = placeOf(request.model);
      if (!place) return Error{place.error()};
      return valuesAnswer(session(), *place, request.parameter);
    }
    case Request::Kind::kGeometry: {
      const auto place = placeOf(request.model);
      if (!place) return Error{place.error()};
      const host::ShapeInstance& shape = *runner_.world().shapes()[*place];
      return request.as_memory ? geometryInMemory(shape, request.tolerance, attached_)
                               : geometryAnswer(shape, request.tolerance);
    }
    case Request::Kind::kVertices: {
      const auto place = placeOf(request.model);
      if (!place) return Error{place.error()};
      return verticesAnswer(*runner_.world().shapes()[*place], request.after);
    }
    default:
      return Error{"this request asks for nothing"};
  }
}

Result<std::string> RequestHandler::obey(const control::Peer& peer, const Request& request) {
  const std::string good = text({{"ok", true}});
  const auto plain = [&](Result<void> done) -> Result<std::string> {
    if (!done) return Error{done.error()};
    return good;
  };
  switch (request.kind) {
    case Request::Kind::kStatus:
    case Request::Kind::kList:
    case Request::Kind::kSnapshot:
    case Request::Kind::kEvents:
    case Request::Kind::kSubscribe:
    case Request::Kind::kGet:
    case Request::Kind::kGeometry:
    case Request::Kind::kVertices:
      return tell(peer, request);
    case Request::Kind::kEnable:
      return plain(able(request.model, true));
    case Request::Kind::kDisable:
      return plain(able(request.model, false));
    case Request::Kind::kMove:
      return move(request);
    case Request::Kind::kSet:
      return plain(set(request));
    case Request::Kind::kAdd:
      return add(peer, request);
    case Request::Kind::kRemove: {
      const auto place = placeOf(request.model);
      return plain(place ? release(*place) : Result<void>(Error{place.error()}));
    }
    case Request::Kind::kReload:
      return reload(peer, request.file.empty() ? scene_file_ : request.file);
    case Request::Kind::kHold:
      return hold(request.device, code_);
    case Request::Kind::kClear:
      return plain(clear(peer, request.device));
    case Request::Kind::kDump: {
      auto file = dump("asked for");
      if (!file) return Error{file.error()};
      return text({{"ok", true}, {"file", *file}});
    }
    case Request::Kind::kLead:
      return lead(peer, request);
    case Request::Kind::kUnlead:
      return plain(unlead(peer, request));
    case Request::Kind::kState:
      return state();
    case Request::Kind::kBell:
      return bell();
    case Request::Kind::kStop:
      runner_.stop();
      return good;
  }
  return Error{"unknown request"};
}

Result<uint32_t> RequestHandler::placeOf(const std::string& model) const {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < places_.size(); ++i) {
    if (places_[i].taken && places_[i].model.name == model) return i;
    if (places_[i].taken) names.push_back(places_[i].model.name);
  }
  return refuse("unknown", "there is no model \"" + model.substr(0, 100) + "\"" +
                               document::suggestion(model.substr(0, 100), names));
}

Result<void> RequestHandler::give(const Order& order) {
  if (!runner_.giveOrder(order)) return refuse("busy", "too many orders are waiting; the servo may have stopped");
  ++given_;
  if (!waitUntil([&] { return runner_.loop().ordersDone() >= given_; }))
    return refuse("timeout", "the servo did not carry out the order within 2 s; it may have stopped: see status");
  return {};
}

Result<void> RequestHandler::able(const std::string& model, bool enabled) {
  const auto place = placeOf(model);
  if (!place) return Error{place.error()};
  if (const std::string why = enabled ? silencedWhy(session(), *place) : ""; !why.empty())
    return refuse("silenced", why + "; it stays so until it is loaded anew: hapticd ctl reload, or remove and add");
  Order order;
  order.kind = enabled ? Order::Kind::kEnable : Order::Kind::kDisable;
  order.target = *place;
  places_[*place].enabled = enabled;
  return give(order);
}

/// What `get` and `list` answer from now on.
void RequestHandler::remember(scene::Model& model, const hsp_param& param, const Order& order) {
  auto found = std::find_if(model.parameters.begin(), model.parameters.end(),
                            [&](const scene::Value& value) { return value.index == order.param; });
  if (found == model.parameters.end()) {
    scene::Value value;
    value.id = param.id;
    value.index = order.param;
    value.kind = param.kind;
    found = model.parameters.insert(found, value);
  }
  found->number = order.value;
}

Result<void> RequestHandler::set(const Request& request) {
  const auto place = placeOf(request.model);
  if (!place) return Error{place.error()};
  const hsp_class& plugin = runner_.world().shapes()[*place]->description();
  Order order;
  order.kind = Order::Kind::kSet;
  order.target = *place;
  order.value = request.value;
  const hsp_param* param = parameterOf(plugin, request.parameter, order.param);
  const std::string what = "parameter \"" + request.parameter.substr(0, 100) + "\" of " + plugin.name;
  if (param == nullptr) return refuse("unknown", what + ": there is no live parameter of that name; see list");
  if ((param->flags & HSP_P_LIVE) == 0)
    return refuse("unsupported", what + ": cannot change while the model runs\n  fix: change the scene and reload it");
  const bool whole = param->kind == HSP_REAL || std::floor(request.value) == request.value;
  if (!(request.value >= param->min && request.value <= param->max) || !whole)
    return refuse("out_of_range", fmt::format("{}: {:g} is out of range, expected {:g} to {:g} {}", what, request.value,
                                              param->min, param->max, host::textOf(param->unit)));
  if ((param->flags & HSP_P_SAFETY) != 0 && !request.consent)
    return refuse("consent", what +
                                 ": a hand may feel this change suddenly, so the person who holds the arm must agree\n "
                                 " fix: add \"consent\": true, or hapticd ctl set --consent");
  auto given = give(order);
  if (given) remember(places_[*place].model, *param, order);
  return given;
}

/// Only the servo knows where the model is when it obeys, so the bounds of speed are its own: the answer says what came
/// of the seconds that were asked for.
Result<std::string> RequestHandler::move(const Request& request) {
  const auto place = placeOf(request.model);
  if (!place) return Error{place.error()};
  const scene::Model& model = places_[*place].model;
  if (!model.kinematic)
    return refuse("unsupported", "model \"" + model.name + "\" is not kinematic, expected a kinematic model");
  if (const auto leader = leads_.leader(Order::Led::kModel, *place))
    return refuse("busy", "model \"" + model.name + "\" is led by process " + std::to_string(*leader));
  Order order;
  order.kind = Order::Kind::kMove;
  order.target = *place;
  std::copy(request.position.begin(), request.position.end(), order.position);
  std::fill_n(order.orientation, 4, 0.0);
  if (request.turns) std::copy_n(request.orientation.data(), 4, order.orientation);
  order.seconds = request.seconds.value_or(0);
  if (auto given = give(order); !given) return Error{given.error()};
  // Obeyed, and nobody but this thread gives orders: the servo has no reason to change it.
  return text({{"ok", true}, {"seconds", runner_.world().core().models()[*place].glide.seconds()}});
}

/// A hold that came while this waited for its turn is the newer wish.
Result<void> RequestHandler::clear(const control::Peer& peer, const std::string& device) {
  if (peer.asked != 0 && peer.asked < held_at_.load())
    return refuse("held", "a hold came after this request\n  fix: ask again if the force shall come back");
  const auto& devices = runner_.scene().devices;
  bool found = false;
  for (uint32_t i = 0; i < devices.size(); ++i) {
    if (!device.empty() && devices[i].name != device) continue;
    found = true;
    Order order;
    order.kind = Order::Kind::kClear;
    order.target = i;
    if (auto given = give(order); !given) return given;
  }
  return found ? Result<void>() : refuse("unknown", "there is no device \"" + device.substr(0, 100) + "\"");
}

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
  return text({{"ok", true}, {"models", models.size()}});
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
  return text({{"ok", true}, {"models", scene->models.size()}});
}

void RequestHandler::sweep() {
  uint32_t place = 0;
  while (runner_.world().core().takeReleased(place)) {
    runner_.world().destroy(place);
    runner_.nameModel(place, "", "");
  }
}

Result<std::string> RequestHandler::dump(const std::string& why) {
  const std::string file =
      record::nextDump(dump_folder_, std::chrono::system_clock::to_time_t(std::chrono::system_clock::now()));
  if (auto done = runner_.telemetry().flight()->ring().dump(file); !done) return Error{done.error()};
  log_(HSP_LOG_INFO, "black box", file + " (" + why + ")");
  return file;
}

}  // namespace hapticd::servo
