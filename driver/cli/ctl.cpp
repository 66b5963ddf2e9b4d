/// `hapticd ctl`: asks a running daemon.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "cli/command.hpp"
#include "control/client.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string name = "hapticd", model, device, parameter, file, line, obj;
  std::vector<double> position, orientation;
  std::optional<double> seconds;
  double value = 0, tolerance = 0;
  bool consent = false, follow = false;
};

/// Writes the triangles of an answer.
int saveObj(const Json& json, const std::string& file) {
  std::ofstream out(file);
  const Json &xyz = json.at("xyz"), &corners = json.at("triangles");
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3)
    out << "v " << xyz[i].dump() << " " << xyz[i + 1].dump() << " " << xyz[i + 2].dump() << "\n";
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    out << "f " << corners[i].get<uint32_t>() + 1 << " " << corners[i + 1].get<uint32_t>() + 1 << " "
        << corners[i + 2].get<uint32_t>() + 1 << "\n";
  if (!(out << std::flush))
    return fail(kFailed, file + ": cannot be written, expected a file in a folder that you may write to");
  std::printf("%s: %zu vertices, %zu triangles\n", file.c_str(), xyz.size() / 3, corners.size() / 3);
  return kWorked;
}

std::string socketOf(const Options& options) {
  return status::runtimeFolder(false) + "/" + options.name + ".sock";
}

std::string lineOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

int send(const Options& options, const std::string& line) {
  auto answer = control::ask(socketOf(options), line);
  if (!answer) return fail(kFailed, answer.error());
  const Json json = Json::parse(*answer, nullptr, false);
  if (!json.is_object()) return fail(kFailed, "the answer cannot be read: " + *answer);
  if (!json.value("ok", false)) return fail(kFailed, json.value("error", std::string("refused")));
  if (!options.obj.empty()) return saveObj(json, options.obj);
  std::printf("%s\n", json.dump(2).c_str());
  return kWorked;
}

/// Prints the triangles, and then each frame of vertices when it comes, a line of JSON each: until nobody reads them
/// or the daemon ends.
int follow(const Options& options) {
  constexpr Nanoseconds kPause = 4'000'000;  // a quarter of what a frame lasts
  auto client = control::Client::connect(socketOf(options));
  if (!client) return fail(kFailed, client.error());
  RealClock clock(0);
  uint64_t seen = 0;
  for (const char* word : {"vertices", "geometry"}) {  // the first says whether there are any
    const auto answer = client->ask(lineOf({{"do", word}, {"model", options.model}}));
    const Json json = answer ? Json::parse(*answer, nullptr, false) : Json();
    if (!answer) return fail(kFailed, answer.error());
    if (!json.is_object()) return fail(kFailed, "the answer cannot be read: " + *answer);
    if (!json.value("ok", false)) return fail(kFailed, json.value("error", std::string("refused")));
    if (word == std::string("geometry")) std::printf("%s\n", answer->c_str());
  }
  while (std::fflush(stdout) == 0) {
    const auto answer = client->ask(lineOf({{"do", "vertices"}, {"model", options.model}, {"after", seen}}));
    if (!answer) break;  // the daemon has ended
    const Json json = Json::parse(*answer, nullptr, false);
    if (!json.is_object() || !json.value("ok", false)) break;  // or the model has left
    if (json.contains("xyz")) std::printf("%s\n", answer->c_str());
    seen = json.value("frame", seen);
    clock.waitUntil(clock.now() + kPause);
  }
  return kWorked;
}

/// A subcommand that sends what `build` makes of the options.
template <class Build>
CLI::App* addRequest(CLI::App& parent, const char* word, const char* doc, const std::shared_ptr<Options>& options,
                     int& exit_code, Build build) {
  CLI::App* command = parent.add_subcommand(word, doc);
  command->callback([options, &exit_code, build, word] {
    Json json = {{"do", word}};
    build(json);
    exit_code = options->follow ? follow(*options) : send(*options, lineOf(json));
  });
  return command;
}

void addGeometryRequest(CLI::App& ctl, const std::shared_ptr<Options>& options, int& exit_code) {
  CLI::App* geometry =
      addRequest(ctl, "geometry", "Triangles of a model as it looks now: a soft body as it is pressed.", options,
                 exit_code, [options](Json& json) {
                   json["model"] = options->model;
                   if (options->tolerance > 0) json["tolerance"] = options->tolerance;
                 });
  geometry->add_option("model", options->model, "its name")->required();
  geometry->add_option("--obj", options->obj, "write an OBJ file, in the model's frame, instead of printing JSON");
  geometry->add_option("--tolerance", options->tolerance, "chord error in m; 0: 5/1000 of the model's size")
      ->check(within(0, 1e9));  // the daemon knows what it draws
  geometry
      ->add_flag("--follow", options->follow,
                 "print the vertices as the body's steps write them, about 60 times a second, a line of JSON each")
      ->excludes("--obj")
      ->excludes("--tolerance");
}

std::string absolute(const std::string& file) {
  return std::filesystem::absolute(file).lexically_normal().string();
}

void addModelRequests(CLI::App& ctl, const std::shared_ptr<Options>& options, int& exit_code) {
  const auto model = [options](Json& json) { json["model"] = options->model; };
  for (const auto& [word, doc] : {std::pair{"enable", "Let a model be felt again; its force fades in."},
                                  std::pair{"disable", "Fade a model's force out; it is traced on."},
                                  std::pair{"remove", "Fade a model out and take it away."}})
    addRequest(ctl, word, doc, options, exit_code, model)->add_option("model", options->model, "its name")->required();

  CLI::App* set = addRequest(ctl, "set", "Set a live parameter of a model.", options, exit_code, [options](Json& json) {
    json["model"] = options->model, json["parameter"] = options->parameter, json["value"] = options->value;
    if (options->consent) json["consent"] = true;
  });
  set->add_option("model", options->model, "its name")->required();
  set->add_option("parameter", options->parameter, "one that `ctl list` shows")->required();
  set->add_option("value", options->value, "a number in the parameter's unit")->required();
  set->add_flag("--consent", options->consent, "whoever holds the arm agrees: for what a hand may feel suddenly");

  CLI::App* move = addRequest(ctl, "move", "Move a kinematic model.", options, exit_code, [options](Json& json) {
    json["model"] = options->model, json["position"] = options->position;
    if (!options->orientation.empty()) json["orientation"] = options->orientation;
    if (options->seconds) json["seconds"] = *options->seconds;
  });
  move->add_option("model", options->model, "its name")->required();
  move->add_option("--position", options->position, "x y z in m, world frame")->required()->expected(3);
  move->add_option("--orientation", options->orientation, "w x y z, a unit quaternion")->expected(4);
  move->add_option("--seconds", options->seconds, "how long it takes at least; without it at most 0.2 m/s");
}

void addSceneRequests(CLI::App& ctl, const std::shared_ptr<Options>& options, int& exit_code) {
  CLI::App* add = addRequest(ctl, "add", "Add models of a scene file.", options, exit_code, [options](Json& json) {
    json["file"] = absolute(options->file);
    if (!options->model.empty()) json["model"] = options->model;
  });
  add->add_option("file", options->file, "scene file")->required();
  add->add_option("model", options->model, "only this one");
  CLI::App* reload = addRequest(ctl, "reload", "Load the scene again, or another, with a cross-fade.", options,
                                exit_code, [options](Json& json) {
                                  if (!options->file.empty()) json["file"] = absolute(options->file);
                                });
  reload->add_option("file", options->file, "scene file with the same devices");
}

void addDeviceRequests(CLI::App& ctl, const std::shared_ptr<Options>& options, int& exit_code) {
  const auto device = [options](Json& json) {
    if (!options->device.empty()) json["device"] = options->device;
  };
  for (const auto& [word, doc] : {std::pair{"hold", "Ramp the force of a device out, until it is cleared."},
                                  std::pair{"clear", "Forgive a latched fault: the force ramps in again."}})
    addRequest(ctl, word, doc, options, exit_code, device)
        ->add_option("device", options->device, "its name; all without");
}

}  // namespace

void addCtl(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* ctl = app.add_subcommand("ctl", "Ask a running daemon: status, models, parameters, black box.");
  ctl->require_subcommand(1);
  ctl->add_option("--name", options->name, "name of the daemon, as given to `hapticd run --name`");
  const auto nothing = [](Json&) {};
  addRequest(*ctl, "status", "How it is.", options, exit_code, nothing);
  addRequest(*ctl, "list", "Its models and what of them can change.", options, exit_code, nothing);
  addModelRequests(*ctl, options, exit_code);
  addSceneRequests(*ctl, options, exit_code);
  addDeviceRequests(*ctl, options, exit_code);
  addGeometryRequest(*ctl, options, exit_code);
  addRequest(*ctl, "dump", "Write the black box: the last 10 s of every tick.", options, exit_code, nothing);
  addRequest(*ctl, "stop", "End the run in order.", options, exit_code, nothing);
  ctl->footer("Example:\n  hapticd ctl set teapot stiffness 600 --consent");
}

}  // namespace hapticd::cli
