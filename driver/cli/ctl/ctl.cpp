// SPDX-License-Identifier: MIT
/// `hapticd ctl`: sends requests to a running daemon.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/mark_text.hpp"
#include "cli/ctl/answer.hpp"
#include "cli/ctl/geometry.hpp"
#include "cli/ctl/lead.hpp"
#include "cli/ctl/named_files.hpp"
#include "cli/support/command.hpp"
#include "control/client.hpp"
#include "control/liveness.hpp"
#include "document/absent_file.hpp"
#include "document/correction.hpp"
#include "document/json_text.hpp"
#include "document/node.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {
namespace {

using Json = nlohmann::ordered_json;

struct CtlArguments {
  std::string name = "hapticd", model, device, parameter, value, file, line, obj;
  std::vector<double> position, orientation;
  std::optional<double> seconds;
  double tolerance = 0, wait = 0;
  uint32_t number = 0;
  bool consent = false, follow = false, tells_socket = false;
};

std::string socketOf(const CtlArguments& options) {
  return status::runtimeFolderOf(options.name) + "/" + options.name + ".sock";
}

/// Waits for the start of the daemon as long as --wait allows, and says so. If there is still none, the request reports
/// it.
void awaitDaemon(const CtlArguments& options) {
  if (options.wait <= 0 || control::connectTo(socketOf(options))) return;
  std::fprintf(stderr, "the daemon %s does not run yet; waiting for it, at most %g s (%s)\n", options.name.c_str(),
               options.wait, control::othersText(socketOf(options)).c_str());
  control::waitForStart([&options] { return socketOf(options); }, options.wait);
}

/// Does `ctl socket`: prints only the path of the socket, for programs that connect to it. Fails if nobody serves it.
int showSocket(const CtlArguments& options) {
  auto client = control::Client::connect(socketOf(options));
  if (!client) return fail(kFailed, client.error());
  std::printf("%s\n", socketOf(options).c_str());
  return kWorked;
}

/// Prints an answer.
/// @param scene file that was sent with the request; "" if there was none
int show(const CtlArguments& options, const Result<std::string>& answer, const std::string& scene = "") {
  auto json = acceptedAnswer(answer);
  if (!json) return fail(exitCodeOf(answer, !scene.empty()), document::withAbsentFiles(json.error(), scene));
  printNote(*json);
  if (options.tells_socket) (*json)["name"] = options.name, (*json)["socket"] = socketOf(options);
  return printJson(*json);
}

int send(const CtlArguments& options, const std::string& line, double seconds = 10) {
  return show(options, control::ask(socketOf(options), line, seconds));
}

/// Does `ctl add` and `ctl reload`. The scene and the files that it names are opened here, with the rights of the
/// caller.
int sendScene(const CtlArguments& options, Json request) {
  auto client = control::Client::connect(socketOf(options));
  if (!client) return fail(kFailed, client.error());
  const bool again = !request.contains("file");
  if (again) {
    const auto answer = client->ask(document::jsonLine({{"do", "status"}}));
    const Json status = answer ? document::parseJson(*answer) : Json();
    if (!status.is_object()) return show(options, answer);
    request["file"] = status.value("scene", "");
  }
  const std::string scene = request["file"].get<std::string>();
  auto files = openNamed(scene);
  if (!files && !again) return fail(kBadInput, files.error());
  if (!files) request.erase("file");  // the daemon may read its own scene, even if only the daemon's user may
  if (files) request["files"] = files->names;
  const std::vector<int> numbers = files ? files->numbers() : std::vector<int>();
  const auto waits = [] {
    std::fprintf(stderr,
                 "the daemon still sets up the models; "
                 "its log says what it waits for (Ctrl-C ends this command, not the set-up)\n");
  };
  return show(options, client->askPatiently(document::jsonLine(request), numbers, waits), scene);
}

/// Returns the exit code after a stream of answers has ended. Reports an error if the daemon was killed or crashed.
int endOfStream(const CtlArguments& options) {
  if (!control::wasKilled(socketOf(options))) return kWorked;
  return fail(kFailed, "the daemon " + options.name +
                           " was killed, or it crashed: nothing more comes\n  fix: start it again with hapticd run");
}

/// Does `ctl stop`. Returns when the daemon has ended and its name is free, so that a new daemon can take the name.
int stop(const CtlArguments& options, const std::string& line) {
  constexpr double kPatience = 10;  // [s]
  const int told = send(options, line);
  if (told != kWorked || control::waitForEnd(socketOf(options), kPatience)) return told;
  return fail(kFailed,
              "the daemon " + options.name +
                  " was told to end, but did not within 10 s; its forces are off\n  fix: wait for its process, or "
                  "end it with kill PID (hapticd top shows it)");
}

/// Prints the triangles, and then each new frame of vertices, one line of JSON each, until the reader of the output or
/// the daemon ends.
int follow(const CtlArguments& options) {
  constexpr Nanoseconds kPause = 4'000'000;  // [ns] a quarter of the time between two frames
  auto client = control::Client::connect(socketOf(options));
  if (!client) return fail(kFailed, client.error());
  RealClock clock(0);
  uint64_t seen = 0;
  for (const char* word : {"vertices", "geometry"}) {  // if the model has no frames, the first request fails
    const auto answer = client->ask(document::jsonLine({{"do", word}, {"model", options.model}}), kDrawingPatience);
    if (const auto json = acceptedAnswer(answer); !json) return fail(exitCodeOf(answer), json.error());
    if (word == std::string("geometry")) std::printf("%s\n", answer->c_str());
  }
  while (std::fflush(stdout) == 0) {
    const auto answer =
        client->ask(document::jsonLine({{"do", "vertices"}, {"model", options.model}, {"after", seen}}));
    if (!answer) return endOfStream(options);
    const Json json = document::parseJson(*answer);
    if (!json.is_object() || !json.value("ok", false)) break;  // the model was removed
    if (json.contains("xyz")) std::printf("%s\n", answer->c_str());
    seen = json.value("frame", seen);
    clock.waitUntil(clock.now() + kPause);
  }
  return kWorked;
}

/// Returns the example in the --help of a request.
std::string exampleOf(const std::string& word) {
  static const std::pair<const char*, const char*> kExamples[] = {
      {"status", "status"},
      {"list", "list"},
      {"socket", "socket    # for socat: echo '{\"do\":\"list\"}' | socat - UNIX-CONNECT:$(hapticd ctl socket)"},
      {"enable", "enable teapot"},
      {"disable", "disable teapot"},
      {"remove", "remove teapot"},
      {"set", "set teapot stiffness 600 --consent"},
      {"get", "get teapot stiffness"},
      {"move", "move door --position 0.1 0 0 --seconds 2"},
      {"add", "add config/scenes/sphere.yaml"},
      {"reload", "reload config/scenes/teapot.yaml"},
      {"hold", "hold"},
      {"clear", "clear"},
      {"feature", "feature engine 12"},
      {"geometry", "geometry teapot --obj teapot.obj"},
      {"events", "events --follow"},
      {"mark", "mark 'trial 7 begins'"},
      {"dump", "dump"},
      {"stop", "--name left stop    # of a daemon started with: hapticd run --name left"},
  };
  for (const auto& [name, example] : kExamples)
    if (word == name) return std::string("Example:\n  hapticd ctl ") + example;
  return "";
}

/// Adds a subcommand that sends the request that `build` makes from the options.
template <class Build>
const Command addRequest(const Command& parent, const char* word, const char* doc,
                         const std::shared_ptr<CtlArguments>& options, int& exit_code, Build&& build) {
  const Command command = parent.addSubcommand(word, doc);
  command.footer(exampleOf(word));
  command.callback([options, &exit_code, build = std::forward<Build>(build), word] {
    Json json = {{"do", word}};
    build(json);
    awaitDaemon(*options);
    const bool scene = std::string(word) == "add" || std::string(word) == "reload";
    const bool stops = std::string(word) == "stop", draws = std::string(word) == "geometry";
    exit_code = options->follow         ? follow(*options)
                : !options->obj.empty() ? saveGeometry(socketOf(*options), json, options->obj)
                : scene                 ? sendScene(*options, json)
                : stops                 ? stop(*options, document::jsonLine(json))
                : draws                 ? send(*options, document::jsonLine(json), kDrawingPatience)
                                        : send(*options, document::jsonLine(json));
  });
  return command;
}

void addGeometryRequest(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const Command geometry = addRequest(ctl, "geometry", "Print the triangles of a model in its current shape, as JSON.",
                                      options, exit_code, [options](Json& json) {
                                        json["model"] = options->model;
                                        if (options->tolerance > 0) json["tolerance"] = options->tolerance;
                                      });
  geometry.addOption("model", options->model, "name of the model").required();
  geometry.addOption("--obj", options->obj, "write an OBJ file, in the model's frame, instead of printing JSON");
  geometry
      .addOption("--tolerance", options->tolerance,
                 "chord error [m]; 0: 0.5 % of the model's size, or more if that is too much for an answer")
      .within(0, 1e9);  // the daemon knows which frames it draws
  geometry
      .addFlag("--follow", options->follow,
               "print every new frame of vertices (about 60 per second), one line of JSON each")
      .excludes("--obj")
      .excludes("--tolerance");
}

void addFeatureRequest(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const Command feature = addRequest(
      ctl, "feature", "Print the name of a feature: the surface, face or element of a model that a contact is on.",
      options, exit_code, [options](Json& json) {
        json["model"] = options->model;
        json["number"] = options->number;
      });
  feature.addOption("model", options->model, "name of the model").required();
  feature.addOption("number", options->number, "number of the feature in a trace or recording, counted from 0")
      .required();
}

/// Prints the events so far, one line of JSON each. With `follow` it also prints the events from now on, until the
/// daemon ends.
int showEvents(const CtlArguments& options) {
  auto client = control::Client::connect(socketOf(options));
  if (!client) return fail(kFailed, client.error());
  uint64_t end = UINT64_MAX;  // number of the first event that the subscription sends
  for (const char* word : {"subscribe", "events"}) {
    if (word == std::string("subscribe") && !options.follow) continue;
    const auto json = acceptedAnswer(client->ask(document::jsonLine({{"do", word}})));
    if (!json) return fail(kFailed, json.error());
    if (!json->contains("events")) {
      end = json->value("next", end);
      continue;
    }
    uint64_t number = json->value("first", uint64_t{0});
    for (const Json& event : (*json)["events"])
      if (number++ < end) std::printf("%s\n", event.dump().c_str());
  }
  constexpr double kLong = 1e6;
  while (options.follow && std::fflush(stdout) == 0) {
    const auto line = client->receiveLine(kLong);
    if (!line) return endOfStream(options);
    std::printf("%s\n", line->c_str());
  }
  return kWorked;
}

void addEvents(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const Command events = ctl.addSubcommand(
      "events", "Show what happened: clicks, touches, faults, marks, models and programs that came and left.");
  events.addFlag("--follow", options->follow, "do not end; print each new event as one line of JSON");
  events.footer(exampleOf("events"));
  events.callback([options, &exit_code] { awaitDaemon(*options), exit_code = showEvents(*options); });
}

void addLead(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const Command lead =
      ctl.addSubcommand("lead", "Move a kinematic model, or the simulated hand, by lines of standard input.");
  const auto what = std::make_shared<LeadOptions>();
  addLeadOptions(lead, *what);
  lead.callback([options, what, &exit_code] {
    what->socket = socketOf(*options);
    if (what->complete()) awaitDaemon(*options);
    exit_code = leadByLines(*what);
  });
}

void addMark(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  addRequest(ctl, "mark", "Write a text into the recording, the black box and the events, at this moment.", options,
             exit_code, [options](Json& json) { json["text"] = options->value; })
      .addOption("text", options->value, kMarkExpected)
      .required()
      .check([](const std::string& text) { return isMarkText(text) ? "" : std::string("expected ") + kMarkExpected; });
}

std::string absolute(const std::string& file) {
  return std::filesystem::absolute(file).lexically_normal().string();
}

void addModelRequests(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const auto model = [options](Json& json) { json["model"] = options->model; };
  for (const auto& [word, doc] : {std::pair{"enable", "Enable a model; its force fades in."},
                                  std::pair{"disable", "Disable a model: its force fades out, but it is still traced."},
                                  std::pair{"remove", "Remove a model; its force fades out first."}})
    addRequest(ctl, word, doc, options, exit_code, model)
        .addOption("model", options->model, "name of the model")
        .required();

  const Command move = addRequest(ctl, "move", "Move a kinematic model.", options, exit_code, [options](Json& json) {
    json["model"] = options->model, json["position"] = options->position;
    if (!options->orientation.empty()) json["orientation"] = options->orientation;
    if (options->seconds) json["seconds"] = *options->seconds;
  });
  move.addOption("model", options->model, "name of the model").required();
  move.addOption("--position", options->position, "x y z [m], world frame").required().expected(3, 3);
  move.addOption("--orientation", options->orientation,
                 "w x y z, a unit quaternion; default: the model keeps its orientation")
      .expected(4, 4);
  move.addOption("--seconds", options->seconds,
                 "duration of the motion [s]; the daemon takes longer if this would be too fast; default: a speed of "
                 "at most 0.2 m/s");
}

void addParameterRequests(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const Command set =
      addRequest(ctl, "set", "Set a live parameter of a model.", options, exit_code, [options](Json& json) {
        json["model"] = options->model, json["parameter"] = options->parameter;
        const auto number = document::toNumber(options->value);
        json["value"] = number ? Json(*number) : Json(options->value);
        if (options->consent) json["consent"] = true;
      });
  set.addOption("model", options->model, "name of the model").required();
  set.addOption("parameter", options->parameter, "a live parameter; `hapticd ctl list` shows them").required();
  set.addOption("value", options->value, "a number in the parameter's unit, or a word of a choice")
      .required()
      .check(&document::wrongDecimal);
  set.addFlag("--consent", options->consent,
              "the person who holds the arm agrees; needed if the change may be felt suddenly");

  const Command get = addRequest(ctl, "get", "Show the value of a parameter of a model, or of all.", options, exit_code,
                                 [options](Json& json) {
                                   json["model"] = options->model;
                                   if (!options->parameter.empty()) json["parameter"] = options->parameter;
                                 });
  get.addOption("model", options->model, "name of the model").required();
  get.addOption("parameter", options->parameter, "name of one parameter; if it is left out, all parameters are shown");
}

void addSceneRequests(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const Command add =
      addRequest(ctl, "add", "Add the models of a scene file.", options, exit_code, [options](Json& json) {
        json["file"] = absolute(options->file);
        if (!options->model.empty()) json["model"] = options->model;
      });
  add.addOption("file", options->file, "scene file").required();
  add.addOption("model", options->model, "name of the only model to add; default: all models of the scene");
  const Command reload = addRequest(ctl, "reload", "Load the scene again, or another scene, with a cross-fade.",
                                    options, exit_code, [options](Json& json) {
                                      if (!options->file.empty()) json["file"] = absolute(options->file);
                                    });
  reload.addOption("file", options->file, "scene file with the same devices; default: the scene of the daemon");
}

void addDeviceRequests(const Command& ctl, const std::shared_ptr<CtlArguments>& options, int& exit_code) {
  const auto device = [options](Json& json) {
    if (!options->device.empty()) json["device"] = options->device;
  };
  for (const auto& [word, doc] :
       {std::pair{"hold", "Ramp the force of a device to zero and keep it there until it is cleared."},
        std::pair{"clear", "Clear a latched fault or a hold: the force ramps in again."}})
    addRequest(ctl, word, doc, options, exit_code, device)
        .addOption("device", options->device, "name of the device; default: all");
}

}  // namespace

void addCtl(const Command& app, int& exit_code) {
  auto options = std::make_shared<CtlArguments>();
  const Command ctl = app.addSubcommand("ctl", "Control a running daemon: status, models, parameters, black box.");
  ctl.requireSubcommand();
  ctl.addOption("--name", options->name, "name of the daemon, as given to `hapticd run --name`; default: hapticd");
  ctl.addOption("--wait", options->wait, "how long to wait for the daemon to start [s]; default: 0").within(0, 1e6);
  const auto nothing = [](Json&) {};
  addRequest(ctl, "status", "Show the daemon's status.", options, exit_code,
             [options](Json&) { options->tells_socket = true; });
  const Command socket = ctl.addSubcommand("socket", "Print the path of the daemon's socket.");
  socket.footer(exampleOf("socket"));
  socket.callback([options, &exit_code] { awaitDaemon(*options), exit_code = showSocket(*options); });
  addRequest(ctl, "list", "List the models and their live parameters.", options, exit_code, nothing);
  addModelRequests(ctl, options, exit_code);
  addParameterRequests(ctl, options, exit_code);
  addSceneRequests(ctl, options, exit_code);
  addDeviceRequests(ctl, options, exit_code);
  addGeometryRequest(ctl, options, exit_code);
  addFeatureRequest(ctl, options, exit_code);
  addLead(ctl, options, exit_code);
  addEvents(ctl, options, exit_code);
  addMark(ctl, options, exit_code);
  addRequest(ctl, "dump", "Write the black box to disk: every tick of the last 10 s.", options, exit_code, nothing);
  addRequest(ctl, "stop", "End the run; forces ramp to zero first.", options, exit_code, nothing);
  ctl.footer("Example:\n  hapticd ctl set teapot stiffness 600 --consent");
}

}  // namespace hapticd::cli
