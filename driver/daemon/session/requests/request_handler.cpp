// SPDX-License-Identifier: MIT
#include "session/requests/request_handler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "document/suggestion.hpp"
#include "host/class_params.hpp"
#include "host/class_table.hpp"
#include "record/dump_folder.hpp"
#include "session/requests/foreign_files.hpp"
#include "session/requests/geometry_answer.hpp"
#include "session/requests/wait_until.hpp"

namespace hapticd::servo {

namespace {

using Json = nlohmann::ordered_json;
using control::Request;

/// Returns the allowed values, such as "a number from 0 to 3000 N/m", or the words of a choice.
std::string expectedOf(const hsp_param& param) {
  if (param.kind == HSP_BOOL) return "true or false";
  const std::string unit = host::textOf(param.unit);
  if (param.kind != HSP_ENUM)
    return fmt::format("a {}number from {:g} to {:g}{}{}", param.kind == HSP_INT ? "whole " : "", param.min, param.max,
                       unit.empty() ? "" : " ", unit);
  std::vector<std::string> words;
  for (uint32_t i = 0; i < param.choice_count; ++i) words.push_back(host::textOf(param.choices[i]));
  return "one of " + document::listed(words, 40);
}

/// Returns the number that a word of a choice or switch stands for, such as 1 for "on"; nothing if there is no such
/// word.
std::optional<double> numberOf(const hsp_param& param, const std::string& word) {
  for (uint32_t i = 0; param.kind == HSP_ENUM && i < param.choice_count; ++i)
    if (word == host::textOf(param.choices[i])) return i;
  if (param.kind != HSP_BOOL) return std::nullopt;
  for (const char* yes : {"true", "yes", "on"})
    if (word == yes) return 1;
  for (const char* no : {"false", "no", "off"})
    if (word == no) return 0;
  return std::nullopt;
}

}  // namespace

RequestHandler::RequestHandler(Runner& runner, LoadScene load, host::Services::Log log, std::string dump_folder)
    : runner_(runner),
      load_(std::move(load)),
      log_(std::move(log)),
      dump_folder_(std::move(dump_folder)),
      scene_file_(std::filesystem::absolute(runner.scene().file).string()),
      places_(runner.world().places()),
      leads_([this](const Order& order) { return post(order); }, runner.scene().clients.exclusive,
             [this](uint32_t arm, const Leads::Pusher& who, Leads::PushEvent news) { reportPusher(arm, who, news); }) {
  for (size_t i = 0; i < runner.scene().models.size(); ++i) {
    const scene::Model& model = runner.scene().models[i];
    places_[i] = {model, true, model.enabled, 0};
  }
}

control::Reply RequestHandler::answer(const control::Peer& peer, const std::string& line,
                                      std::vector<Descriptor> files) {
  std::string id;
  const auto request = control::parseRequest(line, &id);
  if (!request) return control::withId(control::refusal(request.error()), id);
  try {
    sweep();
    attached_ = Descriptor();
    given_files_ = std::move(files);
    code_ = "failed";
    const auto done = execute(peer, *request);
    passed_.reset();
    if (!done) return control::withId(control::refusal(done.error(), code_), id);
    return {control::withId(*done, id), std::move(attached_)};
  } catch (const std::exception& error) {
    return control::withId(control::refusal(std::string("the request failed: ") + error.what(), "failed"), id);
  }
}

Result<std::string> RequestHandler::answerQuery(const control::Peer& peer, const Request& request) {
  switch (request.kind) {
    case Request::Kind::kStatus:
      return statusAnswer(session(), name_, socket_);
    case Request::Kind::kList:
      return listAnswer(session());
    case Request::Kind::kSnapshot:
      return snapshotAnswer(session());
    case Request::Kind::kEvents:
      return eventsAfter(request.after);
    case Request::Kind::kSubscribe:
      return subscribe(peer);
    default:
      return answerModelQuery(request);
  }
}

Result<std::string> RequestHandler::answerModelQuery(const Request& request) {
  const auto place = placeOf(request.model);
  if (!place) return Error{place.error()};
  const host::ShapeInstance& shape = *runner_.world().shapes()[*place];
  const DrawingWish wish{request.tolerance, request.triangles};
  switch (request.kind) {
    case Request::Kind::kGet: {
      auto values = valuesAnswer(session(), *place, request.parameter);
      return values ? values : refuse("unknown", values.error());
    }
    case Request::Kind::kGeometry:
      return request.as_memory ? geometryInMemory(shape, wish, attached_) : geometryAnswer(shape, wish);
    case Request::Kind::kVertices:
      return verticesAnswer(shape, request.after);
    case Request::Kind::kFeature:
      return featureAnswer(shape, request.number);
    default:
      return Error{"this kind of request is not answered here (an error of hapticd; please report it)"};
  }
}

Result<std::string> RequestHandler::execute(const control::Peer& peer, const Request& request) {
  const std::string good = lineOf({{"ok", true}});
  const auto plain = [&](const Result<void>& done) -> Result<std::string> {
    if (!done) return Error{done.error()};
    return good;
  };
  switch (request.kind) {
    case Request::Kind::kHold:
      return hold(request.device, code_);
    case Request::Kind::kClear:
      return plain(clear(peer, request.device));
    case Request::Kind::kMark:
      return mark(request.text);
    case Request::Kind::kDump: {
      auto file = dump("asked for");
      if (!file) return Error{file.error()};
      return lineOf({{"ok", true}, {"file", *file}});
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
    default:
      return executeForModels(peer, request);
  }
}

Result<std::string> RequestHandler::executeForModels(const control::Peer& peer, const Request& request) {
  Result<void> done;
  switch (request.kind) {
    case Request::Kind::kMove:
      return move(request);
    case Request::Kind::kAdd:
      return add(peer, request);
    case Request::Kind::kReload:
      return reload(peer, request);
    case Request::Kind::kEnable:
      return enable(request.model);
    case Request::Kind::kDisable:
      done = setEnabled(request.model, false);
      break;
    case Request::Kind::kSet:
      done = set(request);
      break;
    case Request::Kind::kRemove:
      done = remove(request.model);
      break;
    default:
      return answerQuery(peer, request);
  }
  if (!done) return Error{done.error()};
  return lineOf({{"ok", true}});
}

Result<uint32_t> RequestHandler::placeOf(const std::string& model) const {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < places_.size(); ++i) {
    if (places_[i].taken && places_[i].model.name == model) return i;
    if (places_[i].taken) names.push_back(places_[i].model.name);
  }
  return refuse("unknown",
                "there is no model \"" + model.substr(0, 100) + "\", " +
                    (names.empty() ? "nor any other" : "expected one of " + document::listedFor(model, names)) +
                    document::suggestionOfName(model.substr(0, 100), names));
}

Result<void> RequestHandler::post(std::span<const Order> orders) {
  for (const Order& order : orders) {
    if (!runner_.postOrder(order))
      return refuse(
          "busy",
          "the servo has not carried out the orders before this one; it may have stopped: see hapticd ctl status");
    ++given_;
  }
  if (!waitUntil([&] { return runner_.loop().ordersDone() >= given_; }))
    return refuse("timeout",
                  "the servo did not carry out the order within 2 s; it may have stopped: see hapticd ctl status");
  return {};
}

Result<void> RequestHandler::setEnabled(const std::string& model, bool enabled) {
  const auto place = placeOf(model);
  if (!place) return Error{place.error()};
  if (const std::string why = enabled ? silencedWhy(session(), *place) : ""; !why.empty())
    return refuse(
        "silenced",
        why + "; it stays silenced until it is loaded again\n  fix: hapticd ctl reload, or remove and add the model");
  Order order;
  order.kind = enabled ? Order::Kind::kEnable : Order::Kind::kDisable;
  order.target = *place;
  if (enabled) order.param = Order::kOnceFree;
  places_[*place].enabled = enabled;
  return post(order);
}

/// Enables a model. If a tip is inside, the model is not felt until the tip has left it; the answer says so.
Result<std::string> RequestHandler::enable(const std::string& model) {
  // [s] After this time the model is felt or waits. A disabled model is still traced, and needs no search.
  constexpr double kMet = Core::kFreeFor + 0.01;
  constexpr double kFound = 0.25;  // [s] the same for a model that has started disabled: first the search finds it
  const auto place = placeOf(model);
  if (!place) return Error{place.error()};
  const bool woken = runner_.world().wake(*place, places_[*place].model);
  if (auto done = setEnabled(model, true); !done) return Error{done.error()};
  nlohmann::ordered_json json = {{"ok", true}};
  if (auto waiting = waitingOf({places_[*place].model}, woken ? kFound : kMet); !waiting.empty())
    json["waiting"] = std::move(waiting);
  return lineOf(json);
}

/// Keeps the new value of a parameter for `get` and `list`.
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
  const auto index = host::paramIndexOf(plugin, request.parameter);
  const std::string what = "parameter \"" + request.parameter.substr(0, 100) + "\" of " + plugin.name;
  if (!index) return refuse("unknown", noSuchParameter(plugin, request.parameter, HSP_P_LIVE));
  order.param = *index;
  const hsp_param* const param = &host::paramAt(plugin, *index);
  if ((param->flags & HSP_P_LIVE) == 0 || param->kind > HSP_ENUM)
    return refuse("unsupported",
                  what + " cannot change while the model runs\n  fix: change the scene, then: hapticd ctl reload");
  const auto meant = request.word.empty() ? request.value : numberOf(*param, request.word);
  if (!meant)
    return refuse("out_of_range", what + ": \"" + request.word.substr(0, 100) + "\" is not " +
                                      (param->kind > HSP_INT ? "one of its words" : "a number") + ", expected " +
                                      expectedOf(*param));
  order.value = *meant;
  const bool whole = param->kind == HSP_REAL || std::floor(order.value) == order.value;
  if (!(order.value >= param->min && order.value <= param->max) || !whole)
    return refuse("out_of_range",
                  fmt::format("{}: {:g} is out of range, expected {}", what, order.value, expectedOf(*param)));
  if ((param->flags & HSP_P_SAFETY) != 0 && !request.consent)
    return refuse("consent", what +
                                 ": a hand may feel this change suddenly, so whoever holds the arm must agree\n "
                                 " fix: add \"consent\": true, or hapticd ctl set --consent");
  auto given = post(order);
  if (given) remember(places_[*place].model, *param, order);
  return given;
}

/// Moves a model. Only the servo knows where the model is when it obeys, so the servo applies the bounds of speed. The
/// answer says how long the move really takes.
Result<std::string> RequestHandler::move(const Request& request) {
  const auto place = placeOf(request.model);
  if (!place) return Error{place.error()};
  const scene::Model& model = places_[*place].model;
  if (!model.kinematic)
    return refuse("unsupported",
                  "model \"" + model.name +
                      "\" is not kinematic, so it cannot be moved\n  fix: write motion: kinematic in the scene");
  if (const auto leader = leads_.leader(Order::Led::kModel, *place))
    return refuse("busy", "process " + std::to_string(*leader) + " leads model \"" + model.name +
                              "\", so only that process can move it; expected the end of this lead");
  Order order;
  order.kind = Order::Kind::kMove;
  order.target = *place;
  std::copy(request.position.begin(), request.position.end(), order.position);
  std::fill_n(order.orientation, 4, 0.0);
  if (request.turns) std::copy_n(request.orientation.data(), 4, order.orientation);
  order.seconds = request.seconds.value_or(0);
  if (auto given = post(order); !given) return Error{given.error()};
  // Safe to read: the servo has obeyed, and only this thread gives orders that change the move.
  return lineOf({{"ok", true}, {"seconds", runner_.world().core().models()[*place].glide.seconds()}});
}

/// Clears arms, unless a hold came while this request waited for its turn: the hold is newer.
Result<void> RequestHandler::clear(const control::Peer& peer, const std::string& device) {
  if (peer.asked != 0 && peer.asked < held_at_.load())
    return refuse(
        "held",
        "the arm was put on hold after this request, so the request was not carried out\n  fix: ask again if the "
        "force is wanted");
  const auto& devices = runner_.scene().devices;
  bool found = false;
  for (uint32_t i = 0; i < devices.size(); ++i) {
    if (!device.empty() && devices[i].name != device) continue;
    found = true;
    Order order;
    order.kind = Order::Kind::kClear;
    order.target = i;
    if (auto given = post(order); !given) return given;
  }
  return found ? faultAfterClear(device) : refuse("unknown", noSuchDevice(runner_.scene(), device));
}

/// Refuses a clear if its cause persists: then a fault is latched again in the next ticks.
Result<void> RequestHandler::faultAfterClear(const std::string& device) {
  constexpr double kSoon = 0.02;  // [s] in which the old force has ramped out, and the checks have run again
  waitForServo(kSoon);
  const auto& devices = runner_.scene().devices;
  for (size_t i = 0; i < devices.size(); ++i) {
    if (!device.empty() && devices[i].name != device) continue;
    if (const std::string fault = runner_.faultOf(i); !fault.empty())
      return refuse("fault", "it was cleared, but a fault is there again: " + fault);
  }
  return {};
}

Result<std::string> RequestHandler::dump(const std::string& why) {
  const std::string file =
      record::nextDump(dump_folder_, std::chrono::system_clock::to_time_t(std::chrono::system_clock::now()));
  if (auto done = runner_.telemetry().flight()->ring().dump(file); !done) return Error{done.error()};
  log_(HSP_LOG_INFO, "black box", file + " (" + why + ")");
  return file;
}

}  // namespace hapticd::servo
